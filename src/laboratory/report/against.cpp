#include "report/against.h"

#include <cmath>
#include <fstream>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/json_file.h"
#include "measures/error_measures.h"

namespace lightgrid::lab {
namespace {

using nlohmann::json;

constexpr int min_runs = 5;

struct Row {
  const json *row = nullptr, *view = nullptr;
  std::string name;  // "hall 1280x720, 237 lights, visibility"
};

bool has_exact_shadows(const json& row) { return row.at("settings").value("shadows", "exact") == "exact"; }

const json* reference_of(const json& view) {
  const std::string name = view.at("reference").at("technique");
  for (const json& row : view.at("rows")) {
    if (row.at("technique") == name && !row.contains("refused") && has_exact_shadows(row)) return &row;
  }
  return nullptr;
}

// Shadows make another picture, and another time.
std::string casting_words(const json& row) {
  if (!row.contains("shadows")) return "";
  const json& shadows = row.at("shadows");
  return fmt::format(" ({} cast shadows)", shadows.at("lights").get<size_t>() + shadows.at("skipped").size());
}

// By what makes two rows the same; of equal ones in their order.
std::map<std::string, Row> rows_of(const json& results) {
  std::map<std::string, Row> rows;
  const auto add = [&](const json& view) {
    for (const json& row : view.at("rows")) {
      const std::string name = fmt::format("{} {}x{}, {} lights{}, {}", view.at("scene").get<std::string>(),
                                           view.at("size").at(0).dump(), view.at("size").at(1).dump(),
                                           row.at("lights").at("total").dump(), casting_words(row),
                                           row.at("technique").get<std::string>());
      json settings = row.at("settings");
      if (has_exact_shadows(row)) settings.erase("shadows");  // earlier results do not have this setting
      std::string key = name + settings.dump();
      while (rows.contains(key)) key += "+";
      rows[key] = {&row, &view, name};
    }
  };
  if (results.contains("views"))
    for (const json& view : results.at("views")) add(view);
  else
    add(results);
  return rows;
}

// The median's, of the frames of a row, or over those of another.
struct Interval {
  double median = 0, low = 0, high = 0;
};

Interval time_of(const json& row) {
  const json& ms = row.at("frame_ms");
  return {ms.at("median"), ms.at("min"), ms.at("max")};
}

Interval over(const Interval& a, const Interval& b) {
  return {a.median / b.median, a.low / b.high, a.high / b.low};
}

// Relative to the reference, by wall-clock or processor time; empty without an interval.
std::optional<Interval> relative_of(const json& row, const char* key) {
  if (!row.contains(key) || row.at(key).is_null() || row.at(key).at("ci95").at(0).is_null()) return {};
  const json& time = row.at(key);
  return Interval{time.at("estimate"), time.at("ci95").at(0), time.at("ci95").at(1)};
}

// Processor time decides where wall-clock time was too noisy in one of the two and both have it. Returns
// whether both have such times.
bool compare_relative_times(const Row& now, const Row& earlier, AgainstResult& result) {
  const auto decides = [](const Row& row) { return row.row->value("clock", "wall") == "cpu"; };
  const auto pair_of = [&](const char* key) {
    return std::pair(relative_of(*now.row, key), relative_of(*earlier.row, key));
  };
  auto [a, b] = pair_of("relative_time");
  const auto [cpu, cpu_before] = pair_of("relative_cpu_time");
  const bool by_cpu = (decides(now) || decides(earlier)) && cpu && cpu_before;
  if (by_cpu) std::tie(a, b) = std::tie(cpu, cpu_before);
  if (!a || !b) return false;
  if (a->low > b->high)
    result.worse.push_back(
        fmt::format("{}: {:.3g} times the reference's time{} ({:.3g} to {:.3g}), earlier {:.3g} ({:.3g} to "
                    "{:.3g}): slower",
                    now.name, a->median, by_cpu ? " in processor time" : "", a->low, a->high, b->median,
                    b->low, b->high));
  return true;
}

void compare_times(const Row& now, const Row& earlier, AgainstResult& result) {
  if (compare_relative_times(now, earlier, result)) return;
  const int runs = now.row->at("frame_ms").at("runs"), before = earlier.row->at("frame_ms").at("runs");
  if (std::min(runs, before) < min_runs) {
    result.told.push_back(
        fmt::format("{}: times are not compared: {} and {} frames make no interval (--frames {})", now.name,
                    runs, before, min_runs));
    return;
  }
  const Interval a = time_of(*now.row), b = time_of(*earlier.row);
  if (a.low <= b.high) return;
  const json *reference = reference_of(*now.view), *reference_before = reference_of(*earlier.view);
  if (reference && reference_before && reference != now.row) {
    if (over(a, time_of(*reference)).low <= over(b, time_of(*reference_before)).high) return;
  }
  const double sure = 100 * (1 - std::pow(2.0, 1 - std::min(runs, before)));
  result.worse.push_back(
      fmt::format("{}: {:.3g} ms ({:.3g} to {:.3g}), earlier {:.3g} ({:.3g} to {:.3g}): slower; {:.0f} % "
                  "intervals of the median",
                  now.name, a.median, a.low, a.high, b.median, b.low, b.high, sure));
}

void compare_errors(const Row& now, const Row& earlier, AgainstResult& result) {
  const json &errors = now.row->at("error"), &before = earlier.row->at("error");
  if (errors.is_null() || before.is_null()) return;
  const auto compare = [&](const json& error, const json& of, const char* key, const std::string& name) {
    if (error.is_null() || of.is_null() || !of.contains(key) || of.at(key).is_null()) return;
    if (!error.contains(key) || error.at(key).is_null()) {
      result.told.push_back(fmt::format("{}: {} is not measured, or not finite any more", now.name, name));
    } else if (grew(error.at(key), of.at(key))) {
      result.worse.push_back(fmt::format("{}: {} grew from {:.4g} to {:.4g}", now.name, name,
                                         of.at(key).get<double>(), error.at(key).get<double>()));
    }
  };
  const json &from_oracle = errors.at("oracle"), &from_oracle_before = before.at("oracle");
  for (const ErrorMeasure& measure : error_measures()) {
    compare(errors, before, measure.key, measure.key);
    compare(from_oracle, from_oracle_before, measure.key, std::string("oracle's ") + measure.key);
  }
  compare(errors, before, "flip_mean", "flip_mean");
}

void compare_counts(const Row& now, const Row& earlier, AgainstResult& result) {
  const auto compare = [&](const char* what, const json& a, const json& b, const char* key) {
    const auto count = [&](const json& of) { return of.is_null() ? 0 : of.at(key).get<uint64_t>(); };
    if (count(a) > count(b))
      result.worse.push_back(fmt::format("{}: {} {}, earlier {}", now.name, count(a), what, count(b)));
  };
  compare("pairs of a pixel and a light are lost", now.row->at("pairs"), earlier.row->at("pairs"), "lost");
  compare("pairs of a pixel and a light are wrong", now.row->at("pairs"), earlier.row->at("pairs"), "wrong");
  compare("pixels are NaN", *now.row, *earlier.row, "nan_pixels");
  if (!now.row->at("pairs").contains("leaked") || !earlier.row->at("pairs").contains("leaked")) return;
  compare("pairs are shaded though hidden", now.row->at("pairs"), earlier.row->at("pairs"), "leaked");
  compare("pairs are dark though seen", now.row->at("pairs"), earlier.row->at("pairs"), "acned");
}

AgainstResult compare_results(const json& now, const json& earlier) {
  AgainstResult result;
  const auto rows = rows_of(now), before = rows_of(earlier);
  int compared = 0;
  bool other_devices = false;
  for (const auto& [key, row] : before) {
    const auto found = rows.find(key);
    if (found == rows.end()) {
      result.told.push_back(row.name + ": was measured earlier alone");
      continue;
    }
    if (row.row->contains("refused")) continue;
    ++compared;
    if (found->second.row->contains("refused")) {
      result.worse.push_back(fmt::format("{}: is refused now: {}", row.name,
                                         found->second.row->at("refused").get<std::string>()));
      continue;
    }
    compare_errors(found->second, row, result);
    compare_counts(found->second, row, result);
    const json &devices = found->second.view->at("devices"), &devices_before = row.view->at("devices");
    if (devices == devices_before) {
      compare_times(found->second, row, result);
    } else if (!std::exchange(other_devices, true)) {
      result.told.push_back(fmt::format("times are not compared: measured on {}, earlier on {}",
                                        devices.dump(), devices_before.dump()));
    }
  }
  for (const auto& [key, row] : rows) {
    if (!before.contains(key)) result.told.push_back(row.name + ": was not measured earlier");
  }
  if (compared == 0)
    throw input_error("none of its rows is measured here with the same scene, size, lights and settings");
  return result;
}

}  // namespace

json read_results_json(const std::filesystem::path& path) {
  std::error_code ignored;
  std::ifstream file(path, std::ios::binary);
  if (!std::filesystem::is_regular_file(path, ignored) || !file)
    throw input_error("{}: no such file", path.string());
  try {
    json results = json::parse(file);
    if (rows_of(results).empty()) throw input_error("{}: has no rows", path.string());
    return results;
  } catch (const json::exception& fault) {
    throw input_error("{}: is no results.json of compare: {}", path.string(), fault_of(fault));
  }
}

AgainstResult results_against(const json& now, const json& earlier, const std::string& earlier_name) {
  try {
    return compare_results(now, earlier);
  } catch (const json::exception& fault) {
    throw input_error("{}: is no results.json of compare: {}", earlier_name, fault_of(fault));
  } catch (const Error& error) {
    throw input_error("{}: {}", earlier_name, error.what());
  }
}

}  // namespace lightgrid::lab
