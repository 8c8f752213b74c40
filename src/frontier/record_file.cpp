#include "frontier/record_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cassert>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/write_file.h"
#include "frontier/json_fields.h"

namespace lightgrid {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr size_t max_line_bytes = size_t(64) << 20;  // a thousand views of a thousand runs take 40 million
constexpr int max_depth = 8;
constexpr char first_key[] = "lightgrid_frontier";

std::string first_text() { return fmt::format("{{\"{}\":1,", first_key); }

std::string line_text(const json& line) {
  return line.dump(-1, ' ', false, json::error_handler_t::replace) + "\n";
}

// The line starts with `first_key`, so that half of it still shows what the file is.
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

struct PartText {
  FrontierPart part;
  bool described = false;     // has its first line
  uintmax_t whole_bytes = 0;  // of the complete lines
  bool half_line = false;
  std::set<std::string> keys;
};

void add_record(PartText& text, const json& object, const std::string& place, const Notice& notice) {
  FrontierRecord record = record_of(object);
  record.shard = text.part.shard;
  if (text.keys.insert(record_key(record)).second) {
    text.part.records.push_back(std::move(record));
  } else if (notice) {
    notice(fmt::format("{}: {} of {}, view {}, is there twice; the first counts", place, record.point.label,
                       record.point.scene, record.view));
  }
}

void add_line(PartText& text, const json& line, const std::string& place, const Notice& notice) {
  if (!text.described) {
    text.part = header_of(line);
    text.described = true;
    return;
  }
  if (line.is_object() && line.contains("finished")) {
    text.part.finished = true;
    text.part.machine.load_at_end =
        JsonFields(line).object("finished").optional_number("load_at_end").value_or(0);
    return;
  }
  text.part.finished = false;  // until the next line that says so
  if (!line.is_array()) add_record(text, line, place, notice);
  for (size_t i = 0; line.is_array() && i < line.size(); ++i) add_record(text, line[i], place, notice);
}

// A complete line that is not what it should be is an error: only the last line can be cut off by a process's
// end.
PartText read_text(const fs::path& path, const Notice& notice) {
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

bool is_regular(int file) {
  struct stat status = {};
  return fstat(file, &status) == 0 && S_ISREG(status.st_mode);
}

void check_machine(const fs::path& path, const FrontierMachine& there, const FrontierMachine& here) {
  const auto same = [&](const char* what, const std::string& a, const std::string& b) {
    const json in_file = json::parse(line_text(b));  // the other has been in a file
    if (a == in_file) return;
    throw input_error(
        "{}: begun with {} \"{}\", here it is \"{}\"; a part is of one machine: use another folder",
        path.string(), what, a, b);
  };
  same("OpenCL device", there.cl_device, here.cl_device);
  same("OpenCL driver", there.cl_driver, here.cl_driver);
  same("OpenGL device", there.gl_device, here.gl_device);
  same("OpenGL driver", there.gl_driver, here.gl_driver);
  same("CPU", there.cpu, here.cpu);
  same("threads", std::to_string(there.threads), std::to_string(here.threads));
}

}  // namespace

fs::path part_path(const fs::path& folder, int shard, int shards) {
  return folder / fmt::format("records-{}-of-{}.jsonl", shard, shards);
}

void check_same_sweep(const fs::path& path, const FrontierPart& part, const FrontierPart& other,
                      const std::string& wanted) {
  const auto same = [&](const char* what, const auto& a, const auto& b) {
    if (a != b) throw input_error("{}: {} {} is not {}, that of {}", path.string(), what, a, b, wanted);
  };
  same("commit", part.commit, other.commit);
  same("seed", part.seed, other.seed);
  same("number of shards", part.shards, other.shards);
  same("baseline", part.baseline, other.baseline);
  same("request (of scenes, points, views and size)", part.request, other.request);
}

RecordFile::RecordFile(const fs::path& path, const FrontierPart& part, const Notice& notice) : path_(path) {
  file_ = open(path.c_str(), O_RDWR | O_APPEND | O_CREAT | O_CLOEXEC, 0666);
  if (file_ < 0) throw write_error(path, errno);
  try {
    // Some network file systems have no locks; there nothing guards against two processes.
    if (flock(file_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      throw input_error("{}: another process is writing it", path.string());
    }
    PartText text;
    if (is_regular(file_)) text = read_text(path, notice);
    part_ = text.described ? std::move(text.part) : part;
    keys_ = std::move(text.keys);
    if (text.described) {
      check_same_sweep(path, part_, part, "this run");
      if (part_.shard != part.shard) {
        throw input_error("{}: is shard {} of {}, not {}", path.string(), part_.shard, part_.shards,
                          part.shard);
      }
      check_machine(path, part_.machine, part.machine);
    }
    if (text.half_line && ftruncate(file_, static_cast<off_t>(text.whole_bytes)) != 0)
      throw write_error(path, errno);
    if (!text.described) {
      part_.records.clear();
      part_.finished = false;
      part_.machine.shard = part_.shard;
      write_text(header_line(part_));
    }
  } catch (...) {
    close(file_);
    throw;
  }
}

RecordFile::~RecordFile() { close(file_); }

void RecordFile::append(std::span<const FrontierRecord> records) {
  if (records.empty()) return;
  json line = json::array();
  for (const FrontierRecord& record : records) {
    assert(!has(record_key(record)));
    line.push_back(to_json(record));
  }
  write_text(line_text(records.size() == 1 ? line[0] : line));
  for (const FrontierRecord& record : records) {
    keys_.insert(record_key(record));
    part_.records.push_back(record);
    part_.records.back().shard = part_.shard;
  }
  part_.finished = false;
}

void RecordFile::finish(double load_at_end) {
  write_text(line_text({{"finished", {{"load_at_end", finite_number(load_at_end)}}}}));
  part_.finished = true;
  part_.machine.load_at_end = load_at_end;
}

// In one call where the system allows it: a reader rarely sees half of a line.
void RecordFile::write_text(const std::string& text) {
  const off_t before = lseek(file_, 0, SEEK_END);
  for (size_t written = 0; written < text.size();) {
    const ssize_t count = write(file_, text.data() + written, text.size() - written);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) {
      const int code = count < 0 ? errno : EIO;
      if (before >= 0 && is_regular(file_) && ftruncate(file_, before) != 0) {
        // The half line stays; the next start drops it.
      }
      throw write_error(path_, code);
    }
    written += static_cast<size_t>(count);
  }
}

FrontierPart read_part(const fs::path& path, const Notice& notice) {
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) throw input_error("{}: no such file", path.string());
  PartText text = read_text(path, notice);
  if (!text.described) throw input_error("{}: not a part of a frontier", path.string());
  return std::move(text.part);
}

bool in_shard(size_t index, int shard, int shards) {
  if (shards < 1 || shard < 0 || shard >= shards) {
    throw input_error("shard {}/{}: there are no such parts; of N parts the first is 0/N and the last N-1/N",
                      shard, shards);
  }
  return index % static_cast<size_t>(shards) == static_cast<size_t>(shard);
}

}  // namespace lightgrid
