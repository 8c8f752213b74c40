#include "frontier/answer.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/error.h"
#include "base/json_file.h"
#include "frontier/fields.h"
#include "measures/error_measures.h"

namespace lightgrid::lab {
namespace {

// A relative time of too few rounds (min_rounds).
bool has_no_interval(const JsonFields& time) {
  const nlohmann::json& interval = time.at("ci95");
  return interval.is_array() && !interval.empty() && interval[0].is_null();
}

using nlohmann::json;

struct GatePoint {
  const json* value = nullptr;
  std::string name;  // "hall, forward_plus:tile=8"
};

std::string name_of(const JsonFields& fields) {
  const int frames = fields.has("frames") ? fields.whole("frames", 1) : 1;
  const std::string averaged = frames > 1 ? fmt::format(", {} frames averaged", frames) : "";
  return fmt::format("{}, {}{}", fields.text("scene"), fields.text("label"), averaged);
}

// Calls visit(entry, fields) for each entry of an array of the frontier.
template <typename Visit>
void for_each_entry(const json& frontier, const char* name, const Visit& visit) {
  const json& array = JsonFields(frontier).at(name);
  if (!array.is_array()) throw input_error("{}: is not an array", name);
  for (size_t i = 0; i < array.size(); ++i)
    visit(array[i], JsonFields(array[i], fmt::format("{}[{}].", name, i)));
}

std::map<std::string, GatePoint> points_of(const json& frontier) {
  std::map<std::string, GatePoint> points;
  for_each_entry(frontier, "points", [&](const json& point, const JsonFields& fields) {
    const std::string name = name_of(fields);
    points[name + (fields.has("size") ? fields.at("size").dump() : "")] = {&point, name};
  });
  return points;
}

std::map<std::string, std::string> refusals_of(const json& frontier) {
  std::map<std::string, std::string> refusals;
  for_each_entry(frontier, "failures", [&](const json&, const JsonFields& fields) {
    if (fields.has("cause") && fields.text("cause") == "refused")
      refusals[name_of(fields)] = fields.text("why");
  });
  return refusals;
}

class PointComparison {
 public:
  PointComparison(const GatePoint& now, const GatePoint& earlier, GateResult& result)
      : name_(now.name),
        now_(*now.value, now.name + ": "),
        earlier_(*earlier.value, now.name + ": "),
        result_(result) {}

  // False if they are of different views, or held to different truths.
  bool is_comparable() const {
    const auto truth_of = [](const JsonFields& p) { return p.has("truth") ? p.at("truth") : json(); };
    if (truth_of(now_) != truth_of(earlier_)) {
      result_.told.push_back(name_ + ": against another truth than earlier: not compared");
      return false;
    }
    const int now = now_.whole("views", 1), earlier = earlier_.whole("views", 1);
    if (now == earlier) return true;
    result_.told.push_back(fmt::format("{}: {} views, earlier {}: not compared", name_, now, earlier));
    return false;
  }

  void compare() {
    const JsonFields now_errors = now_.object("error"), earlier_errors = earlier_.object("error");
    for (const char* kind : {"model", "precision", "technique", "total"})
      compare_errors(kind, now_errors.object(kind), earlier_errors.object(kind));
    if (now_errors.has("authored") && earlier_errors.has("authored")) {
      for (const char* kind : {"model", "total"})
        compare_errors(std::string("authored ") + kind, now_errors.object("authored").object(kind),
                       earlier_errors.object("authored").object(kind));
    }
    if (now_errors.has("sequences") && earlier_errors.has("sequences"))
      compare_sequences(now_errors.object("sequences"), earlier_errors.object("sequences"));
    if (!now_.has("external")) compare_pairs();
    const auto nan_pixels = [](const JsonFields& p) {
      return p.has("nan_pixels") ? p.count("nan_pixels") : 0;
    };
    compare_counts("pixels are NaN", nan_pixels(now_), nan_pixels(earlier_));
    for (const char* percent : {"leaked_percent", "acned_percent"}) {
      if (now_.has(percent)) compare_error(fmt::format("{}: {}", name_, percent), now_, earlier_, percent);
    }
    const auto timed_views = [](const JsonFields& p) {
      return p.whole(p.has("timed_views") ? "timed_views" : "views", 0);
    };
    if (timed_views(now_) != timed_views(earlier_)) {
      result_.told.push_back(fmt::format("{}: times of {} views, earlier of {}: not compared", name_,
                                         timed_views(now_), timed_views(earlier_)));
      return;
    }
    // Processor time, where wall-clock time was too noisy in one of the sweeps and both have it.
    const auto decides = [](const JsonFields& p) { return p.has("clock") && p.text("clock") == "cpu"; };
    const bool by_cpu = (decides(now_) || decides(earlier_)) &&
                        ratio_of(now_, "relative_cpu_time").estimate &&
                        ratio_of(earlier_, "relative_cpu_time").estimate;
    by_cpu ? compare_ratios("relative_cpu_time", " in processor time") : compare_ratios("relative_time", "");
    compare_ratios("relative_device_time", " by the devices' clocks");
  }

 private:
  void compare_pairs() {
    const JsonFields pairs = now_.object("pairs"), earlier_pairs = earlier_.object("pairs");
    compare_counts("lit pairs of a pixel and a light are lost", pairs.count("lost"),
                   earlier_pairs.count("lost"));
    compare_counts("pairs of a pixel and a light are wrong", pairs.count("wrong"),
                   earlier_pairs.count("wrong"));
  }

  void compare_errors(const std::string& kind, const JsonFields& now, const JsonFields& earlier) {
    for (const ErrorMeasure& measure : frontier_error_measures()) {
      if (measure.gated)
        compare_error(fmt::format("{}: {} {}", name_, kind, measure.key), now, earlier, measure.key);
    }
    if (earlier.has("displayed_flip")) {
      const JsonFields displayed = now.has("displayed_flip") ? now.object("displayed_flip") : now;
      compare_error(fmt::format("{}: {} displayed_flip", name_, kind), displayed,
                    earlier.object("displayed_flip"), "mean");
    }
    const std::string flip = fmt::format("{}: {} flip_mean", name_, kind);
    if (!now.has("flip_mean") && earlier.has("flip_mean")) {
      result_.told.push_back(flip + " is not measured any more");
    } else {
      compare_error(flip, now, earlier, "flip_mean");
    }
  }

  void compare_sequences(const JsonFields& now, const JsonFields& earlier) {
    for (const auto& [key, ignored] : sequences_of_errors) {
      for (const char* kind : {"plain", "filtered"}) {
        const auto flicker = [&](const JsonFields& sequences) {
          return sequences.object(key).object(kind).object("flicker");
        };
        compare_error(fmt::format("{}: flicker {} {}", name_, key, kind), flicker(now), flicker(earlier),
                      "mean");
      }
    }
  }

  void compare_error(const std::string& what, const JsonFields& now, const JsonFields& earlier,
                     const char* key) {
    const auto value = now.optional_number(key), before = earlier.optional_number(key);
    if (!before) return;  // was not finite, or not measured
    if (!value) {
      result_.worse.push_back(fmt::format("{} is not finite, earlier {:.3g}", what, *before));
    } else if (grew(*value, *before)) {
      result_.worse.push_back(fmt::format("{} grew from {:.4g} to {:.4g}", what, *before, *value));
    }
  }

  void compare_counts(const char* what, uint64_t now, uint64_t earlier) {
    if (now > earlier)
      result_.worse.push_back(fmt::format("{}: {} {}, earlier {}", name_, now, what, earlier));
  }

  struct Ratio {
    std::optional<double> estimate;
    double low = 0, high = 0;
  };

  // None in files of before times by the devices' clocks.
  static Ratio ratio_of(const JsonFields& point, const char* key) {
    if (!point.has(key)) return {};
    const JsonFields ratio = point.object(key);
    if (!ratio.has("estimate")) return {};
    if (has_no_interval(ratio)) return {};
    const std::vector<double> interval = ratio.numbers("ci95");
    if (interval.size() != 2) throw input_error("{}.ci95: {} numbers instead of 2", key, interval.size());
    return {ratio.number("estimate"), interval[0], interval[1]};
  }

  void compare_ratios(const char* key, const char* clock) {
    const Ratio now = ratio_of(now_, key), earlier = ratio_of(earlier_, key);
    if (!now.estimate || !earlier.estimate || now.low <= earlier.high) return;
    result_.worse.push_back(fmt::format(
        "{}: takes {:.3g} times the baseline's time{} ({:.3g} to {:.3g}), earlier {:.3g} ({:.3g} to {:.3g})",
        name_, *now.estimate, clock, now.low, now.high, *earlier.estimate, earlier.low, earlier.high));
  }

  std::string name_;
  JsonFields now_, earlier_;
  GateResult& result_;
};

void check_comparable(const JsonFields& now, const JsonFields& earlier) {
  if (!earlier.has("schema_version") || earlier.whole("schema_version", 1) != frontier_schema_version) {
    throw input_error("schema_version: not {}, that of this program: it has other figures",
                      frontier_schema_version);
  }
  if (now.count("seed") != earlier.count("seed")) {
    throw input_error("seed {} is not {}, that of this sweep", earlier.count("seed"), now.count("seed"));
  }
  if (earlier.has("baseline") && now.text("baseline") != earlier.text("baseline")) {
    throw input_error("baseline {} is not {}, that of this sweep", earlier.text("baseline"),
                      now.text("baseline"));
  }
}

void tell_of_other_machine(const JsonFields& now, const JsonFields& earlier, GateResult& result) {
  const auto machine_in_words = [](const JsonFields& frontier) {
    const JsonFields machine = frontier.object("machine");
    return fmt::format("{}, {}", machine.text("cpu"), machine.text("cl_device"));
  };
  const std::string here = machine_in_words(now), there = machine_in_words(earlier);
  if (here != there) result.told.push_back(fmt::format("measured on {}, earlier on {}", here, there));
}

// The baseline against itself: where it differs, other times are in doubt too.
void add_failed_controls(const json& now, GateResult& result) {
  for (const auto& [controls, clock] :
       {std::pair("controls", ""), std::pair("cpu_controls", " in processor time"),
        std::pair("device_controls", " by the devices' clocks")}) {
    for_each_entry(now, controls, [&](const json& control, const JsonFields& fields) {
      if (control.value("passed", false) || !control.value("decides", true)) return;
      const JsonFields time = fields.object("relative_time");
      std::string range = "interval not measured";
      if (!has_no_interval(time)) {
        const std::vector<double> interval = time.numbers("ci95");
        range = fmt::format("{:.4g} to {:.4g}", interval.at(0), interval.at(1));
      }
      result.worse.push_back(fmt::format("{}: the baseline as a point takes {:.4g} times its own time{} ({})",
                                         fields.text("scene"), time.number("estimate"), clock, range));
    });
  }
}

GateResult compare_frontiers(const json& now, const json& earlier) {
  GateResult result;
  const JsonFields now_fields(now), earlier_fields(earlier);
  check_comparable(now_fields, earlier_fields);
  tell_of_other_machine(now_fields, earlier_fields, result);
  add_failed_controls(now, result);
  const auto points = points_of(now), before = points_of(earlier);
  const auto refusals = refusals_of(now);
  int compared = 0;
  for (const auto& [key, point] : before) {
    const auto found = points.find(key);
    if (found == points.end()) {
      const auto refusal = refusals.find(point.name);
      if (refusal != refusals.end()) {
        result.worse.push_back(fmt::format("{}: {}", point.name, refusal->second));
        ++compared;
      } else {
        result.told.push_back(point.name + ": was measured earlier alone");
      }
      continue;
    }
    PointComparison comparison(found->second, point, result);
    if (!comparison.is_comparable()) continue;
    comparison.compare();
    ++compared;
  }
  for (const auto& [key, point] : points) {
    if (!before.contains(key)) result.told.push_back(point.name + ": was not measured earlier");
  }
  if (compared == 0) throw input_error("none of its points is in this sweep with the same size and views");
  return result;
}

}  // namespace

json read_frontier_json(const std::filesystem::path& path) {
  std::error_code ignored;
  std::ifstream file(path, std::ios::binary);
  if (!std::filesystem::is_regular_file(path, ignored) || !file)
    throw input_error("{}: no such file", path.string());
  try {
    const std::string text(std::istreambuf_iterator<char>(file), {});
    json frontier = parsed_json(text, 16);
    JsonFields(frontier).at("points");
    return frontier;
  } catch (const Error& error) {
    throw input_error("{}: {}", path.string(), error.what());
  }
}

GateResult held_against(const json& now, const json& earlier, const std::string& earlier_name) {
  try {
    return compare_frontiers(now, earlier);
  } catch (const Error& error) {
    throw input_error("{}: {}", earlier_name, error.what());
  }
}

}  // namespace lightgrid::lab
