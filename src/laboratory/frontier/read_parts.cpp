// Parts as they are read: their lines (docs/frontier_json.md#lines), and all parts of a sweep.
#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/json_file.h"
#include "frontier/fields.h"
#include "frontier/record_file.h"

namespace lightgrid::lab {
namespace {

// Parts of earlier versions have none.
std::vector<Warning> warnings_of(const nlohmann::json& finished) {
  std::vector<Warning> warnings;
  if (!finished.is_object() || !finished.contains("warnings") || !finished["warnings"].is_array())
    return warnings;
  for (const nlohmann::json& entry : finished["warnings"]) {
    const JsonFields fields(entry);
    Warning& warning = warnings.emplace_back(Warning{fields.text("text")});
    if (fields.has("command")) warning.command = fields.text("command");
    for (const nlohmann::json& setting : fields.at("settings"))
      warning.settings.push_back(setting.is_string() ? setting.get<std::string>() : "");
  }
  return warnings;
}

using nlohmann::json;
namespace fs = std::filesystem;

constexpr size_t max_line_bytes = size_t(64) << 20;  // a thousand views of a thousand runs take 40 million
constexpr int max_depth = 8;                         // depth of a line's JSON
constexpr char first_key[] = "lightgrid_frontier";

std::string first_text() { return fmt::format("{{\"{}\":1,", first_key); }

// std::getline without a limit would read any file whole.
enum class LineEnd { newline, file, too_long };

LineEnd read_line(std::istream& stream, std::string& line) {
  line.clear();
  auto& buffer = *stream.rdbuf();
  for (int c = buffer.sbumpc(); c != std::char_traits<char>::eof(); c = buffer.sbumpc()) {
    if (c == '\n') return LineEnd::newline;
    if (line.size() == max_line_bytes) return LineEnd::too_long;
    line.push_back(static_cast<char>(c));
  }
  return LineEnd::file;
}

std::vector<fs::path> part_files(const fs::path& folder) {
  std::error_code failure;
  if (!fs::is_directory(folder, failure)) throw input_error("{}: no such folder", folder.string());
  std::vector<fs::path> files;
  fs::directory_iterator entries(folder, failure);
  if (failure) throw input_error("{}: cannot be read: {}", folder.string(), failure.message());
  for (const auto& entry : entries) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("records-") && name.ends_with(".jsonl")) files.push_back(entry.path());
  }
  if (files.empty())
    throw input_error("{}: holds no part of a frontier (records-I-of-N.jsonl)", folder.string());
  std::sort(files.begin(), files.end());
  return files;
}

// Tells "WHAT of N shards: 0, 1, 2", at most ten of them.
void tell_shards(const char* what, int of, const std::vector<int>& shards, const Notice& notice) {
  constexpr size_t most = 10;
  if (shards.empty()) return;
  const size_t shown = std::min(shards.size(), most);
  notice(fmt::format("{} of {} shards: {}{}", what, of,
                     fmt::join(shards.begin(), shards.begin() + shown, ", "),
                     shards.size() > most ? fmt::format(" and {} more", shards.size() - most) : ""));
}

// How many views a part measured depends on the time that its machine had.
void tell_different_views(const std::vector<FrontierPart>& parts, const Notice& notice) {
  std::map<std::string, std::map<int, int>> views;  // by scene and shard
  for (const FrontierPart& part : parts) {
    for (const FrontierRecord& r : part.records) {
      if (!r.series.empty()) continue;
      int& count = views[r.point.scene][part.shard];
      count = std::max(count, r.view + 1);
    }
  }
  const auto fewer = [](const auto& a, const auto& b) { return a.second < b.second; };
  for (const auto& [scene, counts] : views) {
    const auto least = std::ranges::min_element(counts, fewer),
               most = std::ranges::max_element(counts, fewer);
    if (least->second == most->second) continue;
    notice(fmt::format("{}: {} views in shard {}, {} in shard {}: points of different views are compared",
                       scene, least->second, least->first, most->second, most->first));
  }
}

// A round's times, by each clock that there is.
bool is_of_times(const json& line) {
  if (!line.is_object() || !line.contains("times")) return false;
  for (const auto& [key, value] : line.items())
    if (key != "times" && key != "device_times" && key != "cpu_times") return false;
  return true;
}

// One for all views of a point, so that its runs are rounds of their own.
int unpaired_shard_of(const FrontierPoint& point) {
  const std::string hash = content_hash(point.scene + "\n" + point.label);
  return unpaired_shard + int(std::stoul(hash.substr(0, 7), nullptr, 16));
}

}  // namespace

void PartLines::add_record(FrontierRecord record, const std::string& place, const Notice& notice) {
  record.shard = part.shard;
  if (is_unpaired(record)) record.shard = unpaired_shard_of(record.point);
  if (keys.insert(record_key(record)).second) {
    part.records.push_back(std::move(record));
  } else if (notice) {
    notice(fmt::format("{}: {} of {}, view {}, is there twice; the first counts", place, record.point.label,
                       record.point.scene, record.view));
  }
}

// Before the round's times, so that a clock's times are of the record's first runs: where a run lacks them,
// those that follow do not count.
void PartLines::add_times_of_clock(const JsonFields& times, const char* name,
                                   std::span<const ClockTimes> members) {
  for (const std::string& key : times.names()) {
    FrontierRecord& record = open_record(key);
    const std::vector<double> ms = times.numbers(key);
    if (ms.size() != members.size())
      throw input_error("{}.{}: {} times instead of {}", name, key, ms.size(), members.size());
    if ((record.*members.front().second).size() != record.frame_ms.size()) continue;
    for (size_t i = 0; i < ms.size(); ++i) (record.*members[i].second).push_back(ms[i]);
  }
}

FrontierRecord& PartLines::open_record(const std::string& key) {
  const auto found = open.find(key);
  if (found == open.end()) throw input_error("{} is no record that is open", key);
  return found->second;
}

void PartLines::take(const json& line, const std::string& place, const Notice& notice) {
  if (!described) {
    if (JsonFields(line).whole(first_key, 0) != 1) throw input_error("{}: is of another version", first_key);
    part = part_of(line);
    described = true;
    return;
  }
  const auto is_of = [&](const char* key) {
    return line.is_object() && line.size() == 1 && line.contains(key);
  };
  part.finished = is_of("finished");
  if (part.finished) {
    part.warnings = warnings_of(line["finished"]);
    part.machine.load_at_end = JsonFields(line).object("finished").optional_number("load_at_end").value_or(0);
  } else if (is_of("open")) {
    FrontierRecord record = record_of(line["open"]);
    open.insert_or_assign(record_key(record), record);
  } else if (is_of("process")) {
    ++part.processes;
  } else if (is_of("conditions")) {
    part.conditions.push_back(conditions_of(line["conditions"]));
  } else if (is_of_times(line)) {
    const JsonFields all(line), times = all.object("times");
    if (all.has("device_times"))
      add_times_of_clock(all.object("device_times"), "device_times", times_by_device);
    if (all.has("cpu_times")) add_times_of_clock(all.object("cpu_times"), "cpu_times", times_by_cpu);
    for (const std::string& key : times.names()) {
      FrontierRecord& record = open_record(key);
      if (times.at(key).is_string()) {
        record.refused = times.text(key);
        continue;
      }
      const std::vector<double> ms = times.numbers(key);
      if (ms.size() != 2) throw input_error("times.{}: {} times instead of two", key, ms.size());
      record.frame_ms.push_back(ms[0]);
      record.baseline_ms.push_back(ms[1]);
      record.processes.push_back(std::max(part.processes - 1, 0));
    }
  } else if (is_of("cull_ms")) {
    const JsonFields times = JsonFields(line).object("cull_ms");
    for (const std::string& key : times.names()) open_record(key).cull_ms.push_back(times.number(key));
  } else if (is_of("complete")) {
    const json& complete = line["complete"];
    if (!complete.is_array()) throw input_error("complete: {} is not an array", complete.dump());
    for (const json& key : complete) {
      if (!key.is_string()) throw input_error("complete: {} is not a text", key.dump());
      add_record(std::move(open_record(key)), place, notice);
      open.erase(key);
    }
  } else if (line.is_array()) {
    for (const json& record : line) add_record(record_of(record), place, notice);
  } else {
    add_record(record_of(line), place, notice);
  }
}

std::string line_text(const json& line) {
  return line.dump(-1, ' ', false, json::error_handler_t::replace) + "\n";
}

std::string header_line(const FrontierPart& part) {
  return first_text() + line_text(header_json(part)).substr(1);
}

// A complete line that is not what it should be is an error: only the last line can be cut off by a process's
// end.
PartLines read_part_lines(const std::filesystem::path& path, const Notice& notice) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw input_error("{}: cannot be opened", path.string());
  PartLines lines;
  std::string line;
  for (int number = 1;; ++number) {
    const std::string place = fmt::format("{}: line {}", path.string(), number);
    const LineEnd end = read_line(stream, line);
    if (end == LineEnd::too_long) throw input_error("{}: is longer than {} MiB", place, max_line_bytes >> 20);
    if (end == LineEnd::newline) {
      try {
        lines.take(parsed_json(line, max_depth), place, notice);
      } catch (const Error& error) {
        const char* advice =
            number == 1 ? "not a part of a frontier" : "without this line it is measured again";
        throw input_error("{}: {} ({})", place, error.what(), advice);
      }
      lines.whole_bytes += line.size() + 1;
      continue;
    }
    lines.half_line = !line.empty();
    // Another file without a newline stays whole.
    if (lines.half_line && number == 1 &&
        line.compare(0, first_text().size(), first_text(), 0, line.size()) != 0) {
      throw input_error("{}: not a part of a frontier", place);
    }
    if (lines.half_line && notice) notice(fmt::format("{}: is half-written and left out", place));
    return lines;
  }
}

FrontierPart read_part(const fs::path& path, const Notice& notice) {
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) throw input_error("{}: no such file", path.string());
  PartLines lines = read_part_lines(path, notice);
  if (!lines.described) throw input_error("{}: not a part of a frontier", path.string());
  return std::move(lines.part);
}

std::vector<FrontierPart> read_parts(const std::vector<fs::path>& folders, const Notice& notice) {
  if (folders.empty()) throw input_error("no folder of parts is named");
  std::map<int, std::pair<fs::path, FrontierPart>> by_shard;
  for (const fs::path& folder : folders) {
    for (const fs::path& file : part_files(folder)) {
      FrontierPart part = read_part(file, notice);
      if (!by_shard.empty()) {
        const auto& [first_file, first] = by_shard.begin()->second;
        check_same_sweep(file.string(), part, first, first_file.string());
      }
      const int shard = part.shard;
      const auto [place, added] = by_shard.try_emplace(shard, file, std::move(part));
      if (!added) {
        throw input_error("{}: shard {} is there twice, also in {}", file.string(), shard,
                          place->second.first.string());
      }
    }
  }

  std::vector<FrontierPart> parts;
  std::vector<int> missing, unfinished;
  const int shards = by_shard.begin()->second.second.shards;
  for (int shard = 0; shard < shards; ++shard) {
    const auto found = by_shard.find(shard);
    if (found == by_shard.end()) {
      missing.push_back(shard);
      continue;
    }
    if (!found->second.second.finished) unfinished.push_back(shard);
    parts.push_back(std::move(found->second.second));
  }
  if (!notice) return parts;
  tell_shards("missing", shards, missing, notice);
  tell_shards("not finished", shards, unfinished, notice);
  tell_different_views(parts, notice);
  return parts;
}

bool in_shard(size_t index, int shard, int shards) {
  if (shards < 1 || shard < 0 || shard >= shards) {
    throw input_error("shard {}/{}: there are no such parts; of N parts the first is 0/N and the last N-1/N",
                      shard, shards);
  }
  return index % static_cast<size_t>(shards) == static_cast<size_t>(shard);
}

}  // namespace lightgrid::lab
