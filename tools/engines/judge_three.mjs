// three.js's ClusteredLighting: tiles of pixels from the top row, in exponential slices up to the far plane.
import * as THREE from 'three/webgpu';
import {ClusteredLighting} from 'three/addons/lighting/ClusteredLighting.js';
import {cell_of_pixel} from '/tools/frame.mjs';

export const settings = {maxLights: 1024, tileSize: 32, zSlices: 24, maxLightsPerCluster: 64, far: 2000};  // the engine's own

function add_light(scene, light, index) {
  const range = light.radius ?? 0;  // 0: without end
  const made = light.type === 'spot'
      ? new THREE.SpotLight(0xffffff, 1, range, light.outer_cone, 1 - light.inner_cone / light.outer_cone)
      : new THREE.PointLight(0xffffff, 1, range);
  made.position.set(...light.position);
  made.userData.index = index;
  scene.add(made);
  if (light.type === 'spot') scene.add(made.target);
  made.target?.position.set(...light.position).add(new THREE.Vector3(...light.direction).normalize());
}

function camera_of(frame, far) {
  const m = frame.view.view_from_world, e = frame.eye;
  const camera = new THREE.PerspectiveCamera(frame.fov_y_rad * 180 / Math.PI, frame.width / frame.height,
                                             frame.view.near, frame.view.far ?? far);
  camera.matrixAutoUpdate = false;
  camera.matrix.set(m[0], m[4], m[8], e[0], m[1], m[5], m[9], e[1], m[2], m[6], m[10], e[2], 0, 0, 0, 1);
  camera.updateMatrixWorld(true);
  return camera;
}

export async function lists(frame, s) {
  const renderer = new THREE.WebGPURenderer({forceWebGL: true});
  await renderer.init();
  renderer.setPixelRatio(1);
  renderer.setSize(frame.width, frame.height);
  renderer.lighting = new ClusteredLighting(s.maxLights, s.tileSize, s.zSlices, s.maxLightsPerCluster);
  const scene = new THREE.Scene(), camera = camera_of(frame, s.far);
  frame.lights.forEach((light, index) => add_light(scene, light, index));
  const mesh = new THREE.Mesh(new THREE.BoxGeometry(), new THREE.MeshStandardNodeMaterial());
  mesh.position.set(0, 0, -2).applyMatrix4(camera.matrixWorld);
  scene.add(mesh);
  const node = renderer.lighting.getNode(scene);
  let sorted;  // as the lists number them; the engine forgets its lights after the frame
  mesh.onAfterRender = () => sorted = node._lightSortOrder.map(i => node.clusteredLights[i].userData.index);
  renderer.render(scene, camera);

  const columns = node._gridDimensions.value.x, rows = node._gridDimensions.value.y, per_cell = 4 * node._chunksPerCluster;
  const stored = new Int32Array(await renderer.getArrayBufferAsync(node._lightIndexes.value));
  const cells = [];
  for (let c = 0; c < columns * rows * s.zSlices; ++c) {
    const list = stored.subarray(c * per_cell, (c + 1) * per_cell);
    const end = list.indexOf(0);
    cells.push(Array.from(end < 0 ? list : list.subarray(0, end), i => sorted[i - 1]));
  }
  const of_pixel = cell_of_pixel(frame, (x, row, along) => {  // as getScreenClusterIndex
    const slice = Math.floor(Math.log(along / camera.near) / Math.log(camera.far / camera.near) * s.zSlices);
    return Math.floor(x / s.tileSize) + columns * (Math.floor(row / s.tileSize) + rows * Math.min(Math.max(slice, 0), s.zSlices - 1));
  });
  return {cells, cell_of_pixel: of_pixel,
          summary: `three.js r${THREE.REVISION}: ${columns} x ${rows} x ${s.zSlices} cells; ` +
                   `${node._lightsCount.value} of ${frame.lights.length} lights kept, at most ${Math.max(...cells.map(c => c.length))} in a cell`};
}
