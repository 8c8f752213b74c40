// three.js: WebGLRenderer's forward lights, or WebGPURenderer on WebGL with ClusteredLighting of the examples.
import * as THREE from 'three/webgpu';
import {ShaderChunk, WebGLRenderer, WebGLRenderTarget} from '/modules/three/build/three.module.js';
import {GLTFLoader} from 'three/addons/loaders/GLTFLoader.js';
import {ClusteredLighting} from 'three/addons/lighting/ClusteredLighting.js';
import {apply_changes} from '/tools/plane_page.mjs';

// The engine's own settings; `gltf` names changes of its formulas.
export const settings = {lights: 'forward', maxLights: 1024, tileSize: 32, zSlices: 24, maxLightsPerCluster: 64, far: 2000,
                         gltf: ''};

// Each makes one formula of the forward shaders that of docs/put_your_renderer_on_the_plane.md.
const changes = {
  window: ['lights_pars_begin', 'pow2( saturate( 1.0 - pow4( lightDistance / cutoffDistance ) ) )',
           'saturate( 1.0 - pow4( lightDistance / cutoffDistance ) )'],
  near: ['lights_pars_begin', 'max( pow( lightDistance, decayExponent ), 0.01 )', 'pow( lightDistance, decayExponent )'],
  cone: ['lights_pars_begin', 'smoothstep( coneCosine, penumbraCosine, angleCosine )',
         'pow2( saturate( ( angleCosine - coneCosine ) / ( penumbraCosine - coneCosine ) ) )'],
  roughness: ['lights_physical_fragment', 'material.roughness += geometryRoughness;', ''],
  energy: ['lights_physical_pars_fragment', 'specularBRDF * material.multiScatteringCompensation', 'specularBRDF'],
  ambient: ['lights_physical_pars_fragment', 'BRDF_Lambert( material.diffuseContribution ) * ( 1.0 - singleScattering - multiScattering )',
            'BRDF_Lambert( material.diffuseContribution + material.specularColorBlended )'],
};

async function renderer_for(s) {
  apply_changes(changes, s.gltf, name => ShaderChunk[name], (name, text) => ShaderChunk[name] = text);
  if (s.lights === 'forward') return new WebGLRenderer({antialias: false});
  const renderer = new THREE.WebGPURenderer({forceWebGL: true, antialias: false});
  await renderer.init();
  renderer.lighting = new ClusteredLighting(s.maxLights, s.tileSize, s.zSlices, s.maxLightsPerCluster);
  return renderer;
}

function place(camera, request, far) {
  const {eye, right, up, direction} = request;
  camera.fov = request.fov_y_rad * 180 / Math.PI;
  camera.aspect = request.size[0] / request.size[1];
  camera.near = request.near;
  camera.far = request.far ?? far;
  camera.matrix.set(right[0], up[0], -direction[0], eye[0], right[1], up[1], -direction[1], eye[1],
                    right[2], up[2], -direction[2], eye[2], 0, 0, 0, 1);
  camera.matrix.decompose(camera.position, camera.quaternion, camera.scale);
  camera.updateProjectionMatrix();
  camera.updateMatrixWorld(true);
}

export async function load(request, s) {
  const renderer = await renderer_for(s), [width, height] = request.size;
  renderer.toneMapping = THREE.NoToneMapping;
  renderer.setPixelRatio(1);
  renderer.setSize(width, height);
  const gltf = await new GLTFLoader().loadAsync('/scene.glb');
  const scene = new THREE.Scene(), camera = new THREE.PerspectiveCamera();
  scene.add(gltf.scene);
  scene.background = new THREE.Color().setRGB(...request.background);
  // An ambient light is an irradiance, which a white surface reflects divided by π.
  const ambient = new THREE.AmbientLight(0xffffff, Math.PI);
  ambient.color.setRGB(...request.ambient);
  scene.add(ambient);
  const Target = s.lights === 'forward' ? WebGLRenderTarget : THREE.RenderTarget;
  const target = new Target(width, height, {type: THREE.FloatType, samples: 0});
  renderer.setRenderTarget(target);
  return {gl: s.lights === 'forward' ? renderer.getContext() : renderer.backend.gl,
          place: next => place(camera, next, s.far), draw: () => renderer.render(scene, camera),
          texture: () => s.lights === 'forward' ? renderer.properties.get(target.texture).__webglTexture
                                                : renderer.backend.get(target.texture).textureGPU};
}
