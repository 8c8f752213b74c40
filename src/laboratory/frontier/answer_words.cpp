// The answer in plain words: one paragraph, each sentence from figures that are there.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "frontier/answer_steps.h"
#include "frontier/fields.h"
#include "measures/speedup.h"
#include "measures/words.h"
#include "plan/settings.h"

namespace lightgrid::lab {
namespace {

// A technique's own error below which its picture is what its settings mean, as in report.h (exact_max_rel).
constexpr double same_picture = 1e-5;

// "3 rounds", or why figures that need more of them are missing.
std::string rounds_in_words(int rounds) {
  const std::string count = fmt::format("{} round{}", rounds, rounds == 1 ? "" : "s");
  return rounds < min_rounds ? fmt::format("{}; at least {} are needed", count, min_rounds) : count;
}

std::string interval_in_words(const RelativeTime& time) {
  if (!time.has_interval()) return "interval not measured: " + rounds_in_words(time.runs);
  return fmt::format("95 % interval {} to {}", three_digits(time.low), three_digits(time.high));
}

std::string probability_in_words(double probability) {
  if (probability > 0.995) return "more than 99 %";
  if (probability < 0.005) return "less than 1 %";
  return fmt::format("{:.0f} %", 100 * probability);
}

// True if two points are meant to show the same: the settings that change the model agree.
bool same_model(const PointFigures& a, const PointFigures& b) {
  static const auto defaults = to_strings(Settings{});
  const auto agree = [&](const std::string& setting) {
    const std::string key = json_key(setting);
    const auto value_of = [&](const PointFigures& p) {
      const auto found = p.point.settings.find(key);
      return found == p.point.settings.end() ? defaults.at(key) : found->second;
    };
    return value_of(a) == value_of(b);
  };
  return a.point.frames == b.point.frames && std::ranges::all_of(model_settings(), agree);
}

const PointFigures* baseline_of(const FrontierAnswer& answer, const std::string& scene) {
  for (const PointFigures& p : answer.points) {
    if (p.point.scene == scene && p.point.label == answer.part.baseline) return &p;
  }
  return nullptr;
}

// The time that sentences are of.
const RelativeTime& time_of(const FrontierAnswer& answer, const PointFigures& p) {
  return answer.by_device ? p.device.relative_time : p.relative_time;
}

const char* clock_in_words(const FrontierAnswer& answer) {
  return answer.by_device ? " by the devices' clocks" : "";
}

// The fastest of the points that compute the baseline's picture; -1 if there is none.
int fastest_same_picture(const FrontierAnswer& answer, const std::string& scene) {
  const PointFigures* baseline = baseline_of(answer, scene);
  int best = -1;
  // A baseline whose lights are points differs from a truth of spheres: no point then has the same picture.
  if (baseline && !(baseline->errors.technique.max_rel <= same_picture)) baseline = nullptr;
  for (size_t i = 0; baseline && i < answer.points.size(); ++i) {
    const PointFigures& p = answer.points[i];
    if (p.point.scene != scene || time_of(answer, p).runs == 0 || !same_model(p, *baseline)) continue;
    if (!(p.errors.technique.max_rel <= same_picture) || p.nan_pixels || p.pairs.lost) continue;
    if (best < 0 || time_of(answer, p).estimate < time_of(answer, answer.points[best]).estimate)
      best = int(i);
  }
  return best;
}

void add_fastest(const FrontierAnswer& answer, const std::string& scene,
                 std::vector<std::string>& sentences) {
  const int best = fastest_same_picture(answer, scene);
  if (best < 0) return;
  const PointFigures& p = answer.points[best];
  if (p.point.label == answer.part.baseline) {
    sentences.push_back(
        fmt::format("In {} no point that computes the same picture (to 1e-5 of the brightest channel) is "
                    "faster than {}.",
                    scene_in_words(scene), p.point.label));
  } else {
    sentences.push_back(fmt::format(
        "In {} the fastest point that computes the same picture as {} (to 1e-5 of the brightest channel) is "
        "{}: it takes {} times as long{} ({}).",
        scene_in_words(scene), answer.part.baseline, p.point.label, three_digits(time_of(answer, p).estimate),
        clock_in_words(answer), interval_in_words(time_of(answer, p))));
  }
  const PointErrors& e = p.errors;
  struct Kind {
    double rmse;
    const char *name, *in_words;
  };
  Kind largest{};
  std::vector<std::string> figures;
  for (const Kind& kind :
       {Kind{e.model.rmse_rel, "model", "the model's (where a light's range ends, and its window)"},
        Kind{e.precision.rmse_rel, "precision", "that of float precision"},
        Kind{e.technique.rmse_rel, "technique", "the technique's own"}}) {
    if (!std::isfinite(kind.rmse)) continue;
    if (kind.rmse > largest.rmse) largest = kind;
    figures.push_back(fmt::format("{} {}", kind.name, error_in_words(kind.rmse)));
  }
  if (!(largest.rmse > 0)) return;
  sentences.push_back(
      fmt::format("The largest error of {} is {}: {} (RMSE relative to the brightest channel).",
                  p.point.label, largest.in_words, fmt::join(figures, ", ")));
}

std::string cheapest_how_surely(const CheapestWithin& best, const FrontierAnswer& answer,
                                const PointFigures& p) {
  if (!std::isnan(best.probability))
    return "the cheapest with a probability of " + probability_in_words(best.probability);
  const int rounds = time_of(answer, p).runs;
  return "how surely it is the cheapest was not measured: " +
         (rounds < min_rounds ? rounds_in_words(rounds) : std::string("the control failed"));
}

// A line a step: from the largest error down, each point at the least error that it is the best within.
void add_cheapest_within(const FrontierAnswer& answer, const std::string& scene,
                         std::vector<std::string>& sentences) {
  std::vector<const CheapestWithin*> steps;
  const auto& cheapest = answer.by_device ? answer.device_cheapest_within : answer.cheapest_within;
  for (auto best = cheapest.rbegin(); best != cheapest.rend(); ++best) {
    if (best->scene != scene) continue;
    const bool goes_on = !steps.empty() && steps.back()->point == best->point && steps.back()->of == best->of;
    if (!goes_on) steps.push_back(nullptr);
    steps.back() = &*best;
  }
  for (const CheapestWithin* step : steps) {
    const PointFigures& p = answer.points[step->point];
    sentences.push_back(fmt::format(
        "FLIP as displayed up to {:g} in {}{}: {}, {} times {}{} ({}).", step->error, scene_in_words(scene),
        step->of == "authored" ? ", against lights with authored ranges" : "", p.point.label,
        three_digits(step->relative_time.estimate), answer.part.baseline, clock_in_words(answer),
        cheapest_how_surely(*step, answer, p)));
  }
}

bool is_of_technique(const std::string& label, const std::string& technique) {
  return label == technique || label.starts_with(technique + ":");
}

// Adds the shading cost of the scene that is compared with the most pairs of cull tests.
void add_break_even(const FrontierAnswer& answer, const std::string& scene,
                    std::vector<std::string>& sentences) {
  const ShadingCost* best = nullptr;
  int max_pairs = 0, max_won = 0, max_undecided = 0;
  for (const ShadingCost& cost : answer.shading_costs) {
    if (cost.scene != scene) continue;
    int all = 0, won = 0, undecided = 0;
    for (const BreakEven& pair : answer.break_even) {
      if (pair.scene != scene || !is_of_technique(pair.tighter, cost.technique)) continue;
      const double ns = cost.ns_per_pixel_light;
      const bool open = pair.rounds > 0 && pair.low <= ns && ns <= pair.high;
      ++all;
      undecided += open;
      won += !open && pair.ns_per_pixel_light < ns;
    }
    if (all > max_pairs) {
      best = &cost;
      max_pairs = all;
      max_won = won;
      max_undecided = undecided;
    }
  }
  if (!best) return;
  sentences.push_back(
      fmt::format("In {} a light at a pixel costs {} {} ns to shade{}: at that price the tighter cull test "
                  "wins in {} of {} pairs{}.",
                  scene_in_words(scene), best->technique, three_digits(best->ns_per_pixel_light),
                  best->brdf.empty() ? "" : " with " + best->brdf, max_won, max_pairs,
                  max_undecided > 0 ? fmt::format(" ({} undecided)", max_undecided) : ""));
}

// The property that all numbers of lights of the series share.
std::string kept_over_lights(const Growth* growth) {
  if (!growth || growth->kept.empty()) return "";
  return growth->kept == "range"
             ? " All numbers of lights have the same ranges."
             : " Ranges shrink as the number of lights grows, so that as many reach a point.";
}

// Tells the baseline's growth, or that of the series' first point.
void add_growth(const FrontierAnswer& answer, const std::string& scene, std::vector<std::string>& sentences) {
  const Growth* told[] = {nullptr, nullptr, nullptr};
  const std::string quantities[] = {"lights", "pixels", "radius"};
  for (const Growth& g : answer.growth) {
    const auto of = std::find(std::begin(quantities), std::end(quantities), g.of) - std::begin(quantities);
    if (g.scene != scene || of == 3 || !std::isfinite(g.low) || !std::isfinite(g.high)) continue;
    if (!told[of] || g.technique == answer.part.baseline) told[of] = &g;
  }
  std::map<std::string, std::vector<std::string>> laws;  // by point
  for (const Growth* g : told) {
    if (g)
      laws[g->technique].push_back(
          fmt::format("{}^{:.2f} ({:.2f} to {:.2f})", g->of, g->exponent, g->low, g->high));
  }
  for (const auto& [point, powers] : laws) {
    sentences.push_back(fmt::format("In {} the time of {} grows as {}.{}", scene_in_words(scene), point,
                                    fmt::join(powers, ", "), kept_over_lights(told[0])));
  }
}

void add_failures(const FrontierAnswer& answer, const std::string& scene,
                  std::vector<std::string>& sentences) {
  std::vector<std::string> parts;
  std::set<std::string> failed, all;
  for (const auto& [cause, words] : {std::pair<const char*, const char*>{"refused", "refused"},
                                     {"lost", "with lost lights"},
                                     {"wrong", "with wrong lights"},
                                     {"shadow", "with wrong shadows"},
                                     {"NaN", "with NaN"},
                                     {"overflow", "with lists that overflow by design"}}) {
    size_t count = 0;
    for (const Failure& f : answer.failures) {
      if (f.cause != cause || f.point.scene != scene) continue;
      ++count;
      failed.insert(f.point.label);
    }
    if (count) parts.push_back(fmt::format("{} {}", with_commas(count), words));
  }
  if (parts.empty()) return;
  for (const FrontierRecord& r : answer.part.records) {
    if (r.point.scene == scene) all.insert(label_in_series(r));
  }
  sentences.push_back(fmt::format("In {} {} of {} points failed: {}.", scene_in_words(scene),
                                  with_commas(failed.size()), with_commas(all.size()),
                                  fmt::join(parts, ", ")));
}

// Names the reference of errors, where that is not every light without a range.
void add_truth(const FrontierAnswer& answer, const std::string& scene, std::vector<std::string>& sentences) {
  const auto of_scene = std::ranges::find_if(
      answer.points, [&](const PointFigures& p) { return p.point.scene == scene && p.truth; });
  if (of_scene == answer.points.end()) return;
  const FrontierTruth& truth = *of_scene->truth;
  sentences.push_back(fmt::format(
      "Errors in {} are against every light {}{}{}.", scene_in_words(scene),
      truth.own_ranges ? "with its range" : "without a range",
      truth.source_m > 0 ? fmt::format(", each a sphere of {:g} m with {} shadow rays per pixel",
                                       truth.source_m, truth.shadow_rays)
                         : "",
      truth.places ? fmt::format(", and the mean over each pixel's area, of {} places", *truth.places) : ""));
}

// States how much the two families' references differ, where a point of the front has a smaller error.
void add_surfaces(const FrontierAnswer& answer, const std::string& scene,
                  std::vector<std::string>& sentences) {
  double floor = 0, least = INFINITY;
  for (const PointFigures& p : answer.points) {
    if (p.point.scene != scene) continue;
    if (p.errors.surfaces && p.errors.surfaces->displayed) floor = p.errors.surfaces->displayed->mean;
    const auto& fronts = answer.by_device ? p.device.fronts : p.fronts;
    const auto front = fronts.find("total");
    if (front != fronts.end() && front->second.on) least = std::min(least, flip_of(p.errors, "total"));
  }
  if (!(least < floor)) return;
  sentences.push_back(
      fmt::format("In {} the surfaces of OpenGL and of the rasterizer in OpenCL differ by a FLIP of {}: "
                  "smaller errors do not compare points of one kind with points of the other.",
                  scene_in_words(scene), three_digits(floor)));
}

// Points of other renderers, and who timed them.
void add_external(const FrontierAnswer& answer, const std::string& scene,
                  std::vector<std::string>& sentences) {
  for (const PointFigures& p : answer.points) {
    if (p.point.scene != scene || !p.external) continue;
    sentences.push_back(fmt::format(
        "In {} {} is another renderer{}: {}.", scene_in_words(scene), p.point.label,
        p.external->note.empty() ? "" : fmt::format(" ({})", p.external->note),
        p.external->paired ? "it states its own times, taken in the rounds next to the baseline's"
                           : "its times and the baseline's were taken elsewhere and not in these "
                             "rounds, so that its interval holds no difference between sessions"));
  }
}

// Describes a baseline that draws with OpenGL, where on this machine it is not what readers expect.
void add_baseline(const FrontierAnswer& answer, std::vector<std::string>& sentences) {
  if (answer.points.empty() || answer.machines.empty() || draws_in_opencl(answer.part.baseline)) return;
  const std::string& gl = answer.machines.front().gl_device;
  const auto is = [&](const char* name) { return gl.find(name) != std::string::npos; };
  if (const std::string driver = software_opengl(gl); !driver.empty()) {
    sentences.push_back(fmt::format(
        "OpenGL runs in software on this machine ({}): times relative to {} compare OpenCL on all of "
        "the processor's cores with it, and say nothing about a graphics card.",
        driver, answer.part.baseline));
  } else if (is("H100") || is("H200") || is("GH200")) {
    sentences.push_back(fmt::format(
        "On a Hopper GPU pixel shaders run on few of its units and kernels on all: times relative to {} "
        "show that more than they show differences between techniques.",
        answer.part.baseline));
  } else {
    return;
  }
  if (!answer.among_opencl.empty())
    sentences.back() +=
        " Techniques that draw in OpenCL are compared with each other in a table of their own.";
}

// A control that failed.
void add_failed_control(const FrontierAnswer& answer, const std::string& scene,
                        std::vector<std::string>& sentences) {
  const Clock clock = clock_of_scene(answer, scene);
  for (const Control& control : clock == Clock::device ? answer.device_controls
                                : clock == Clock::cpu  ? answer.cpu_controls
                                                       : answer.controls) {
    if (control.scene != scene || control.passed()) continue;
    sentences.push_back(fmt::format(
        "Control failed in {}: the baseline measured against itself gave {} instead of 1. Times of this run "
        "are unreliable.{}",
        scene_in_words(scene), three_digits(control.relative_time.estimate),
        control.relative_time.has_interval()
            ? fmt::format(" Intervals are wider by {:.1f} %.", 100 * (std::exp(control.widening()) - 1))
            : ""));
  }
}

// How many of the points were measured, in how many rounds.
void add_coverage(const FrontierAnswer& answer, const std::string& scene,
                  std::vector<std::string>& sentences) {
  const auto of_scene = std::ranges::find(answer.coverage, scene, &Coverage::scene);
  if (of_scene == answer.coverage.end()) return;
  int rounds = 0;
  for (const PointFigures& p : answer.points)
    if (p.point.scene == scene) rounds = std::max(rounds, p.relative_time.runs);
  sentences.push_back(
      fmt::format("In {} {} of {} points were measured, in {}{}.", scene_in_words(scene),
                  with_commas(uint64_t(of_scene->measured)), with_commas(uint64_t(of_scene->asked)),
                  rounds_in_words(rounds),
                  of_scene->measured < of_scene->asked ? ": a longer --budget measures more" : ""));
}

// How many points reached the half-width, and whether processor time decides.
void add_half_widths(const FrontierAnswer& answer, const std::string& scene,
                     std::vector<std::string>& sentences) {
  int reached = 0, timed = 0;
  for (const PointFigures& p : answer.points) {
    if (p.point.scene != scene || p.deciding_time().runs == 0) continue;
    ++timed;
    reached += p.deciding_time().half_width() <= answer.part.half_width;
  }
  const std::string wanted = fmt::format("{:g} %", 100 * answer.part.half_width);
  const bool by_cpu = clock_of_scene(answer, scene) == Clock::cpu;
  if (timed == 0 || (reached == timed && !by_cpu)) return;
  sentences.push_back(fmt::format(
      "In {} {} of {} points reached a half-width of {} of their relative time{}.", scene_in_words(scene),
      reached, timed, wanted,
      by_cpu ? ", in processor time: wall-clock time did not reach it for the baseline against itself, so "
               "that processor time decides about controls, the gate and the probabilities of the front"
             : ""));
}

// Points of two modes.
void add_modes(const FrontierAnswer& answer, const std::string& scene, std::vector<std::string>& sentences) {
  std::vector<std::string> bimodal;
  for (const PointFigures& p : answer.points) {
    if (p.point.scene == scene && !p.relative_time.modes.empty()) bimodal.push_back(p.point.label);
  }
  if (bimodal.empty()) return;
  sentences.push_back(fmt::format("In {} the times of {} fall into two groups.", scene_in_words(scene),
                                  bimodal.size() > 3 ? fmt::format("{} points", bimodal.size())
                                                     : fmt::format("{}", fmt::join(bimodal, ", "))));
}

// Names the cheapest of the points that have wrong shadows, and the one with the fewest wrong pairs.
void add_shadows(const FrontierAnswer& answer, const std::string& scene,
                 std::vector<std::string>& sentences) {
  const PointFigures *cheapest = nullptr, *best = nullptr;
  const auto wrong = [](const PointFigures& p) { return *leaked_percent(p.pairs) + *acned_percent(p.pairs); };
  for (const PointFigures& p : answer.points) {
    if (p.point.scene != scene || p.times.rounds.empty() || !leaked_percent(p.pairs)) continue;
    if (p.pairs.shadows->says_exact || wrong(p) == 0) continue;
    if (!cheapest || p.relative_time.estimate < cheapest->relative_time.estimate) cheapest = &p;
    if (!best || wrong(p) < wrong(*best)) best = &p;
  }
  if (!best) return;
  const auto words = [](const PointFigures& p) {
    return fmt::format(
        "{} ({} % of the pairs of a pixel and a light leaked, {} % acned, at {} times the "
        "baseline's time)",
        p.point.label, three_digits(*leaked_percent(p.pairs)), three_digits(*acned_percent(p.pairs)),
        three_digits(p.relative_time.estimate));
  };
  sentences.push_back(fmt::format("The cheapest point in {} with wrong shadows is {}.", scene_in_words(scene),
                                  words(*cheapest)));
  if (best != cheapest)
    sentences.push_back(fmt::format("The one with the fewest wrong pairs is {}.", words(*best)));
}

}  // namespace

std::string scene_in_words(const std::string& scene) {
  const std::string stem = std::filesystem::path(scene).stem().string();
  return stem.empty() ? scene : stem;
}

std::vector<std::string> scenes_of(const FrontierAnswer& answer) {
  return distinct(answer.part.records, [](const FrontierRecord& r) { return r.point.scene; });
}

std::string three_digits(double value) {
  if (!std::isfinite(value)) return value > 0 ? "infinite" : "unknown";
  if (value == 0) return "0";
  if (value >= 99.95) return with_commas(uint64_t(std::llround(value)));
  const std::string rounded = fmt::format("{:.2e}", value);  // 0.9999 has the exponent of 1.00
  const int decimals = std::clamp(2 - std::stoi(rounded.substr(rounded.find('e') + 1)), 0, 9);
  return fmt::format("{:.{}f}", value, decimals);
}

static std::vector<std::string> sentences_of_scene(const FrontierAnswer& answer, const std::string& scene) {
  std::vector<std::string> sentences;
  add_truth(answer, scene, sentences);
  add_external(answer, scene, sentences);
  add_modes(answer, scene, sentences);
  add_fastest(answer, scene, sentences);
  add_cheapest_within(answer, scene, sentences);
  add_surfaces(answer, scene, sentences);
  add_shadows(answer, scene, sentences);
  add_break_even(answer, scene, sentences);
  add_growth(answer, scene, sentences);
  add_failures(answer, scene, sentences);
  return sentences;
}

SceneWords words_of_scene(const FrontierAnswer& answer, const std::string& scene) {
  SceneWords words;
  add_failed_control(answer, scene, words.opening);
  add_coverage(answer, scene, words.opening);
  add_half_widths(answer, scene, words.opening);
  std::vector<std::string> fastest;
  add_fastest(answer, scene, fastest);
  if (!fastest.empty()) words.opening.push_back(fastest.front());
  if (fastest.size() > 1) words.notes.push_back(fastest.back());
  add_baseline(answer, words.opening);
  add_truth(answer, scene, words.opening);
  add_external(answer, scene, words.opening);
  add_modes(answer, scene, words.opening);
  add_surfaces(answer, scene, words.notes);
  add_shadows(answer, scene, words.notes);
  add_failures(answer, scene, words.opening);
  add_break_even(answer, scene, words.notes);
  add_growth(answer, scene, words.notes);
  return words;
}

// Describes the complete sweep, where others used the machine or it was throttled.
static std::string conditions_in_words(const FrontierAnswer& answer) {
  int rounds = 0, shared = 0, throttled = 0;
  for (const ProcessConditions& p : answer.processes) {
    rounds += p.rounds;
    shared += p.shared_rounds;
    throttled += p.throttled_rounds;
  }
  std::vector<std::string> parts;
  if (shared > 0) parts.push_back(fmt::format("shared with others in {}", shared));
  if (throttled > 0) parts.push_back(fmt::format("throttled in {}", throttled));
  if (parts.empty()) return "";
  return fmt::format("The machine was {} of {} rounds.", fmt::join(parts, " and "), rounds);
}

std::vector<std::string> sentences_of(const FrontierAnswer& answer) {
  std::vector<std::string> sentences;
  for (const std::string& scene : scenes_of(answer)) add_failed_control(answer, scene, sentences);
  for (const std::string& scene : scenes_of(answer)) {
    add_coverage(answer, scene, sentences);
    add_half_widths(answer, scene, sentences);
  }
  if (const std::string conditions = conditions_in_words(answer); !conditions.empty())
    sentences.push_back(conditions);
  add_baseline(answer, sentences);
  for (const std::string& scene : scenes_of(answer)) {
    for (std::string& sentence : sentences_of_scene(answer, scene)) sentences.push_back(std::move(sentence));
  }
  return sentences;
}

}  // namespace lightgrid::lab
