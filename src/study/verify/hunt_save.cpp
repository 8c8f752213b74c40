#include "study/verify/hunt_save.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/write_file.h"
#include "study/frame_file.h"
#include "study/verify/hunt_losses.h"

namespace lightgrid::verify {
namespace {

constexpr int most_runs = 200;  // of the culler, to shrink one loss

bool still_lost(CullEngine& engine, const CullerOptions& options, const HuntView& view, const ShrunkLoss& loss) {
  const HostGrid grid = engine.cull_depth(options, view.view, cull_lights(loss.lights), view.depth);
  return !lost_contacts(view, {&loss.contact, 1}, options.tile, grid).empty();
}

// The lost light and of the others those outside [begin, end).
ShrunkLoss without(const ShrunkLoss& loss, size_t begin, size_t end) {
  ShrunkLoss less{{}, loss.contact};
  for (size_t i = 0; i < loss.lights.size(); ++i) {
    if (i == loss.contact.light) less.contact.light = uint32_t(less.lights.size());
    if (i == loss.contact.light || i < begin || i >= end) less.lights.push_back(loss.lights[i]);
  }
  return less;
}

CapturedFrame frame_of(const HuntSetting& setting, const HuntView& h, const ShrunkLoss& loss) {
  CapturedFrame frame;
  frame.view = oracle_view(h.view);
  frame.view.near_m = near_distance(h.view);
  frame.view.far_m = distance_at(h.view, has_standard_depth(h.view) ? 1 : 0);
  frame.tile = setting.options.tile, frame.surfaces_far_m = h.far;
  frame.lights = loss.lights;
  for (size_t i = loss.contact.sample; i < h.depth.values.size(); i += size_t(h.depth.samples)) frame.depth.push_back(h.depth.values[i]);
  return frame;
}

}  // namespace

ShrunkLoss shrink_loss(CullEngine& engine, const CullerOptions& options, const HuntView& view, const HuntLights& lights,
                       const HuntContact& lost) {
  ShrunkLoss loss{lights.lights, lost};
  // Alone, then without ever smaller parts (Zeller, Hildebrandt, "Simplifying and Isolating Failure-Inducing Input", 2002).
  int runs = 0;
  for (size_t part = loss.lights.size(); part > 0 && runs < most_runs; part = part == 1 ? 0 : (part + 1) / 2) {
    for (size_t begin = 0; begin < loss.lights.size() && runs < most_runs;) {
      ShrunkLoss less = without(loss, begin, begin + part);
      const bool smaller = less.lights.size() < loss.lights.size();
      runs += smaller;
      if (smaller && still_lost(engine, options, view, less)) loss = std::move(less);
      else begin += part;
    }
  }
  return loss;
}

std::filesystem::path save_loss(const std::filesystem::path& folder, const HuntSetting& setting, const HuntView& h,
                                const ShrunkLoss& loss, uint64_t seed) {
  const std::filesystem::path path = folder / fmt::format("{}_{:016x}", name_of(h.hunted), seed);
  write_frame(path, frame_of(setting, h, loss));
  const HuntContact& c = loss.contact;
  write_file(path / "hunt.txt",
             fmt::format("class {}, seed {}\nsetting {}\nlost: light {} at pixel {},{} ({},{} in it), sample {}\n",
                         name_of(h.hunted), seed, to_string(setting), c.light, c.x, c.y, c.in_x, c.in_y, c.sample));
  return path;
}

}  // namespace lightgrid::verify
