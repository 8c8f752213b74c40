#include "verify/hunt_save.h"

#include <fmt/format.h>

#include <optional>

#include "base/write_file.h"
#include "capture/frame_file.h"
#include "culling/view_depth.h"
#include "plan/settings.h"

namespace lightgrid::verify {
namespace {

constexpr int most_runs = 200;  // of the culler, to shrink one loss

// With the grid of these lights; empty if the contact is found.
std::optional<ShrunkLoss> still_lost(CullEngine& engine, const CullerOptions& options, const HuntView& view,
                                     ShrunkLoss less) {
  less.grid = engine.cull_depth(options, view.view, cull_lights(less.lights), view.depth, view.blended);
  const auto lost = lost_contacts(view, {&less.lost.contact, 1}, options.tile, less.grid);
  if (lost.empty()) return {};
  less.lost = lost[0];
  return less;
}

// The lost light, and the others outside [begin, end).
ShrunkLoss without(const ShrunkLoss& loss, size_t begin, size_t end) {
  ShrunkLoss less{{}, loss.lost, {}};
  for (size_t i = 0; i < loss.lights.size(); ++i) {
    const bool own = i == loss.lost.contact.light;
    if (own) less.lost.contact.light = uint32_t(less.lights.size());
    if (own || i < begin || i >= end) less.lights.push_back(loss.lights[i]);
  }
  return less;
}

CapturedFrame frame_of(const HuntSetting& setting, const HuntView& h, const ShrunkLoss& loss) {
  CapturedFrame frame;
  frame.view = oracle_view(h.view);
  const bool oblique = is_oblique(h.view);
  frame.view.near_m = oblique ? h.near : near_distance(h.view);
  frame.view.far_m = oblique ? no_end : distance_at(h.view, has_standard_depth(h.view) ? 1 : 0);
  frame.tile = setting.options.tile, frame.surfaces_far_m = h.far;
  frame.lights = loss.lights;
  for (size_t i = loss.lost.contact.sample; i < h.depth.values.size(); i += size_t(h.depth.samples)) {
    frame.depth.push_back(h.depth.values[i]);
  }
  return frame;
}

FrameGrid grid_of(const HuntSetting& setting, const HuntView& h, const ShrunkLoss& loss) {
  const CullerOptions& o = setting.options;
  Settings s;
  s.cull_test = o.cull_test, s.depth_bounds = o.depth_bounds, s.tile = o.tile, s.grid_lists = o.lists;
  s.slices = setting.slices, s.slice_spacing = setting.spacing, s.z_bins = setting.z_bins;
  s.kernel_shape = o.shape, s.portable = o.portable;
  return {loss.grid, o.tile, h.view.slice_edges, h.view.z_bin_edges, to_strings(s)};
}

// What a replay of the frame does not see.
std::string words_of_absent(const HuntView& h) {
  std::string words;
  if (h.blended) words += "the frame lacks the blended surface that the depth is of\n";
  if (is_oblique(h.view)) words += "the frame has an oblique near plane and is refused when read\n";
  return words;
}

}  // namespace

ShrunkLoss shrink_loss(CullEngine& engine, const CullerOptions& options, const HuntView& view,
                       const std::vector<Light>& lights, const HuntLoss& lost) {
  ShrunkLoss loss{lights, lost, {}};
  // First alone, then without ever smaller parts (Zeller, Hildebrandt, "Simplifying and Isolating
  // Failure-Inducing Input", 2002).
  int runs = 0;
  for (size_t part = loss.lights.size(); part > 0 && runs < most_runs;
       part = part == 1 ? 0 : (part + 1) / 2) {
    for (size_t begin = 0; begin < loss.lights.size() && runs < most_runs;) {
      ShrunkLoss less = without(loss, begin, begin + part);
      const bool smaller = less.lights.size() < loss.lights.size();
      runs += smaller;
      const auto shrunk = smaller ? still_lost(engine, options, view, std::move(less)) : std::nullopt;
      if (shrunk)
        loss = *shrunk;
      else
        begin += part;
    }
  }
  if (const auto again = still_lost(engine, options, view, loss)) return *again;
  return loss;
}

std::filesystem::path save_loss(const std::filesystem::path& folder, const HuntSetting& setting,
                                const HuntView& h, const ShrunkLoss& loss, uint64_t seed) {
  const std::filesystem::path path = folder / fmt::format("{}_{:016x}", name_of(h.hunted), seed);
  write_frame(path, frame_of(setting, h, loss));
  write_frame_grid(path, grid_of(setting, h, loss));
  const HuntContact& c = loss.lost.contact;
  write_file(path / "hunt.txt",
             fmt::format("class {}, seed {}\nsetting {}\nlost from its {}: light {} at pixel {},{} ({},{} in "
                         "it), sample {}, depth {:.9g}\n{}",
                         name_of(h.hunted), seed, to_string(setting), name_of(loss.lost.from), c.light, c.x,
                         c.y, c.in_x, c.in_y, c.sample, c.depth, words_of_absent(h)));
  return path;
}

}  // namespace lightgrid::verify
