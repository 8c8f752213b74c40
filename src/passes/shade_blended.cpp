// Blended surfaces, back to front, over what is opaque: in front of it by the depth test, and with a light
// grid of their own, or lights by object, since they stand anywhere between the near plane and the opaque surface
// behind them.
#include "passes/frame/draw.h"
#include "passes/frame/light_defines.h"
#include "passes/object_lights.h"

namespace lightgrid {
namespace {

template <typename Draw>
void blend(Frame& f, const ShadedImage& image, const Draw& draw) {
  if (!f.plan.blend) return;
  auto pass = f.timer.pass("shade_blended", "gl");
  glBindFramebuffer(GL_FRAMEBUFFER, image.framebuffer);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GEQUAL);
  glDepthMask(GL_FALSE);
  glEnable(GL_BLEND);
  glBlendEquation(GL_FUNC_ADD);
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);  // colours come multiplied by coverage
  draw();
  glDisable(GL_BLEND);
  const size_t pixels = size_t(f.view.width) * f.view.height;
  pass.moves(f.gpu.geometry_bytes() + pixels * 20, pixels * 16);
}

const GlProgram& blended_program(Frame& f, std::vector<std::string> defines) {
  defines.emplace_back("BLEND");
  return f.program("shaders/scene.vert", "shaders/forward.frag", defines);
}

template <typename Lights>
void shade(Frame& f, const ShadedImage& image, const Lights& lights) {
  blend(f, image, [&] {
    bind_lights(f, lights);
    const auto program_of = [&](uint32_t features) -> const GlProgram& {
      return blended_program(f, light_defines(f, features, lights));
    };
    draw_instances(f, f.plan.blended, DrawStreams::all, program_of, nullptr, DrawOrder::as_given);
  });
}

}  // namespace

void shade_blended(Frame& f, const ShadedImage& image, const GridTextures* grid) { shade(f, image, grid); }

void shade_blended(Frame& f, const ShadedImage& image, const LightIndexImages& index) { shade(f, image, index); }

void shade_blended(Frame& f, const ShadedImage& image, const ObjectLights& objects) {
  blend(f, image, [&] {
    bind_lights(f, objects);
    InstanceDrawer drawer(f, DrawStreams::all);
    for (const ObjectLights::Object& object : objects.objects()) {
      const uint32_t features = f.plan.features_of_instance[object.instance];
      const GlProgram& program = blended_program(f, light_defines(f, features, objects));
      drawer.bind(object.instance, program);
      glUniform2i(program.uniform("lights_of_draw"), GLint(object.first_light), GLint(object.light_count));
      drawer.draw(index_ranges(f.gpu.mesh(f.scene.instances[object.instance].mesh), object.clusters));
    }
  });
}

}  // namespace lightgrid
