#include "verify/replay.h"

#include <algorithm>

#include "base/error.h"
#include "base/timer.h"
#include "renderer/render_view.h"
#include "reference/lit_set.h"
#include "capture/frame_culler.h"
#include "capture/frame_lists.h"
#include "shared/cull_settings.h"
#include "verify/check.h"

namespace lightgrid::verify {
namespace {

const HardCase replayed{"replay", "float_twin", "a captured frame, under every test and every kind of bounds",
                        "",       "",           nullptr};

std::vector<CullerOptions> chosen_settings(int tile, bool every_combination) {
  const CullerOptions usual;
  std::vector<CullerOptions> settings;
  for (const CullTestRow& test : cull_tests) {
    for (const DepthBoundsRow& bounds : depth_bounds_modes) {
      if (!every_combination && test.test != usual.cull_test && bounds.mode != usual.depth_bounds) continue;
      CullerOptions options;
      options.tile = tile;
      options.cull_test = test.test;
      options.depth_bounds = bounds.mode;
      settings.push_back(options);
    }
  }
  return settings;
}

struct Replay {
  const CapturedFrame& frame;
  const std::vector<CullLight> lights;
  const std::vector<ViewLight> true_lights;  // of the oracle
  const std::vector<float> covered;          // the depth image for the oracle
  const DepthImage depth;
};

// Counts the pairs that are lit but not listed.
void count_lost(Check& c, const Replay& r, const CullView& view, const CullerOptions& options) {
  FrameGrid grid;
  grid.tile = options.tile;
  grid.slice_edges = view.slice_edges;
  grid.z_bin_edges = view.z_bin_edges;
  grid.lists = c.engine.cull_depth(options, view, r.lights, r.depth);
  const std::string wrong = malformed(grid.lists, r.lights.size());
  if (!c.that(wrong.empty(), "{}: {}", to_string(options), wrong)) return;
  const LitPairs pairs = count_pairs(r.frame.view, r.covered, r.true_lights, listed_lights(r.frame, grid));
  c.trials(pairs.lit);
  if (pairs.lost == 0) return;
  const auto at =
      std::find_if(pairs.lost_of_pixel.begin(), pairs.lost_of_pixel.end(), [](uint32_t n) { return n > 0; });
  const int pixel = int(at - pairs.lost_of_pixel.begin()), width = r.frame.view.width;
  c.lost_pairs(pairs.lost,
               "{}, {} slices, {} z-bins: {} of {} lit (pixel, light) pairs lost, the first at pixel {},{}",
               to_string(options), view.slice_edges.size() + 1, view.z_bin_edges.size() + 1, pairs.lost,
               pairs.lit, pixel % width, pixel / width);
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
  for (const auto& engine : engines) {
    report.devices.push_back(engine->name());
    const Timer timer;
    const Outcome outcome = outcome_of([&](Check& c) {
      for (const CullView& view : views) {
        for (const CullerOptions& setting : settings) {
          if (options.progress) options.progress(done++ / steps, to_string(setting));
          c.same_as_twin(view, replay.lights, replay.depth, setting);
          count_lost(c, replay, view, setting);
        }
      }
    }, *engine, 0);
    report.cases.push_back({&replayed, engine->name(), outcome, timer.elapsed_ms()});
    report.failed += outcome.verdict == Verdict::fail;
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
  for (const std::string& key : settings.given) {
    if (key != "slices" && key != "z-bins" && key != "slice-spacing")
      throw input_error(
          "verify: --replay already runs every value of the other settings; --set {} is not one of slices, "
          "z-bins and slice-spacing",
          key);
  }
  const TechniqueNeeds needs{.slices = settings.given.contains("slices"),
                             .z_bins = settings.given.contains("z-bins")};
  if (needs.slices || needs.z_bins) views.push_back(cull_view_of(frame, grid_settings(settings, needs)));
  return views;
}

}  // namespace lightgrid::verify
