// Blended surfaces, back to front, over opaque ones, with depth test. They have a light grid of their own, or
// lights by object, since they may lie anywhere between the near plane and the opaque surface behind them.
//
// The image may be infinite behind them, and infinity times 1 - alpha is NaN where alpha is 1. A first draw
// therefore limits what the image holds there. The shader limits the surfaces' own radiance, so that it stays
// finite.
#include "passes/shade_forward.h"

#include "passes/find_object_lights.h"
#include "renderer/drawing/draw.h"

namespace lightgrid {

static ShadedImage shade_opaque(PassContext& work, const DrawList& surfaces, const LightSource& lights,
                                bool depth_too) {
  const GlLightLoop& loop = lights.in_gl();
  auto pass = work.timer.pass("shade_forward", "gl");
  const ShadedImage image = begin_shading(work);
  if (depth_too) {
    glDepthFunc(GL_GEQUAL);
    glDepthMask(GL_TRUE);
  }
  glDisable(GL_BLEND);
  loop.bind(work);
  draw_list(work, surfaces, DrawStreams::all,
            work.programs({"shaders/scene.vert", "shaders/forward.frag", loop.defines}));
  glDepthMask(GL_FALSE);
  pass.moves(work.gpu.in_gl().geometry_bytes() + work.grid().values() * 4 + lights.bytes,
             work.grid().values() * (depth_too ? 20 : 16));
  return image;
}

ShadedImage shade_forward(PassContext& work, const DrawList& surfaces, const LightSource& lights) {
  return shade_opaque(work, surfaces, lights, false);
}

ShadedImage shade_forward_and_depth(PassContext& work, const DrawList& surfaces, const LightSource& lights) {
  return shade_opaque(work, surfaces, lights, true);
}

// If surfaces have the same depth, the last is visible, and only it gets light: all are drawn last to first,
// and the stencil lets a pixel take one.
void add_lights_forward(PassContext& work, const DrawList& surfaces, const LightSource& lights,
                        const ShadedImage& image) {
  GlLightLoop loop = lights.in_gl();
  loop.defines.emplace_back("ADDED");
  auto pass = work.timer.pass("shade_forward", "gl");
  glBindFramebuffer(GL_FRAMEBUFFER, image.framebuffer);
  const GLint none = 0;
  glStencilMask(255);
  glClearNamedFramebufferiv(image.framebuffer, GL_STENCIL, 0, &none);
  glEnable(GL_STENCIL_TEST);
  glStencilFunc(GL_EQUAL, 0, 255);
  glStencilOp(GL_KEEP, GL_KEEP, GL_INCR);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_EQUAL);
  glDepthMask(GL_FALSE);
  glEnable(GL_BLEND);
  glBlendEquation(GL_FUNC_ADD);
  glBlendFuncSeparate(GL_ONE, GL_ONE, GL_ZERO, GL_ONE);
  loop.bind(work);
  DrawList last_to_first(surfaces.rbegin(), surfaces.rend());
  for (DrawItem& item : last_to_first) item.ranges = in_reverse(item.ranges, work.gpu.in_gl());
  draw_list(work, last_to_first, DrawStreams::all,
            work.programs({"shaders/scene.vert", "shaders/forward.frag", loop.defines}));
  glDisable(GL_BLEND);
  glDisable(GL_STENCIL_TEST);
  pass.moves(work.gpu.in_gl().geometry_bytes() + work.grid().values() * 21 + lights.bytes,
             work.grid().values() * 17);
}

namespace {

uint32_t features_of_limit(uint32_t features) { return features & features_of_base_color; }

void limit_behind_opaque(PassContext& work) {
  ScenePrograms& programs =
      work.programs({"shaders/scene.vert", "shaders/depth.frag", {"LIMIT"}, true, features_of_limit});
  InstanceDrawer drawer(work, DrawStreams::all);
  glBlendEquation(GL_MIN);
  for (const DrawItem& item : work.blended) {
    const int material = work.scene.meshes[work.scene.instances[item.instance].mesh].material;
    if (work.scene.materials[material].base_color.a < 1)
      continue;  // the factor of textures and vertex colours
    drawer.bind(item.instance, programs.of(work.plan.surfaces.features_of_instance[item.instance]));
    drawer.draw(item.ranges);
  }
}

template <typename Draw>
void blend(PassContext& work, const ShadedImage& image, const LightSource& lights, const Draw& draw) {
  if (!work.plan.surfaces.blend) return;
  const GlLightLoop& loop = lights.in_gl();
  auto pass = work.timer.pass("shade_blended", "gl");
  glBindFramebuffer(GL_FRAMEBUFFER, image.framebuffer);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GEQUAL);
  glDepthMask(GL_FALSE);
  glEnable(GL_BLEND);
  limit_behind_opaque(work);
  glBlendEquation(GL_FUNC_ADD);
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);  // colours are premultiplied by coverage
  loop.bind(work);
  std::vector<std::string> defines = loop.defines;
  defines.emplace_back("BLEND");
  draw(work.programs({"shaders/scene.vert", "shaders/forward.frag", std::move(defines), true}));
  glDisable(GL_BLEND);
  pass.moves(work.gpu.in_gl().geometry_bytes() + work.grid().values() * 20, work.grid().values() * 16);
}

}  // namespace

void shade_blended(PassContext& work, const ShadedImage& image, const LightSource& lights) {
  blend(work, image, lights,
        [&](ScenePrograms& programs) { draw_list(work, work.blended, DrawStreams::all, programs); });
}

void shade_blended(PassContext& work, const ShadedImage& image, const ObjectLights& objects) {
  blend(work, image, from_objects(work, objects), [&](ScenePrograms& programs) {
    InstanceDrawer drawer(work, DrawStreams::all);
    for (const ObjectLights::Object& object : objects.objects()) {
      const SceneProgram& program = programs.of(work.plan.surfaces.features_of_instance[object.instance]);
      drawer.bind(object.instance, program);
      glUniform2i(program.lights_of_draw, GLint(object.first_light), GLint(object.light_count));
      drawer.draw(object.ranges);
    }
  });
}

}  // namespace lightgrid
