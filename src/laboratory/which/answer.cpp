// The answer as text and as JSON (docs/which.md).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/version.h"
#include "frontier/record_file.h"
#include "measures/words.h"
#include "which/which.h"

namespace lightgrid::lab {
namespace {

using nlohmann::ordered_json;

double flip_of(const WhichPoint& p) { return p.flip.value_or(p.reduced_flip.value_or(unknown_error)); }

std::string interval_in_words(const Estimate& e) {
  return fmt::format("{} to {}", short_number(e.low), short_number(e.high));
}

std::string runner_up_in_words(const WhichPoint& next) {
  const Estimate& time = *next.relative_time;
  const std::string interval =
      time.low < time.high ? fmt::format(" ({:.3f} to {:.3f})", time.low, time.high) : "";
  return fmt::format("next: {}, {:.3f}x its time{}", next.point.label, time.value, interval);
}

ordered_json to_json(const Estimate& e) { return {{"estimate", e.value}, {"ci95", {e.low, e.high}}}; }

template <typename T>
ordered_json optional_json(const std::optional<T>& value) {
  if (!value) return nullptr;
  if constexpr (std::is_same_v<T, double>) {
    return std::isfinite(*value) ? ordered_json(*value) : ordered_json();
  } else {
    return to_json(*value);
  }
}

ordered_json to_json(const WhichPoint& p) {
  ordered_json json = {{"label", p.point.label},
                       {"technique", p.point.technique},
                       {"settings", p.point.settings},
                       {"frames", p.point.frames},
                       {"fate", name_of(p.fate)},
                       {"flip_reduced", optional_json(p.reduced_flip)},
                       {"flip", optional_json(p.flip)},
                       {"ms", optional_json(p.ms)},
                       {"relative_time", optional_json(p.relative_time)},
                       {"rounds", p.rounds}};
  if (!p.refused.empty()) json["refused"] = p.refused;
  return json;
}

ordered_json label_json(const WhichAnswer& answer, const std::optional<size_t>& point) {
  return point ? ordered_json(answer.points[*point].point.label) : ordered_json();
}

}  // namespace

const char* name_of(Fate fate) {
  constexpr const char* names[] = {"not started", "refused", "inaccurate", "slow", "competes"};
  return names[size_t(fate)];
}

std::string in_words(const WhichAnswer& answer) {
  const auto is_started = [](const WhichPoint& p) { return p.fate != Fate::not_started; };
  const auto started = std::ranges::count_if(answer.points, is_started), all = std::ssize(answer.points);
  const std::string among = started == all ? fmt::format("{} points", all)
                                           : fmt::format("the {} of {} points that started", started, all);
  if (!answer.choice) {
    std::string text = fmt::format("none of {} has a FLIP of at most {:g}", among, answer.max_flip);
    if (answer.closest) {
      const WhichPoint& p = answer.points[*answer.closest];
      text += fmt::format("; closest: {}, FLIP {}", p.point.label, error_in_words(flip_of(p)));
    }
    return text;
  }
  const WhichPoint& p = answer.points[*answer.choice];
  std::string text =
      fmt::format("{}: {} ms per frame ({}), FLIP {}{}", p.point.label, short_number(p.ms->value),
                  interval_in_words(*p.ms), error_in_words(flip_of(p)),
                  p.flip ? "" : fmt::format(" at {}x{}", answer.reduced.width, answer.reduced.height));
  if (answer.runner_up) text += "; " + runner_up_in_words(answer.points[*answer.runner_up]);
  return text + fmt::format("; fastest of {} with {:.0f} % confidence", among, 100 * answer.confidence);
}

ordered_json to_json(const WhichAnswer& answer) {
  ordered_json json = {{"schema", 1},
                       {"commit", commit_of_build()},
                       {"scene", answer.scene},
                       {"lights", answer.lights},
                       {"size", {answer.size.width, answer.size.height}},
                       {"reduced_size", {answer.reduced.width, answer.reduced.height}},
                       {"max_flip", answer.max_flip},
                       {"seconds", answer.seconds},
                       {"rounds", answer.rounds},
                       {"clock", answer.clock},
                       {"machine", lab::to_json(answer.machine)},
                       {"choice", label_json(answer, answer.choice)},
                       {"runner_up", label_json(answer, answer.runner_up)},
                       {"closest", label_json(answer, answer.closest)},
                       {"confidence", answer.confidence},
                       {"points", ordered_json::array()}};
  for (const WhichPoint& p : answer.points) json["points"].push_back(to_json(p));
  return json;
}

}  // namespace lightgrid::lab
