#include "renderer/work.h"

#include <fmt/format.h>

#include "cl/transfer.h"

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

Work::Work(Renderer& renderer, GpuScene& gpu, const Seen& seen, std::shared_ptr<TargetPool> pool)
    : renderer(renderer),
      gpu(gpu),
      timer(clock_of(renderer)),
      targets(std::move(pool), seen.grid(), seen.plan.stencil),
      seen_(seen) {}

std::vector<std::string> Work::view_defines(std::vector<std::string> defines) const {
  if (seen_.view.orthographic) defines.emplace_back("ORTHOGRAPHIC");
  if (seen_.plan.settings.everything_on) defines.emplace_back("EVERYTHING_ON");
  return defines;
}

ScenePrograms& Work::programs(SurfaceShaders shaders) {
  std::string key = fmt::format("{} {}", shaders.vertex, shaders.fragment);
  for (const std::string& name : shaders.defines) key += " " + name;
  auto found = programs_.find(key);
  if (found == programs_.end()) {
    shaders.defines = view_defines(std::move(shaders.defines));
    found = programs_.try_emplace(key, renderer, shaders).first;
  }
  if (preparing_) {
    for (const int i : shaders.blended ? seen_.plan.blended : seen_.plan.opaque)
      found->second.of(seen_.plan.features_of_instance[i]);
  }
  return found->second;
}

const GlProgram& Work::program(const std::string& vertex, const std::string& fragment,
                               std::vector<std::string> defines) {
  return renderer.program(vertex, fragment, view_defines(std::move(defines)));
}

GLuint Work::color_framebuffer() {
  return targets.framebuffer({targets.texture("color", GL_RGBA32F)}, targets.depth());
}

SharedBuffer& Work::shared_pixels(const std::string& name, size_t bytes, TargetUse use) {
  return targets.buffer(*renderer.cl, renderer.bridge, name, (seen_.grid().values() + spare_pixels) * bytes,
                        use);
}

const ClLights& Work::cl_lights() {
  if (!cl_lights_) cl_lights_stale_ = true, cl_lights_.emplace();
  if (cl_lights_stale_) cl_lights_->upload(*renderer.cl, seen_.scene, seen_.view, seen_.plan, seen_.params);
  cl_lights_stale_ = false;
  return *cl_lights_;
}

}  // namespace lightgrid
