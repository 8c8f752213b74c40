#include "compare/comparison.h"

#include <algorithm>

#include "base/error.h"
#include "base/log.h"
#include "base/text.h"
#include "compare/contestants.h"

namespace lightgrid::lab {
namespace {

const std::vector<std::string> techniques_without_opengl = {"visibility:lights=all", "visibility"};

int parse_lights(const std::string& text) {
  const auto count = parse_number<int>(text);
  if (!count || *count < 0 || *count > max_lights)
    throw input_error("lights {}: not a number from 0 to {}", text, max_lights);
  return *count;
}

ReferencePixels parse_reference(const std::string& text) {
  if (text == "auto") return ReferencePixels::automatic;
  if (text == "full") return ReferencePixels::full;
  if (text == "sampled") return ReferencePixels::sampled;
  throw input_error("reference {}: not full, sampled or auto", text);
}

// The first number above 0, whose ranges all lights of a series have; 0 for a single number.
int ranges_of_series(const std::vector<int>& counts) {
  const auto first = std::ranges::find_if(counts, [](int count) { return count > 0; });
  return counts.size() < 2 || first == counts.end() ? 0 : *first;
}

std::vector<SceneChoice> chosen_views(const CompareChoice& choice) {
  std::vector<int> counts;
  for (const std::string& text : choice.lights) counts.push_back(parse_lights(text));
  if (counts.empty()) counts.push_back(-1);
  const bool keeps_ranges = parse_kept(choice.keep, choice.scene) == Kept::range;
  std::vector<SceneChoice> views;
  for (const std::string& scene : choice.scenes) {
    for (const std::string& size : choice.sizes) {
      parse_size(size);
      for (const int lights : counts) {
        SceneChoice& view = views.emplace_back(choice.scene);
        view.scene = scene;
        view.size = size;
        view.lights = lights;
        view.ranges_of = keeps_ranges ? ranges_of_series(counts) : 0;
        view.device = choice.devices.device;
      }
    }
  }
  return views;
}

// The reference's, else the first.
const Image& picture_of(const CompareReport& report) {
  size_t row = 0;
  while (row + 1 < report.rows.size() && image_of(report, row).pixels.empty()) ++row;
  const Image& reference = reference_image(report);
  return reference.pixels.empty() ? image_of(report, row) : reference;
}

// A view's cost relative to the others, roughly: pixels, and pixels times lights for techniques without
// lists.
double cost_of(const LoadedView& view) {
  return double(view.view.width) * view.view.height * double(64 + view.lights.size());
}

}  // namespace

const std::vector<std::string>& default_techniques() {
  static const std::vector<std::string> names = {"forward", "forward_plus", "visibility"};
  return names;
}

std::vector<Contestant> contestants_of(const CompareChoice& choice) {
  return chosen_contestants(choice.techniques.empty() ? default_techniques() : choice.techniques,
                            chosen_settings(choice.scene), choice.compare);
}

std::vector<Contestant> runnable(const CompareChoice& choice, const std::vector<Contestant>& contestants,
                                 const Renderer& devices) {
  if (devices.gl) return contestants;
  if (!choice.techniques.empty()) {
    const auto needs_opengl = [](const Contestant& c) { return !own_surfaces(*c.technique, c.settings); };
    if (std::ranges::any_of(contestants, needs_opengl)) devices.require_gl();
    return contestants;
  }
  log_warning(
      "{}; left out, since they draw with it: forward, forward_plus. The reference is visibility:lights=all",
      devices.why_no_gl);
  return chosen_contestants(techniques_without_opengl, chosen_settings(choice.scene), choice.compare);
}

CompareReport compare_view(Renderer& devices, Scene& scene, const View& view, const SceneChoice& view_choice,
                           const CompareChoice& choice, const std::vector<Contestant>& contestants,
                           const std::function<void(double done, const std::string& step)>& progress,
                           const std::string& which, bool all_may_refuse) {
  const WarningCollector collector;
  CompareOptions options{.frames = choice.timing.frames,
                         .warmup = choice.timing.warmup,
                         .reference = parse_reference(choice.reference),
                         .seed = view_choice.seed,
                         .path = chosen_path(scene, view, view_choice),
                         .flip = choice.flip,
                         .all_may_refuse = all_may_refuse};
  if (!options.path.empty()) options.advance = chosen_motion(scene, view_choice);
  options.progress = progress;
  options.exposure = [&](const Image& reference) { return chosen_exposure(view_choice, reference); };
  options.notice = [&](const std::string& what) { log_info("{}{}", which, what); };
  CompareReport report = compare_techniques(devices, scene, view, contestants, options);
  report.warnings = collector.warnings();
  report.exposure = chosen_exposure(view_choice, picture_of(report));
  tell_exposure(report.exposure, which);
  return report;
}

Comparison load_comparison(const CompareChoice& choice) {
  Comparison comparison{choice, {}, {}};
  comparison.contestants = contestants_of(choice);
  parse_reference(choice.reference);
  parse_gl_backend(choice.devices.gl);
  comparison.views = load_views(chosen_views(choice));
  return comparison;
}

void run_comparison(const Comparison& comparison,
                    const std::function<void(double done, const std::string& step)>& progress,
                    const std::function<void(CompareReport report)>& found) {
  const CompareChoice& choice = comparison.choice;
  Renderer devices(choice.devices.device, parse_gl_backend(choice.devices.gl));
  const WarningCollector of_run;
  const std::vector<Contestant> contestants = runnable(choice, comparison.contestants, devices);
  const std::vector<Warning> of_devices = of_run.warnings();
  const size_t count = comparison.views.size();
  const std::vector<SceneChoice> choices = chosen_views(choice);
  double total = 0, before = 0;
  for (const LoadedView& view : comparison.views) total += cost_of(view);
  for (size_t i = 0; i < count; ++i) {
    const LoadedView& view = comparison.views[i];
    const double cost = cost_of(view);
    const std::string which = count > 1 ? fmt::format("{}/{} {}: ", i + 1, count, view.scene->name) : "";
    CompareReport report = compare_view(
        devices, view.with_lights(), view.view, choices[i], choice, contestants,
        [&](double done, const std::string& step) {
          if (progress) progress((before + done * cost) / total, which + step);
        },
        which, count > 1);
    std::vector<Warning> warnings = of_devices;
    add_distinct(warnings, view.warnings);
    add_distinct(warnings, report.warnings);
    report.warnings = std::move(warnings);
    if (choice.lights.size() > 1) {
      report.lights_kept = name_of(parse_kept(choice.keep, choice.scene));
      const bool given = !choice.scene.light_radius.empty() || !choice.scene.lights_file.empty();
      report.ranges_of = given ? 0 : choices[i].ranges_of;
    }
    found(std::move(report));
    before += cost;
  }
}

std::vector<CompareReport> compare_views(
    const CompareChoice& choice, const std::function<void(double done, const std::string& step)>& progress) {
  std::vector<CompareReport> reports;
  run_comparison(load_comparison(choice), progress,
                 [&](CompareReport report) { reports.push_back(std::move(report)); });
  return reports;
}

}  // namespace lightgrid::lab
