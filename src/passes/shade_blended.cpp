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

void limit_behind_opaque(Work& work, const Seen& seen) {
  ScenePrograms& programs =
      work.programs({"shaders/scene.vert", "shaders/depth.frag", {"LIMIT"}, true, features_of_limit});
  InstanceDrawer drawer(work, seen, DrawStreams::all);
  glBlendEquation(GL_MIN);
  for (const DrawItem& item : seen.blended) {
    const int material = seen.scene.meshes[seen.scene.instances[item.instance].mesh].material;
    if (seen.scene.materials[material].base_color.a < 1)
      continue;  // of a factor of textures and vertex colours
    drawer.bind(item.instance, programs.of(seen.plan.features_of_instance[item.instance]));
    drawer.draw(item.ranges);
  }
}

template <typename Draw>
void blend(Work& work, const Seen& seen, const ShadedImage& image, const LightSource& lights,
           const Draw& draw) {
  if (!seen.plan.blend) return;
  const GlLightLoop& loop = lights.in_gl();
  auto pass = work.timer.pass("shade_blended", "gl");
  glBindFramebuffer(GL_FRAMEBUFFER, image.framebuffer);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GEQUAL);
  glDepthMask(GL_FALSE);
  glEnable(GL_BLEND);
  limit_behind_opaque(work, seen);
  glBlendEquation(GL_FUNC_ADD);
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);  // colours are premultiplied by coverage
  loop.bind(work);
  std::vector<std::string> defines = loop.defines;
  defines.emplace_back("BLEND");
  draw(work.programs({"shaders/scene.vert", "shaders/forward.frag", std::move(defines), true}));
  glDisable(GL_BLEND);
  pass.moves(work.gpu.in_gl().geometry_bytes() + seen.grid().values() * 20, seen.grid().values() * 16);
}

}  // namespace

void shade_blended(Work& work, const Seen& seen, const ShadedImage& image, const LightSource& lights) {
  blend(work, seen, image, lights,
        [&](ScenePrograms& programs) { draw_list(work, seen, seen.blended, DrawStreams::all, programs); });
}

void shade_blended(Work& work, const Seen& seen, const ShadedImage& image, const ObjectLights& objects) {
  blend(work, seen, image, from_objects(work, seen, objects), [&](ScenePrograms& programs) {
    InstanceDrawer drawer(work, seen, DrawStreams::all);
    for (const ObjectLights::Object& object : objects.objects()) {
      const SceneProgram& program = programs.of(seen.plan.features_of_instance[object.instance]);
      drawer.bind(object.instance, program);
      glUniform2i(program.lights_of_draw, GLint(object.first_light), GLint(object.light_count));
      drawer.draw(object.ranges);
    }
  });
}

}  // namespace lightgrid
