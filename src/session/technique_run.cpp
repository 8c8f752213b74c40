#include "session/technique_run.h"

#include <algorithm>

#include "base/resident.h"
#include "gl/bindings.h"
#include "gl/gl.h"
#include "passes/tone_map.h"
#include "results/metrics.h"

namespace lightgrid {

static const TechniqueNeeds& checked_needs(const Technique& technique, const Settings& settings) {
  check_samples(technique, settings);
  check_picture(settings);
  return technique.needs;
}

// The least that every technique takes: the shaded image in float, and surfaces where OpenCL draws on a CPU.
// A driver may not check its own allocations: PoCL ends the program.
static const View& fitting(const Renderer& renderer, const View& view) {
  const bool shared = renderer.cl && renderer.cl->info().cpu;
  const uint64_t bytes = uint64_t(view.width) * uint64_t(view.height) * (shared ? 24 : 16);
  require_memory(bytes, fmt::format("size {}x{}", view.width, view.height), "a smaller --size needs less");
  return view;
}

TechniqueRun::TechniqueRun(Renderer& renderer, GpuScene& gpu, const View& view, const Settings& settings,
                           const Technique& technique, std::shared_ptr<TargetPool> pool)
    : technique_(technique),
      view_(renderer, gpu, fitting(renderer, view), settings, checked_needs(technique, settings), std::move(pool)) {}

TechniqueRun::TechniqueRun(Renderer& renderer, const Scene& scene, const View& view, const Settings& settings,
                           const Technique& technique)
    : technique_(technique),
      own_scene_(std::make_unique<GpuScene>(renderer, scene)),
      view_(renderer, *own_scene_, fitting(renderer, view), settings, checked_needs(technique, settings)) {}

void TechniqueRun::prepare() {
  hide();
  view_.prepare([&] { draw_frame(); });
  frame_ = {};
}

void TechniqueRun::release() {
  hide();
  view_.release();
  frame_ = {};
}

void TechniqueRun::draw_frame() {
  hide();
  const bool opengl = view_.renderer.gl != nullptr;
  if (opengl) reset_gl_state();
  frame_ = lightgrid::draw_frame(technique_, view_);
  if (draws_bytes()) frame_.displayed = tone_map(view_, view_.caches.tone_map, frame_.image);
  if (opengl) check_gl(technique_.name);
}

double TechniqueRun::time_frame(const std::function<void()>& read) {
  const Timer timer;
  draw_frame();
  read();
  const double ms = timer.elapsed_ms();
  if (view_.renderer.gl) check_gl(technique_.name);
  return ms;
}

double TechniqueRun::time_image() {
  return time_frame([&] { shown_.emplace(view_, frame_.image, image_); });
}

double TechniqueRun::time_picture() {
  return time_frame([&] { shown_picture_.emplace(view_, *frame_.displayed, picture_); });
}

double TechniqueRun::run_frame(bool warmup) {
  if (draws_bytes()) {
    const double ms = run_picture(warmup);
    read_back(view_, frame_.image, image_);
    return ms;
  }
  const double ms = time_image();
  shown_->keep();
  if (!warmup) frame_ms_.push_back(ms);
  return ms;
}

double TechniqueRun::run_picture(bool warmup) {
  const double ms = time_picture();
  shown_picture_->keep();
  if (!warmup) frame_ms_.push_back(ms);
  return ms;
}

glm::vec4* TechniqueRun::show_frame() {
  frame_ms_.push_back(time_image());
  return shown_->pixels();
}

glm::u8vec4* TechniqueRun::show_picture() {
  frame_ms_.push_back(time_picture());
  return shown_picture_->pixels();
}

void TechniqueRun::run_profiled_frames(double most_ms) {
  struct Enabled {
    PassTimer& timer;
    explicit Enabled(PassTimer& t) : timer(t) { timer.enabled = true; }
    ~Enabled() { timer.enabled = false; }  // also after an exception
  } enabled(view_.timer);
  const Timer timer;
  for (int i = 0; i < 5 && (i == 0 || timer.elapsed_ms() < most_ms); ++i) {
    draws_bytes() ? run_picture(true) : run_frame(true);
  }
}

// In the order of their first launch.
static std::vector<KernelResult> kernel_results(const PassRecord& pass) {
  std::vector<std::pair<std::string, std::vector<double>>> by_name;
  for (const std::vector<KernelTime>& run : pass.kernels) {
    for (const KernelTime& kernel : run) {
      auto found =
          std::ranges::find(by_name, kernel.name, &std::pair<std::string, std::vector<double>>::first);
      if (found == by_name.end()) found = by_name.insert(by_name.end(), {kernel.name, {}});
      found->second.push_back(kernel.ms);
    }
  }
  std::vector<KernelResult> results;
  for (const auto& [name, ms] : by_name) results.push_back({name, spread_of(ms).median});
  return results;
}

static std::optional<ShadowResult> shadow_result(const FramePlan& plan, const Frame& frame) {
  if (plan.casting.empty()) return {};
  ShadowResult result;
  bool unchanged = false;
  if (frame.shadow_figures) {
    const ShadowFigures figures = frame.shadow_figures();
    result.lights = figures.lights, result.maps = figures.maps, result.drawn = figures.drawn;
    result.kept = figures.kept, result.bytes = figures.bytes;
    result.rays = figures.rays, result.undecided = figures.undecided;
    result.halvings = figures.halvings, result.bands = figures.bands;
    unchanged = figures.unchanged;
  }
  result.dim_steps = plan.dim_steps;
  if (plan.settings.everything_on) return result;
  for (const LightShadow& light : plan.casting) {
    const bool needed = light.need == ShadowNeed::rays;
    if (!needed || unchanged)
      result.skipped.push_back({light.light, needed ? unchanged_reason : reason_of(light.need)});
  }
  return result;
}

RunResult TechniqueRun::result() const {
  RunResult result;
  result.technique = technique_.name;
  result.settings = settings_of(technique_, view_.plan.settings);
  result.lights_total = int(view_.scene.lights.size());
  result.lights_in_view = view_.plan.lights_in_view;
  result.lights_virtual = view_.plan.virtual_count;
  result.frame_ms = spread_of(frame_ms_);
  for (const PassRecord& record : view_.timer.records()) {
    result.passes.push_back({record.name, record.on, spread_of(record.ms).median, record.bytes_read,
                             record.bytes_written, kernel_results(record)});
  }
  result.memory_total = view_.memory_bytes();
  result.memory_light_grid = frame_.light_grid_bytes();
  result.built_by = frame_.built_by, result.built_with = frame_.built_with;
  result.memory_gbuffer = view_.targets.bytes(TargetUse::gbuffer);
  result.nan_pixels = count_nan_pixels(image_);
  result.inf_pixels = count_inf_pixels(image_);
  for (const Decision& decision : view_.plan.decisions) {
    if (!decision.needed) result.skipped.push_back({decision.effect, decision.why});
  }
  result.shadows = shadow_result(view_.plan, frame_);
  if (frame_.sample_figures) {
    const SampleFigures f = frame_.sample_figures();
    result.samples = {f.edge_pixels, f.shadings, f.covered, f.bytes};
  }
  return result;
}

}  // namespace lightgrid
