// PlayCanvas: clustered lights.
import * as pc from 'playcanvas';
import {apply_changes} from '/tools/plane_page.mjs';

// The engine's own settings; `gltf` names changes of its formulas.
export const settings = {cells: '10x3x10', maxLights: 255, maxLightsPerCell: 255, far: 1000, gltf: ''};

// Each makes one formula of the shaders that of docs/put_your_renderer_on_the_plane.md, for lights of `unit`.
const changes = {
  window: ['falloffInvSquaredPS', 'square(saturate(1.0 - square(sqrDist * square(invRadius))))',
           'saturate(1.0 - square(sqrDist * square(invRadius)))'],
  near: ['falloffInvSquaredPS', '1.0 / (sqrDist + 1.0)', '1.0 / sqrDist'],
  cone: ['spotPS', 'smoothstep(lightOuterConeAngle, lightInnerConeAngle, cosAngle)',
         'square(saturate((cosAngle - lightOuterConeAngle) / (lightInnerConeAngle - lightOuterConeAngle)))'],
  lobe: ['lightSpecularBlinnPS', 'return calcLightSpecular(gloss, worldNormal, h);',
         'float a2 = pow(max(1.0 - gloss, 0.045), 4.0), nh = max(dot(worldNormal, h), 0.0), nl = max(dot(worldNormal, -lightDirNorm), 0.0);' +
         'float nv = max(dot(worldNormal, viewDir), 1e-4), d = nh * nh * (a2 - 1.0) + 1.0;' +
         'return 0.5 * a2 / (d * d) / (nl * sqrt(nv * nv * (1.0 - a2) + a2) + nv * sqrt(nl * nl * (1.0 - a2) + a2) + 1e-7);'],
  fresnel: ['fresnelSchlickPS', 'max(vec3(glossSq * specIntensity), specularity)', 'vec3(1.0)'],
  diffuse: ['clusteredLightPS', 'vec3 punctualDiffuse = falloffAttenuation *', 'vec3 punctualDiffuse = falloffAttenuation * 0.96 * ' +
            '(1.0 - pow5(1.0 - saturate(dot(viewDir, normalize(viewDir - lightDirNormW))))) *'],
  ambient: ['litForwardBackendPS', 'dDiffuseLight = dDiffuseLight * (1.0 - litArgs_specularity);',
            'dSpecularLight += dDiffuseLight * litArgs_specularity;'],
};

// The engine's light of intensity 1 is 16 at a great distance, and its diffuse surfaces do not divide by π.
const unit = 16 * Math.PI;

// The loader clamps intensities to 2 and takes the linear colours for sRGB. Here lights have their own.
function set_light(light, entity) {
  const scale = (light.intensity ?? 1) / (light.type === 'directional' ? Math.PI : unit);
  entity.light.intensity = 1;  // below 1 the engine scales colours before it decodes them
  entity.light.color = new pc.Color((light.color ?? [1, 1, 1]).map(c => c * scale)).gamma();
  entity.light.enabled = true;
}

function load_scene(app) {
  const asset = new pc.Asset('scene', 'container', {url: '/scene.glb'}, null, {light: {postprocess: set_light}});
  app.assets.add(asset);
  app.assets.load(asset);
  return new Promise((done, fail) => asset.once('load', () => done(asset.resource.instantiateRenderEntity())).once('error', fail));
}

function place(camera, request, far) {
  const {right: r, up: u, direction: d, eye} = request;
  const world = new pc.Mat4().set([...r, 0, ...u, 0, ...d.map(v => -v), 0, ...eye, 1]);
  camera.setRotation(new pc.Quat().setFromMat4(world));
  camera.setPosition(...eye);
  Object.assign(camera.camera, {fov: request.fov_y_rad * 180 / Math.PI, nearClip: request.near, farClip: request.far ?? far});
}

export async function load(request, s) {
  const canvas = document.body.appendChild(document.createElement('canvas')), [width, height] = request.size;
  const app = new pc.Application(canvas, {graphicsDeviceOptions: {antialias: false}}), device = app.graphicsDevice;
  app.setCanvasFillMode(pc.FILLMODE_NONE, width, height);
  app.setCanvasResolution(pc.RESOLUTION_FIXED, width, height);
  const chunks = pc.ShaderChunks.get(device, pc.SHADERLANGUAGE_GLSL);
  apply_changes(changes, s.gltf, name => chunks.get(name), (name, text) => chunks.set(name, text));
  Object.assign(app.scene.lighting, {cells: new pc.Vec3(s.cells.split('x').map(Number)), maxLights: s.maxLights,
                                     maxLightsPerCell: s.maxLightsPerCell, shadowsEnabled: false, cookiesEnabled: false});
  app.scene.ambientLight = new pc.Color(request.ambient).gamma();
  app.root.addChild(await load_scene(app));
  const texture = new pc.Texture(device, {width, height, format: pc.PIXELFORMAT_RGBA32F, mipmaps: false,
                                          minFilter: pc.FILTER_NEAREST, magFilter: pc.FILTER_NEAREST});
  const camera = new pc.Entity();
  camera.addComponent('camera', {clearColor: new pc.Color(request.background), gammaCorrection: pc.GAMMA_NONE,
                                 toneMapping: pc.TONEMAP_LINEAR});
  camera.camera.renderTarget = new pc.RenderTarget({colorBuffer: texture, depth: true, flipY: false});
  app.root.addChild(camera);
  app.start();
  cancelAnimationFrame(app.frameRequestId);  // frames are drawn when requested
  return {gl: device.gl, place: next => place(camera, next, s.far), draw: () => app.render(), texture: () => texture.impl._glTexture};
}
