#include "passes/resolve_samples.h"

#include "passes/frame_stages.h"
#include "plan/settings/samples.h"
#include "renderer/drawing/draw.h"

namespace lightgrid {

const char* average_define(const Settings& settings) {
  switch (settings[setting::samples_resolve]) {
    case SamplesResolve::linear:
      return nullptr;
    case SamplesResolve::tonemapped:
      return "AVERAGE_TONEMAPPED";
    case SamplesResolve::weighted:
      return "AVERAGE_WEIGHTED";
  }
  return nullptr;
}

ShadedImage resolve_samples(PassContext& work, const ShadedImage& image) {
  if (image.in_cl || work.grid().samples == 1) return image;
  auto pass = work.timer.pass("resolve_samples", "gl");
  const ShadedImage resolved{work.targets.framebuffer({work.targets.resolved("resolved", GL_RGBA32F)}, 0)};
  glBindFramebuffer(GL_FRAMEBUFFER, resolved.framebuffer);
  glViewport(0, 0, work.grid().width, work.grid().height);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
  bind_sampler_object(Sampler::image, 0);
  bind_texture(Sampler::image, work.targets.texture("color", GL_RGBA32F));
  std::vector<std::string> defines;
  if (const char* average = average_define(work.plan.settings)) defines.emplace_back(average);
  draw_screen(work.program("shaders/screen.vert", "shaders/resolve_samples.frag", std::move(defines)));
  pass.moves(work.grid().values() * 16, work.grid().pixels() * 16);
  return resolved;
}

static bool average(PassContext& work, PassCaches&, ShadedImage& image) {
  image = resolve_samples(work, image);
  return false;
}

extern const FrameStage sample_stage{.shaded = average};

}  // namespace lightgrid
