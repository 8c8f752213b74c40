// Blended surfaces, back to front, over opaque ones, with depth test. They have a light grid of their own, or
// lights by object, since they may lie anywhere between the near plane and the opaque surface behind them.
//
// The image may be infinite behind them, and infinity times 1 - alpha is NaN where alpha is 1. A first draw
// therefore limits what the image holds there. The shader limits the surfaces' own radiance, so that it stays
// finite.
#include "passes/shade_blended.h"

#include "passes/find_object_lights.h"
#include "renderer/draw.h"

namespace lightgrid {
namespace {

uint32_t features_of_limit(uint32_t features) { return features & features_of_base_color; }

void limit_behind_opaque(RenderView& v) {
  ScenePrograms& programs =
      v.programs({"shaders/scene.vert", "shaders/depth.frag", {"LIMIT"}, true, features_of_limit});
  InstanceDrawer drawer(v, DrawStreams::all);
  glBlendEquation(GL_MIN);
  for (const DrawItem& item : v.blended) {
    const int material = v.scene.meshes[v.scene.instances[item.instance].mesh].material;
    if (v.scene.materials[material].base_color.a < 1) continue;  // of a factor of textures and vertex colours
    drawer.bind(item.instance, programs.of(v.plan.features_of_instance[item.instance]));
    drawer.draw(item.ranges);
  }
}

template <typename Draw>
void blend(RenderView& v, const ShadedImage& image, const LightSource& lights, const Draw& draw) {
  if (!v.plan.blend) return;
  const GlLightLoop& loop = lights.in_gl();
  auto pass = v.timer.pass("shade_blended", "gl");
  glBindFramebuffer(GL_FRAMEBUFFER, image.framebuffer);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GEQUAL);
  glDepthMask(GL_FALSE);
  glEnable(GL_BLEND);
  limit_behind_opaque(v);
  glBlendEquation(GL_FUNC_ADD);
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);  // colours are premultiplied by coverage
  loop.bind(v);
  std::vector<std::string> defines = loop.defines;
  defines.emplace_back("BLEND");
  draw(v.programs({"shaders/scene.vert", "shaders/forward.frag", std::move(defines), true}));
  glDisable(GL_BLEND);
  pass.moves(v.gpu.in_gl().geometry_bytes() + v.pixels() * 20, v.pixels() * 16);
}

}  // namespace

void shade_blended(RenderView& v, const ShadedImage& image, const LightSource& lights) {
  blend(v, image, lights,
        [&](ScenePrograms& programs) { draw_list(v, v.blended, DrawStreams::all, programs); });
}

void shade_blended(RenderView& v, const ShadedImage& image, const ObjectLights& objects) {
  blend(v, image, from_objects(v, objects), [&](ScenePrograms& programs) {
    InstanceDrawer drawer(v, DrawStreams::all);
    for (const ObjectLights::Object& object : objects.objects()) {
      const SceneProgram& program = programs.of(v.plan.features_of_instance[object.instance]);
      drawer.bind(object.instance, program);
      glUniform2i(program.lights_of_draw, GLint(object.first_light), GLint(object.light_count));
      drawer.draw(object.ranges);
    }
  });
}

}  // namespace lightgrid
