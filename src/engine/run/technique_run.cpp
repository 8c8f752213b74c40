#include "run/technique_run.h"

#include <algorithm>
#include <cmath>

#include "base/cpu_clock.h"
#include "base/finite_pixels.h"
#include "base/resident.h"
#include "gl/bindings.h"
#include "gl/gl.h"
#include "passes/tone_map.h"
#include "plan/settings/picture.h"
#include "plan/settings/samples.h"
#include "run/stage_figures.h"

namespace lightgrid {

static const TechniqueNeeds& checked_needs(const Technique& technique, const Settings& settings) {
  check_samples(technique, settings);
  check_picture(settings);
  return technique.needs;
}

static Frame draw(const Technique& technique, RenderView& view) {
  const bool opengl = view.renderer.gl != nullptr;
  if (opengl) reset_gl_state();
  Frame frame = draw_frame(technique, view);
  if (view.plan.settings[setting::picture] == PictureFormat::bytes)
    frame.displayed = tone_map(view, view.caches.tone_map, frame.image);
  if (opengl) check_gl(technique.name);
  return frame;
}

// Calls `draw` for the view's first time. If a kernel has yet to be compiled for this machine, a dry run first
// requests all that the view needs: threads compile them while OpenGL compiles its shaders.
static void draw_first(RenderView& view, const std::function<void()>& draw) {
  ProgramCache& kernels = *view.renderer.kernels;
  try {
    kernels.throw_if_missing(true);
    draw();
    return kernels.throw_if_missing(false);
  } catch (const KernelMissing&) {
    kernels.throw_if_missing(false);
  } catch (...) {
    kernels.throw_if_missing(false);
    throw;
  }
  view.restart();
  view.renderer.cl->dry_run = true;
  try {
    draw();
  } catch (...) {
    // Zeros may not be valid input. The frame below then compiles what was not requested, and reports errors.
  }
  view.renderer.cl->dry_run = false;
  view.restart();
  view.timer.clear();  // only the frame below is recorded
  draw();
  kernels.finish_requests();  // nothing compiles while later frames are timed
}

// A view of the same shape whose longest side is `side`.
static View reduced(View view, int side) {
  const int longest = std::max(view.width, view.height);
  for (int* length : {&view.width, &view.height})
    *length = std::max(1, int(int64_t(*length) * side / longest));
  return view;
}

constexpr int counted_side = 512;

// Bytes that a frame's passes keep, measured on two small frames.
static double kept_per_pixel(Renderer& renderer, GpuScene& gpu, const View& view, const Settings& settings,
                             const Technique& technique) {
  RenderView drawn(renderer, gpu, reduced(view, counted_side / 2), settings,
                   checked_needs(technique, settings));
  Image image;
  const auto kept = [&] {
    read_back(drawn, draw(technique, drawn).image, image);
    return double(drawn.memory_bytes());
  };
  const double before = kept(), pixels_before = double(drawn.view.grid().pixels());
  drawn.look(reduced(view, counted_side));
  return std::max(0.0, (kept() - before) / (double(drawn.view.grid().pixels()) - pixels_before));
}

// Throws Error(machine), with a size that fits, if a frame needs more memory than there is: a driver may not
// check its own allocations. PoCL ends the program.
static const View& fitting(Renderer& renderer, GpuScene& gpu, const View& view, const Settings& settings,
                           const Technique& technique, int file_bytes = 0) {
  // The image for the host, and an 8-bit picture; more than any technique's frame keeps.
  constexpr double image_bytes = 16, picture_bytes = 4, max_bytes = 256;
  constexpr uint64_t spare_bytes = 128 << 20;
  const double pixels = double(view.grid().pixels()), usable = double(usable_memory());
  const bool in_host = renderer.cl->info().cpu || (renderer.gl && renderer.gl->software);
  if (std::max(view.width, view.height) <= counted_side ||
      pixels * max_bytes * (1 + settings[setting::samples]) + spare_bytes < usable)
    return view;
  const std::string size = fmt::format("size {}x{}", view.width, view.height);
  double per_pixel = image_bytes + picture_bytes;
  try {
    if (in_host) per_pixel += kept_per_pixel(renderer, gpu, view, settings, technique);
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::input) throw;
    throw machine_error("{}: the scene cannot be drawn at a side of {} pixels either: {}", size, counted_side,
                        error.what());
  }
  per_pixel = std::max(per_pixel, image_bytes + file_bytes);
  constexpr double margin = 1.04;  // so that the size that is named fits
  const double room = std::max(0.0, double(usable_memory()) - double(spare_bytes)) / (per_pixel * margin);
  const double side = std::max(view.width, view.height) * std::sqrt(std::min(1.0, room / pixels));
  const View fits = reduced(view, std::max(counted_side, int(side)));
  require_memory(uint64_t(pixels * per_pixel) + spare_bytes, size,
                 fmt::format("--size {}x{} fits", fits.width, fits.height));
  return view;
}

TechniqueRun::TechniqueRun(Renderer& renderer, GpuScene& gpu, const View& view, const Settings& settings,
                           const Technique& technique, std::shared_ptr<TargetPool> pool, int file_bytes)
    : technique_(technique),
      view_(renderer, gpu, fitting(renderer, gpu, view, settings, technique, file_bytes), settings,
            checked_needs(technique, settings), std::move(pool)) {}

TechniqueRun::TechniqueRun(Renderer& renderer, const Scene& scene, const View& view, const Settings& settings,
                           const Technique& technique)
    : technique_(technique),
      own_scene_(std::make_unique<GpuScene>(renderer, scene)),
      view_(renderer, *own_scene_, fitting(renderer, *own_scene_, view, settings, technique), settings,
            checked_needs(technique, settings)) {}

void TechniqueRun::prepare() {
  hide();
  draw_first(view_, [&] { view_.prepare([&] { frame_ = draw(technique_, view_); }); });
  drawn_ = true;
  frame_ = {};
}

void TechniqueRun::release() {
  hide();
  view_.release();
  frame_ = {};
}

void TechniqueRun::draw_frame() {
  hide();
  const auto draw_view = [&] { frame_ = draw(technique_, view_); };
  if (drawn_) return draw_view();
  draw_first(view_, draw_view);
  drawn_ = true;
}

TechniqueRun::FrameTime TechniqueRun::time_frame(const std::function<void()>& read) {
  const double cpu_before_ms = process_cpu_ms();
  const Timer timer;
  draw_frame();
  read();
  const FrameTime time{timer.elapsed_ms(), process_cpu_ms() - cpu_before_ms};
  if (view_.renderer.gl) check_gl(technique_.name);
  return time;
}

double TechniqueRun::recorded(const FrameTime& time) {
  frame_ms_.push_back(time.ms);
  frame_cpu_ms_.push_back(time.cpu_ms);
  return time.ms;
}

TechniqueRun::FrameTime TechniqueRun::time_image() {
  return time_frame([&] { shown_.emplace(view_, frame_.image, image_); });
}

TechniqueRun::FrameTime TechniqueRun::time_picture() {
  return time_frame([&] { shown_picture_.emplace(view_, *frame_.displayed, picture_); });
}

double TechniqueRun::run_frame(bool warmup) {
  if (draws_bytes()) {
    const double ms = run_picture(warmup);
    read_back(view_, frame_.image, image_);
    return ms;
  }
  const FrameTime time = time_image();
  shown_->keep();
  return warmup ? time.ms : recorded(time);
}

double TechniqueRun::run_picture(bool warmup) {
  const FrameTime time = time_picture();
  shown_picture_->keep();
  return warmup ? time.ms : recorded(time);
}

glm::vec4* TechniqueRun::show_frame() {
  recorded(time_image());
  return shown_->pixels();
}

glm::u8vec4* TechniqueRun::show_picture() {
  recorded(time_picture());
  return shown_picture_->pixels();
}

void TechniqueRun::run_profiled_frames(double max_ms) {
  struct Enabled {
    PassTimer& timer;
    explicit Enabled(PassTimer& t) : timer(t) { timer.enabled = true; }
    ~Enabled() { timer.enabled = false; }  // also after an exception
  } enabled(view_.timer);
  const Timer timer;
  for (int i = 0; i < 5 && (i == 0 || timer.elapsed_ms() < max_ms); ++i) {
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

FrameFigures TechniqueRun::result() const {
  FrameFigures result;
  result.technique = technique_.name;
  result.settings = settings_of(technique_, view_.plan.settings);
  result.lights_total = int(view_.scene.lights.size());
  result.lights_in_view = view_.plan.lights.in_view;
  result.lights_virtual = view_.plan.lights.virtual_count;
  result.frame_ms = spread_of(frame_ms_);
  result.wall_ms = frame_ms_;
  result.cpu_ms = frame_cpu_ms_;
  for (const PassRecord& record : view_.timer.records()) {
    result.passes.push_back({record.name, record.on, spread_of(record.ms).median, record.bytes_read,
                             record.bytes_written, kernel_results(record)});
  }
  result.memory_total = view_.memory_bytes();
  result.memory_light_grid = frame_.light_grid_bytes();
  result.built_by = frame_.built_by;
  result.built_with = frame_.built_with;
  result.memory_gbuffer = view_.targets.bytes(TargetUse::gbuffer);
  result.nan_pixels = count_nan_pixels(image_);
  result.inf_pixels = count_inf_pixels(image_);
  for (const Decision& decision : view_.plan.decisions) {
    if (!decision.needed) result.skipped.push_back({decision.effect, decision.why});
  }
  result.effects = view_.effects.figures();
  add_stage_figures(view_.plan, frame_, result);
  return result;
}

}  // namespace lightgrid
