#include "frontier/part_text.h"

#include <fstream>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "frontier/json_fields.h"

namespace lightgrid {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr size_t max_line_bytes = size_t(64) << 20;  // a thousand views of a thousand runs take 40 million
constexpr int max_depth = 8;
constexpr char first_key[] = "lightgrid_frontier";

std::string first_text() { return fmt::format("{{\"{}\":1,", first_key); }

FrontierPart header_of(const json& line) {
  const JsonFields fields(line);
  if (fields.whole(first_key, 0) != 1) throw input_error("{}: is of another version", first_key);
  FrontierPart part;
  part.request = fields.text("request");
  part.commit = fields.text("commit");
  part.seed = fields.count("seed");
  part.shards = fields.whole("shards", 1);
  part.shard = fields.whole("shard", 0);
  if (part.shard >= part.shards)
    throw input_error("shard: {} is not below shards, {}", part.shard, part.shards);
  part.baseline = fields.text("baseline");
  part.machine = machine_of(fields.at("machine"));
  part.machine.shard = part.shard;
  return part;
}

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

void add_record(PartText& text, FrontierRecord record, const std::string& place, const Notice& notice) {
  record.shard = text.part.shard;
  if (text.keys.insert(record_key(record)).second) {
    text.part.records.push_back(std::move(record));
  } else if (notice) {
    notice(fmt::format("{}: {} of {}, view {}, is there twice; the first counts", place, record.point.label,
                       record.point.scene, record.view));
  }
}

FrontierRecord& open_record(PartText& text, const std::string& key) {
  const auto found = text.open.find(key);
  if (found == text.open.end()) throw input_error("{} is no record that is open", key);
  return found->second;
}

// By the keys of open records: [ms, the baseline's ms], or why the point is refused.
void add_times(PartText& text, const JsonFields& times) {
  for (const std::string& key : times.names()) {
    FrontierRecord& record = open_record(text, key);
    if (times.at(key).is_string()) {
      record.refused = times.text(key);
      continue;
    }
    const std::vector<double> ms = times.numbers(key);
    if (ms.size() != 2) throw input_error("times.{}: {} times instead of two", key, ms.size());
    record.frame_ms.push_back(ms[0]);
    record.baseline_ms.push_back(ms[1]);
  }
}

void complete(PartText& text, const json& keys, const std::string& place, const Notice& notice) {
  if (!keys.is_array()) throw input_error("complete: {} is not an array", keys.dump());
  for (const json& key : keys) {
    if (!key.is_string()) throw input_error("complete: {} is not a text", key.dump());
    FrontierRecord record = open_record(text, key);
    text.open.erase(key);
    add_record(text, std::move(record), place, notice);
  }
}

void add_line(PartText& text, const json& line, const std::string& place, const Notice& notice) {
  if (!text.described) {
    text.part = header_of(line);
    text.described = true;
    return;
  }
  const auto is_of = [&](const char* key) {
    return line.is_object() && line.size() == 1 && line.contains(key);
  };
  if (is_of("finished")) {
    text.part.finished = true;
    text.part.machine.load_at_end =
        JsonFields(line).object("finished").optional_number("load_at_end").value_or(0);
    return;
  }
  text.part.finished = false;  // until the next line that says so
  if (is_of("open")) {
    FrontierRecord record = record_of(line["open"]);
    const std::string key = record_key(record);
    text.open.insert_or_assign(key, std::move(record));
  } else if (is_of("times")) {
    add_times(text, JsonFields(line).object("times"));
  } else if (is_of("cull_ms")) {
    const JsonFields times = JsonFields(line).object("cull_ms");
    for (const std::string& key : times.names()) open_record(text, key).cull_ms.push_back(times.number(key));
  } else if (is_of("complete")) {
    complete(text, line["complete"], place, notice);
  } else if (line.is_array()) {
    for (const json& record : line) add_record(text, record_of(record), place, notice);
  } else {
    add_record(text, record_of(line), place, notice);
  }
}

}  // namespace

std::string line_text(const json& line) {
  return line.dump(-1, ' ', false, json::error_handler_t::replace) + "\n";
}

std::string header_line(const FrontierPart& part) {
  const json fields = {{"request", part.request},
                       {"commit", part.commit},
                       {"seed", part.seed},
                       {"shard", part.shard},
                       {"shards", part.shards},
                       {"baseline", part.baseline},
                       {"machine", to_json(part.machine)}};
  return first_text() + line_text(fields).substr(1);
}

// A complete line that is not what it should be is an error: only the last line can be cut off by a process's
// end.
PartText read_part_text(const fs::path& path, const Notice& notice) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw input_error("{}: cannot be opened", path.string());
  PartText text;
  std::string line;
  for (int number = 1;; ++number) {
    const std::string place = fmt::format("{}: line {}", path.string(), number);
    const LineEnd end = read_line(stream, line);
    if (end == LineEnd::too_long) throw input_error("{}: is longer than {} MiB", place, max_line_bytes >> 20);
    if (end == LineEnd::newline) {
      try {
        add_line(text, parsed(line), place, notice);
      } catch (const Error& error) {
        const char* advice =
            number == 1 ? "not a part of a frontier" : "without this line it is measured again";
        throw input_error("{}: {} ({})", place, error.what(), advice);
      }
      text.whole_bytes += line.size() + 1;
      continue;
    }
    text.half_line = !line.empty();
    // Of another file that has no newline nothing may be cut off.
    if (text.half_line && number == 1 &&
        line.compare(0, first_text().size(), first_text(), 0, line.size()) != 0) {
      throw input_error("{}: not a part of a frontier", place);
    }
    if (text.half_line && notice) notice(fmt::format("{}: is half-written and left out", place));
    return text;
  }
}

}  // namespace lightgrid
