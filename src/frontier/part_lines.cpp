// The lines of a part: docs/frontier_json.md#lines.
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "frontier/json_fields.h"
#include "frontier/record_file.h"

namespace lightgrid {
namespace {

using nlohmann::json;

constexpr size_t max_line_bytes = size_t(64) << 20;  // a thousand views of a thousand runs take 40 million
constexpr int max_depth = 8;
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

json parsed(const std::string& line) {
  const auto shallow = [](int depth, json::parse_event_t, json&) {
    if (depth > max_depth) throw input_error("is nested deeper than {}", max_depth);
    return true;
  };
  try {
    return json::parse(line, shallow);
  } catch (const json::exception&) {
    throw input_error("is not JSON");
  }
}

}  // namespace

void PartLines::add_record(FrontierRecord record, const std::string& place, const Notice& notice) {
  record.shard = part.shard;
  if (keys.insert(record_key(record)).second) {
    part.records.push_back(std::move(record));
  } else if (notice) {
    notice(fmt::format("{}: {} of {}, view {}, is there twice; the first counts", place, record.point.label,
                       record.point.scene, record.view));
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
    part.machine.load_at_end = JsonFields(line).object("finished").optional_number("load_at_end").value_or(0);
  } else if (is_of("open")) {
    FrontierRecord record = record_of(line["open"]);
    open.insert_or_assign(record_key(record), record);
  } else if (is_of("times")) {
    const JsonFields times = JsonFields(line).object("times");
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
        lines.take(parsed(line), place, notice);
      } catch (const Error& error) {
        const char* advice =
            number == 1 ? "not a part of a frontier" : "without this line it is measured again";
        throw input_error("{}: {} ({})", place, error.what(), advice);
      }
      lines.whole_bytes += line.size() + 1;
      continue;
    }
    lines.half_line = !line.empty();
    // Of another file that has no newline nothing may be cut off.
    if (lines.half_line && number == 1 &&
        line.compare(0, first_text().size(), first_text(), 0, line.size()) != 0) {
      throw input_error("{}: not a part of a frontier", place);
    }
    if (lines.half_line && notice) notice(fmt::format("{}: is half-written and left out", place));
    return lines;
  }
}

}  // namespace lightgrid
