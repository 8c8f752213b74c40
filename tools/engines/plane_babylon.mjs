// Babylon.js: ClusteredLightContainer, or the lights of each material.
import '/modules/babylonjs/babylon.js';
import '/modules/babylonjs-loaders/babylonjs.loaders.js';
import {apply_changes} from '/tools/plane_page.mjs';

// The engine's own settings; `gltf` names changes of its formulas. maxSimultaneousLights counts a container as one light.
export const settings = {lights: 'clustered', horizontalTiles: 64, verticalTiles: 64, depthSlices: 16, maxSimultaneousLights: 4,
                         anisotropicFilteringLevel: 4, far: 10000, gltf: ''};

// Each makes one formula of the shaders that of docs/put_your_renderer_on_the_plane.md.
const changes = {
  window: ['pbrDirectLightingFalloffFunctions', 'attenuation*=attenuation;lightDistanceFalloff', 'lightDistanceFalloff'],
  roughness: ['pbrHelperFunctions', '#ifdef SPECULARAA', '#ifdef NO_SPECULARAA'],
  energy: ['pbrBlockFinalLitComponents', 'finalSpecularScaled*=coloredEnergyConservationFactor;', ''],
  fresnel: ['pbrClusteredLightingFunctions', 'info.specular=computeSpecularLighting(',
            'info.diffuse*=1.0-pow5(1.0-preInfo.VdotH);info.specular=computeSpecularLighting('],
  ambient: ['pbrBlockFinalUnlitComponents', 'finalAmbient*=surfaceAlbedo.rgb;',
            'finalAmbient*=surfaceAlbedo.rgb/0.96+reflectivityOut.colorReflectanceF0;'],
  clamp: ['pbrBlockImageProcessing', 'clamp(finalColor.rgb,0.,30.0)', 'finalColor.rgb'],
};

function prepare_materials(scene, s) {
  for (const texture of scene.textures) texture.anisotropicFilteringLevel = s.anisotropicFilteringLevel;
  for (const material of scene.materials) {
    material.ambientColor = BABYLON.Color3.White();  // its part of the scene's ambient light
    material.maxSimultaneousLights = s.maxSimultaneousLights;
    material.useGLTFLightFalloff = true;  // for the lights of a container, which must not have their own
  }
}

function prepare_lights(scene, s) {
  if (s.lights !== 'clustered') return;
  const container = new BABYLON.ClusteredLightContainer('lights', [], scene);
  Object.assign(container, {horizontalTiles: s.horizontalTiles, verticalTiles: s.verticalTiles, depthSlices: s.depthSlices});
  if (!container.isSupported) throw new Error('ClusteredLightContainer is not supported here');
  for (const light of [...scene.lights]) {
    light.falloffType = BABYLON.Light.FALLOFF_DEFAULT;  // the loader's FALLOFF_GLTF keeps a light out of the container
    if (BABYLON.ClusteredLightContainer.IsLightSupported(light)) container.addLight(light);
  }
}

function place(camera, request, far) {
  const vector = v => BABYLON.Vector3.FromArray(v);
  camera.position = vector(request.eye);
  camera.upVector = vector(request.up);
  camera.setTarget(vector(request.eye).add(vector(request.direction)));
  Object.assign(camera, {fov: request.fov_y_rad, minZ: request.near, maxZ: request.far ?? far});
}

export async function load(request, s) {
  const [width, height] = request.size, store = BABYLON.ShaderStore.IncludesShadersStore;
  const canvas = Object.assign(document.createElement('canvas'), {width, height});
  const engine = new BABYLON.Engine(canvas, false), scene = new BABYLON.Scene(engine);
  apply_changes(changes, s.gltf, name => store[name], (name, text) => store[name] = text);
  scene.useRightHandedSystem = true;
  scene.clearColor = new BABYLON.Color4(...request.background, 1);
  scene.ambientColor = new BABYLON.Color3(...request.ambient);
  await BABYLON.AppendSceneAsync('/scene.glb', scene);
  prepare_materials(scene, s);
  prepare_lights(scene, s);
  scene.imageProcessingConfiguration.applyByPostProcess = true;  // which there is none of: colours stay linear
  const camera = scene.activeCamera = new BABYLON.FreeCamera('camera', BABYLON.Vector3.Zero(), scene);
  const target = new BABYLON.RenderTargetTexture('target', {width, height}, scene, {
    generateMipMaps: false, type: BABYLON.Constants.TEXTURETYPE_FLOAT, samplingMode: BABYLON.Constants.TEXTURE_NEAREST_SAMPLINGMODE});
  camera.outputRenderTarget = target;
  place(camera, request, s.far);
  await scene.whenReadyAsync(true);
  return {gl: engine._gl, place: next => place(camera, next, s.far), draw: () => scene.render(),
          texture: () => target.getInternalTexture()._hardwareTexture.underlyingResource};
}
