#include "verify/run.h"

#include <algorithm>
#include <map>
#include <sstream>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "base/embedded.h"
#include "base/error.h"
#include "base/timer.h"
#include "cl/build_error.h"
#include "cl/error.h"
#include "frames/frame_culler.h"
#include "frames/frame_lists.h"
#include "oracle/lit_set.h"
#include "plan/settings/grid.h"
#include "shared/cull_tests.h"
#include "verify/chosen_by_name.h"

namespace lightgrid::lab::verify {
namespace {

const char* name_of(Verdict verdict) {
  return verdict == Verdict::pass ? "pass" : verdict == Verdict::fail ? "fail" : "skip";
}

std::string full_name(const HardCase& hard_case) {
  return fmt::format("{}/{}", hard_case.group, hard_case.name);
}

// A row of a table in Markdown, without the spaces around its fields.
std::vector<std::string> fields_of_row(const std::string& row) {
  std::vector<std::string> fields;
  for (size_t begin = 2, end; (end = row.find(" |", begin)) != std::string::npos; begin = end + 3)
    fields.push_back(row.substr(begin, end - begin));
  return fields;
}

using Run = void (*)(Check&);

std::map<std::string, std::function<void(Check&)>> runs_by_name() {
  std::map<std::string, std::function<void(Check&)>> runs;
  for (const auto& group : {depth_cases(), depth_bounds_cases(), camera_cases(), light_cases(), list_cases(),
                            agreement_cases(), raster_cases(), shadow_cases(), light_index_cases(),
                            group_cases(), sample_cases(), cap_cases(), effect_cases()}) {
    for (const CaseRun& c : group) {
      if (!runs.emplace(c.name, c.run).second)
        throw std::logic_error("two hard cases have the function name " + c.name);
    }
  }
  return runs;
}

}  // namespace

std::vector<CaseRun> named_cases(std::string_view names, std::initializer_list<Run> runs) {
  std::vector<CaseRun> cases;
  std::istringstream words{std::string(names)};
  std::string name;
  for (const Run run : runs) {
    std::getline(words >> std::ws, name, ',');
    cases.push_back({name, run});
  }
  return cases;
}

const std::vector<HardCase>& hard_cases() {
  static const std::vector<HardCase> all = [] {
    const auto runs = runs_by_name();
    std::vector<HardCase> cases;
    std::istringstream catalogue(embedded_file("verify/catalogue.md"));
    for (std::string line; std::getline(catalogue, line);) {
      const std::vector<std::string> fields = fields_of_row(line);
      if (fields.size() != 5 || !fields[1].starts_with('`')) continue;
      const size_t slash = fields[1].find('/');
      const std::string name = fields[1].substr(slash + 1, fields[1].size() - slash - 2);
      cases.push_back({fields[1].substr(1, slash - 1), name, fields[2], fields[3], fields[4], runs.at(name)});
    }
    return cases;
  }();
  return all;
}

std::vector<const HardCase*> chosen_cases(const std::string& filter) {
  std::vector<const HardCase*> all;
  for (const HardCase& hard_case : hard_cases()) all.push_back(&hard_case);
  return chosen_by_name(
      all, filter, [](const HardCase* c) { return full_name(*c); }, "case's name", "depth/all_sky");
}

namespace {

Outcome outcome_of(const std::function<void(Check&)>& run, Check check) {
  try {
    try {
      run(check);
    } catch (const KernelBuildError& error) {
      check.skip(error.what());
      Outcome outcome = check.outcome();
      outcome.unbuilt = outcome.verdict == Verdict::skip;
      return outcome;
    } catch (const Error& error) {
      check.fail(error.what());
    } catch (const cl::Error& error) {
      check.fail(cl_machine_error(error).what());
    }
  } catch (const Check::Ended&) {
  }
  return check.outcome();
}

}  // namespace

Outcome outcome_of(const std::function<void(Check&)>& run, CullEngine& engine, uint64_t adversarial_lights) {
  return outcome_of(run, Check(engine, adversarial_lights));
}

bool fails(const HardCase& hard_case, CullEngine& engine, uint64_t adversarial_lights) {
  return outcome_of(hard_case.run, Check(engine, adversarial_lights, true)).verdict == Verdict::fail;
}

Outcome run_case(const HardCase& hard_case, CullEngine& engine, uint64_t adversarial_lights) {
  return outcome_of(hard_case.run, engine, adversarial_lights);
}

// Counts a case that has ended.
static void add_case(VerifyReport& report, CaseResult result, const CaseFunction& found) {
  report.failed += result.outcome.verdict == Verdict::fail;
  report.unbuilt += result.outcome.unbuilt;
  report.cases.push_back(std::move(result));
  if (found) found(report.cases.back());
}

VerifyReport run_cases(const std::vector<std::unique_ptr<CullEngine>>& engines,
                       const VerifyOptions& options) {
  const std::vector<const HardCase*> chosen = chosen_cases(options.filter);
  VerifyReport report;
  const double all = double(engines.size() * chosen.size());
  for (const auto& engine : engines) {
    report.devices.push_back(engine->name());
    for (const HardCase* hard_case : chosen) {
      if (options.progress) options.progress(double(report.cases.size()) / all, full_name(*hard_case));
      const Timer timer;
      const Outcome outcome = run_case(*hard_case, *engine, options.adversarial_lights);
      add_case(report, {hard_case, engine->name(), outcome, timer.elapsed_ms()}, options.found);
    }
  }
  if (options.progress) options.progress(1, "done");
  return report;
}

nlohmann::ordered_json to_json(const VerifyReport& report) {
  nlohmann::ordered_json json = {{"devices", report.devices},
                                 {"cases", nlohmann::ordered_json::array()},
                                 {"failed", report.failed},
                                 {"unbuilt", report.unbuilt}};
  for (const CaseResult& result : report.cases) {
    const Outcome& o = result.outcome;
    nlohmann::ordered_json row = {{"group", result.hard_case->group},
                                  {"name", result.hard_case->name},
                                  {"device", result.device},
                                  {"trials", o.trials},
                                  {"contacts", o.contacts},
                                  {"lost", o.lost},
                                  {"excess_ratio", nullptr},
                                  {"result", name_of(o.verdict)},
                                  {"why", o.why}};
    if (o.excess_ratio) row["excess_ratio"] = *o.excess_ratio;
    json["cases"].push_back(row);
  }
  return json;
}

std::vector<std::string> catalogue_rows(const std::vector<const HardCase*>& cases) {
  std::vector<std::string> rows;
  for (const HardCase* c : cases)
    rows.push_back(fmt::format("| {} | `{}` | {} | {} | {} |", c - hard_cases().data() + 1, full_name(*c),
                               c->input, c->breaks, c->invariant));
  return rows;
}

namespace {

const HardCase replayed{"replay", "float_twin", "a captured frame, under every test and every kind of bounds",
                        "",       "",           nullptr};

const HardCase own_lists{"replay", "own_lists", "the lists that came with a captured frame", "", "", nullptr};

std::vector<CullerOptions> chosen_settings(int tile, bool every_combination) {
  const CullerOptions usual;
  std::vector<CullerOptions> settings;
  for (const CullTestRow& test : cull_tests) {
    for (const DepthBoundsRow& bounds : depth_bounds_modes) {
      if (!every_combination && test.test != usual.cull_test && bounds.mode != usual.depth_bounds) continue;
      settings.push_back({.cull_test = test.test, .depth_bounds = bounds.mode, .tile = tile});
    }
  }
  return settings;
}

struct Replay {
  const CapturedFrame& frame;
  const std::vector<CullLight> lights;
  const std::vector<ViewLight> true_lights;  // lights of the oracle
  const std::vector<float> covered;          // the depth image for the oracle
  const DepthImage depth;
};

// Counts the pairs that are lit but not listed.
LitPairs pairs_of(const Replay& r, const FrameGrid& grid) {
  return count_pairs(r.frame.view, r.covered, r.true_lights, listed_lights(r.frame, grid));
}

std::string first_lost(const LitPairs& pairs, int width) {
  const auto at =
      std::find_if(pairs.lost_of_pixel.begin(), pairs.lost_of_pixel.end(), [](uint32_t n) { return n > 0; });
  const int pixel = int(at - pairs.lost_of_pixel.begin());
  return fmt::format("{} of {} lit (pixel, light) pairs lost, the first at pixel {},{}", pairs.lost,
                     pairs.lit, pixel % width, pixel / width);
}

CaseResult compare_own_lists(const Replay& r, const FrameGrid& own) {
  const Timer timer;
  const LitPairs pairs = pairs_of(r, own);
  Outcome outcome{.trials = pairs.lit, .contacts = pairs.lit, .lost = pairs.lost};
  if (pairs.lost > 0) {
    outcome.verdict = Verdict::fail;
    outcome.why = "the frame's own lists: " + first_lost(pairs, r.frame.view.width);
  }
  return {&own_lists, "", outcome, timer.elapsed_ms()};
}

void count_lost(Check& c, const Replay& r, const CullView& view, const CullerOptions& options) {
  FrameGrid grid;
  grid.tile = options.tile;
  grid.slice_edges = view.slice_edges;
  grid.z_bin_edges = view.z_bin_edges;
  grid.lists = c.engine.cull_depth(options, view, r.lights, r.depth);
  const std::string wrong = malformed(grid.lists, r.lights.size());
  if (!c.that(wrong.empty(), "{}: {}", to_string(options), wrong)) return;
  const LitPairs pairs = pairs_of(r, grid);
  c.trials(pairs.lit);
  if (pairs.lost == 0) return;
  c.lost_pairs(pairs.lost, "{}, {} slices, {} z-bins: {}", to_string(options), view.slice_edges.size() + 1,
               view.z_bin_edges.size() + 1, first_lost(pairs, r.frame.view.width));
}

}  // namespace

VerifyReport replay_frame(const std::vector<std::unique_ptr<CullEngine>>& engines, const CapturedFrame& frame,
                          const ReplayOptions& options) {
  const Replay replay{
      frame, cull_lights_of(frame), local_lights(frame), covered_depth(frame), {.values = frame.depth}};
  std::vector<CullView> views = {cull_view(frame.view)};
  views.insert(views.end(), options.more_views.begin(), options.more_views.end());
  const std::vector<CullerOptions> settings = chosen_settings(frame.tile, options.every_combination);
  const double steps = double(engines.size() * views.size() * settings.size());
  double done = 0;
  VerifyReport report;
  if (options.own) add_case(report, compare_own_lists(replay, *options.own), options.found);
  for (const auto& engine : engines) {
    report.devices.push_back(engine->name());
    const Timer timer;
    const Outcome outcome = outcome_of(
        [&](Check& c) {
          for (const CullView& view : views) {
            for (const CullerOptions& setting : settings) {
              if (options.progress) options.progress(done++ / steps, to_string(setting));
              c.same_as_twin(view, replay.lights, replay.depth, setting);
              count_lost(c, replay, view, setting);
            }
          }
        },
        *engine, 0);
    add_case(report, {&replayed, engine->name(), outcome, timer.elapsed_ms()}, options.found);
  }
  if (options.progress) options.progress(1, "done");
  return report;
}

std::vector<CullView> replayed_views(const CapturedFrame& frame, const std::optional<FrameGrid>& own,
                                     const std::vector<std::string>& set) {
  std::vector<CullView> views;
  if (own && !(own->slice_edges.empty() && own->z_bin_edges.empty())) {
    views.push_back(cull_view(frame.view));
    views.back().slice_edges = own->slice_edges;
    views.back().z_bin_edges = own->z_bin_edges;
  }
  Settings settings = frame_settings(frame, set);
  for (const std::string& key : given_keys(settings)) {
    if (key != "slices" && key != "z-bins" && key != "slice-spacing")
      throw input_error(
          "verify: --replay already runs every value of the other settings; --set {} is not one of slices, "
          "z-bins and slice-spacing",
          key);
  }
  const TechniqueNeeds needs{
      .lists = {.slices = settings.given(setting::slices), .z_bins = settings.given(setting::z_bins)}};
  if (needs.lists.slices || needs.lists.z_bins)
    views.push_back(cull_view_of(frame, grid_settings(settings, needs)));
  return views;
}

}  // namespace lightgrid::lab::verify
