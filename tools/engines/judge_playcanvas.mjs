// PlayCanvas's clustered lights: boxes of equal size in the world, over the boxes of all lights in view.
import * as pc from 'playcanvas';
import {cell_of_pixel} from '/tools/frame.mjs';

export const settings = {cells: '10x3x10', maxLights: 255, maxLightsPerCell: 255, far: 1000};  // the engine's own

function add_light(app, light, index) {
  const entity = new pc.Entity(String(index));
  const degrees = cone => cone * 180 / Math.PI;
  if (light.radius === undefined) throw new Error(`lights.json: light "${light.name}": PlayCanvas needs a range`);
  // Lists do not depend on intensity, except that PlayCanvas skips lights of intensity 0.
  const common = {range: light.radius, intensity: 1, castShadows: false};
  if (light.type === 'spot') {
    entity.addComponent('light', {type: 'spot', ...common, innerConeAngle: degrees(light.inner_cone),
                                  outerConeAngle: degrees(light.outer_cone)});
    entity.setRotation(new pc.Quat().setFromDirections(pc.Vec3.DOWN, new pc.Vec3(light.direction).normalize()));
  } else {
    entity.addComponent('light', {type: 'omni', ...common});
  }
  entity.setPosition(...light.position);
  app.root.addChild(entity);
}

function add_camera(app, frame, far) {
  const m = frame.view.view_from_world, camera = new pc.Entity();
  camera.addComponent('camera', {fov: frame.fov_y_rad * 180 / Math.PI, nearClip: frame.view.near,
                                 farClip: frame.view.far ?? far});
  const world = new pc.Mat4().set([m[0], m[1], m[2], 0, m[4], m[5], m[6], 0, m[8], m[9], m[10], 0, ...frame.eye, 1]);
  camera.setRotation(new pc.Quat().setFromMat4(world));
  camera.setPosition(...frame.eye);
  app.root.addChild(camera);
}

export async function lists(frame, s) {
  const canvas = document.body.appendChild(document.createElement('canvas'));
  const app = new pc.Application(canvas);
  app.setCanvasFillMode(pc.FILLMODE_NONE, frame.width, frame.height);
  app.setCanvasResolution(pc.RESOLUTION_FIXED, frame.width, frame.height);
  const lighting = app.scene.lighting;
  lighting.cells = new pc.Vec3(s.cells.split('x').map(Number));
  lighting.maxLights = s.maxLights;
  lighting.maxLightsPerCell = s.maxLightsPerCell;
  frame.lights.forEach((light, index) => add_light(app, light, index));
  add_camera(app, frame, s.far);
  const mesh = new pc.Entity();  // without one the engine fills no cells
  mesh.addComponent('render', {type: 'box'});
  mesh.setPosition(...frame.eye.map((e, i) => e - 2 * frame.view.view_from_world[8 + i]));
  app.root.addChild(mesh);
  app.start();
  await new Promise(done => app.once('frameend', done));

  const clusters = app.renderer.worldClustersAllocator._allocated[0], per_cell = clusters.maxCellLightCount;
  const number = clusters.usedLights.map(used => used.light && Number(used.light._node.name));
  const cells = Array.from(clusters.counts, (count, c) =>
    Array.from(clusters.clusters.subarray(c * per_cell, c * per_cell + count), i => number[i]));
  // As the shader: clusteredLight.js of the chunks.
  clusters.updateUniforms();
  const {x, y, z} = clusters.cells, from = clusters._clusterBoundsMinData, scale = clusters._clusterCellsCountByBoundsSizeData;
  const of_pixel = cell_of_pixel(frame, (column, row, along, world) => {
    const [i, j, k] = world.map((w, axis) => Math.floor((w - from[axis]) * scale[axis]));
    return i < 0 || j < 0 || k < 0 || i >= x || j >= y || k >= z ? 0xffffffff : i + x * (k + z * j);
  });
  return {cells, cell_of_pixel: of_pixel,
          summary: `PlayCanvas ${pc.version}: ${x} x ${y} x ${z} cells from ${clusters.boundsMin} to ${clusters.boundsMax}; ` +
                   `${number.length - 1} of ${frame.lights.length} lights kept, at most ${Math.max(...clusters.counts)} in a cell`};
}
