#include "renderer/pass_context.h"

#include <fmt/format.h>

#include <cmath>

#include "cl/transfer.h"
#include "plan/settings/kernels.h"
#include "plan/settings/samples.h"
#include "raster/raster_samples.h"

namespace lightgrid {

static PassTimer::Clock clock_of(Renderer& renderer) {
  PassTimer::Clock clock;
  clock.start = [&renderer](const std::string& on) {
    if (on == "cl") renderer.cl->profiler().time_launches(true);
  };
  clock.stop = [&renderer](const std::string& on) {
    std::vector<KernelTime> kernels;
    if (on != "cl") {
      glFinish();
      return kernels;
    }
    finish_queue(*renderer.cl, "timing a pass");
    ClProfiler& profiler = renderer.cl->profiler();
    for (const ClProfiler::Row& row : profiler.collect()) kernels.push_back({row.label, row.ms});
    profiler.time_launches(false);
    return kernels;
  };
  return clock;
}

PassContext::PassContext(ViewState seen, Renderer& renderer, GpuScene& gpu, std::shared_ptr<TargetPool> pool)
    : ViewState(std::move(seen)),
      renderer(renderer),
      gpu(gpu),
      timer(clock_of(renderer)),
      targets(std::move(pool), grid(), plan.stencil) {}

std::vector<std::string> PassContext::view_defines(std::vector<std::string> defines) {
  if (view.orthographic) defines.emplace_back("ORTHOGRAPHIC");
  const bool samples = plan.opengl && grid().samples > 1;
  if (samples) defines.push_back(fmt::format("SAMPLES {}", grid().samples));
  if (const std::string masks = mask_define(plan.settings[setting::samples_masks]);
      samples && !masks.empty()) {
    std::string offsets;
    for (const glm::ivec2& place : sample_places())
      offsets += fmt::format("{}vec2({}, {}) / 256.0", offsets.empty() ? "" : ", ", place.x, place.y);
    defines.push_back(masks);
    defines.push_back("SAMPLE_OFFSETS " + offsets);
  }
  if (plan.settings[setting::everything_on]) defines.emplace_back("EVERYTHING_ON");
  return defines;
}

ScenePrograms& PassContext::programs(SurfaceShaders shaders) {
  std::string key = fmt::format("{} {}", shaders.vertex, shaders.fragment);
  for (const std::string& name : shaders.defines) key += " " + name;
  auto found = programs_.find(key);
  if (found == programs_.end()) {
    shaders.defines = view_defines(std::move(shaders.defines));
    found = programs_.try_emplace(key, renderer, shaders).first;
  }
  if (preparing_) {
    for (const int i : shaders.blended ? plan.surfaces.blended : plan.surfaces.opaque)
      found->second.of(plan.surfaces.features_of_instance[i]);
  }
  return found->second;
}

const GlProgram& PassContext::program(const std::string& vertex, const std::string& fragment,
                                      std::vector<std::string> defines) {
  return renderer.program(vertex, fragment, view_defines(std::move(defines)));
}

GLuint PassContext::color_framebuffer() {
  return targets.framebuffer({targets.texture("color", GL_RGBA32F)}, targets.depth());
}

const std::vector<glm::ivec2>& PassContext::sample_places() {
  if (!sample_places_.empty()) return sample_places_;
  if (grid().samples == 1 || !plan.opengl) {
    const auto places = raster_samples(grid().samples);
    return sample_places_ = {places.begin(), places.end()};
  }
  GLint bound = 0;
  glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &bound);
  glBindFramebuffer(GL_FRAMEBUFFER, depth_framebuffer());
  for (GLuint s = 0; s < GLuint(grid().samples); ++s) {
    float place[2] = {0.5f, 0.5f};
    glGetMultisamplefv(GL_SAMPLE_POSITION, s, place);
    sample_places_.emplace_back(std::lround((place[0] - 0.5f) * 256), std::lround((place[1] - 0.5f) * 256));
  }
  glBindFramebuffer(GL_FRAMEBUFFER, GLuint(bound));
  return sample_places_;
}

SharedBuffer& PassContext::shared_pixels(const std::string& name, size_t bytes, TargetUse use) {
  return targets.buffer(*renderer.cl, renderer.bridge, name, (grid().pixels() + spare_pixels) * bytes, use);
}

SharedBuffer& PassContext::shared_samples(const std::string& name, size_t bytes, TargetUse use) {
  return targets.buffer(*renderer.cl, renderer.bridge, name, (grid().values() + spare_pixels) * bytes, use);
}

const ClLights& PassContext::cl_lights() {
  if (!cl_lights_) {
    cl_lights_stale_ = true;
    cl_lights_.emplace();
  }
  if (cl_lights_stale_) cl_lights_->upload(*renderer.cl, *this);
  cl_lights_stale_ = false;
  return *cl_lights_;
}

ClArguments PassContext::light_arguments() {
  ClArguments arguments = cl_lights().columns() + effects.reach_arguments();
  return plan.shadows.light_reaches ? std::move(arguments) + shadows.arguments() : arguments;
}

std::array<std::unique_ptr<PassCache>*, 19> PassCaches::all() {
  return {&opaque_triangles.made_, &blended_triangles.made_, &resolver.made_,
          &tile_shading.made_,     &light_sums.made_,        &light_volumes.made_,
          &light_index.made_,      &object_lights.made_,     &blended_object_lights.made_,
          &voxels.made_,           &world_grid.made_,        &shadow_bits.made_,
          &fragment_layers.made_,  &index_shadows.made_,     &pixel_edges.made_,
          &tile_masks.made_,       &sample_edges.made_,      &list_caps.made_,
          &tone_map.made_};
}

void PassCaches::follow(PassContext& work) {
  for (std::unique_ptr<PassCache>* cache : all()) {
    if (*cache && !(*cache)->follow(work)) cache->reset();
  }
}

void PassCaches::upload(PassContext& work) {
  for (std::unique_ptr<PassCache>* cache :
       {&opaque_triangles.made_, &blended_triangles.made_, &resolver.made_}) {
    if (*cache) (*cache)->upload(work);
  }
}

void PassCaches::clear() {
  for (std::unique_ptr<PassCache>* cache : all()) cache->reset();
}

size_t PassCaches::memory_bytes() const {
  size_t bytes = 0;
  for (const std::unique_ptr<PassCache>* cache : const_cast<PassCaches*>(this)->all())
    bytes += *cache ? (*cache)->memory_bytes() : 0;
  return bytes;
}

}  // namespace lightgrid
