#include "measures/relative_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "measures/ratio_of_times.h"

namespace lightgrid::lab {

static RelativeFrames relative(std::span<const double> times, std::span<const double> others, bool by_cpu) {
  std::vector<double> ratios;
  for (size_t frame = 0; frame < std::min(times.size(), others.size()); ++frame)
    ratios.push_back(std::log(times[frame] / others[frame]));
  const Location l = hodges_lehmann(ratios);
  if (ratios.empty() || !std::isfinite(l.estimate)) return {};
  return {std::exp(l.estimate), std::exp(l.low), std::exp(l.high), int(ratios.size()), by_cpu};
}

RelativeFrames relative_wall_time(const FrameTimes& times, const FrameTimes& others) {
  return relative(times.wall_ms, others.wall_ms, false);
}

RelativeFrames relative_cpu_time(const FrameTimes& times, const FrameTimes& others) {
  return relative(times.cpu_ms, others.cpu_ms, true);
}

double RelativeFrames::half_width() const {
  return has_interval() ? 0.5 * std::log(high / low) : std::numeric_limits<double>::infinity();
}

std::string RelativeFrames::in_words() const {
  const std::string interval = has_interval() ? fmt::format("95 % interval {:.3g} to {:.3g}", low, high)
                                              : fmt::format("{} frames make no interval", frames);
  return fmt::format("{:.3g} of its time ({}{})", estimate, interval, by_cpu ? "; processor time" : "");
}

RelativeFrames relative_frames(const FrameTimes& times, const FrameTimes& others) {
  const RelativeFrames wall = relative_wall_time(times, others), cpu = relative_cpu_time(times, others);
  return !wall.reached() && cpu.half_width() < wall.half_width() ? cpu : wall;
}

nlohmann::ordered_json to_json(const RelativeFrames& r) {
  if (r.frames == 0) return nullptr;
  nlohmann::ordered_json json = {{"estimate", r.estimate},
                                 {"ci95", {nullptr, nullptr}},
                                 {"frames", r.frames},
                                 {"half_width", nullptr},
                                 {"reached", r.reached()}};
  if (r.has_interval()) {
    json["ci95"] = {r.low, r.high};
    json["half_width"] = r.half_width();
  }
  return json;
}

}  // namespace lightgrid::lab
