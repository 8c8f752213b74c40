#include "frontier/record_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cassert>
#include <cerrno>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/write_file.h"
#include "frontier/json_fields.h"
#include "frontier/part_text.h"

namespace lightgrid {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

bool is_regular(int file) {
  struct stat status = {};
  return fstat(file, &status) == 0 && S_ISREG(status.st_mode);
}

void check_machine(const fs::path& path, const FrontierMachine& there, const FrontierMachine& here) {
  const auto same = [&](const char* what, const std::string& a, const std::string& b) {
    const std::string in_file = json::parse(line_text(b));  // the other has been in a file
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
    if (is_regular(file_)) text = read_part_text(path, notice);
    part_ = text.described ? std::move(text.part) : part;
    keys_ = std::move(text.keys);
    open_ = std::move(text.open);
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

void RecordFile::begin(const FrontierRecord& record) {
  const std::string key = record_key(record);
  assert(!has(key));
  write_text(line_text({{"open", to_json(record)}}));
  open_.insert_or_assign(key, record);
  part_.finished = false;
}

void RecordFile::add_times(const std::vector<TimeOfRecord>& times) {
  if (times.empty()) return;
  json entries = json::object();
  for (const TimeOfRecord& time : times) {
    json& entry = entries[time.key];
    if (!time.refused.empty()) {
      entry = time.refused;
    } else {
      entry = {exact_number(time.frame_ms), exact_number(time.baseline_ms)};
    }
  }
  write_text(line_text({{"times", entries}}));
  for (const TimeOfRecord& time : times) {
    FrontierRecord& record = open_.at(time.key);
    if (!time.refused.empty()) {
      record.refused = time.refused;
      continue;
    }
    record.frame_ms.push_back(time.frame_ms);
    record.baseline_ms.push_back(time.baseline_ms);
  }
}

void RecordFile::add_cull_times(const std::map<std::string, double>& times) {
  if (times.empty()) return;
  json entries = json::object();
  for (const auto& [key, ms] : times) entries[key] = exact_number(ms);
  write_text(line_text({{"cull_ms", entries}}));
  for (const auto& [key, ms] : times) open_.at(key).cull_ms.push_back(ms);
}

void RecordFile::complete(const std::vector<std::string>& keys) {
  if (keys.empty()) return;
  write_text(line_text({{"complete", keys}}));
  for (const std::string& key : keys) {
    part_.records.push_back(std::move(open_.at(key)));
    part_.records.back().shard = part_.shard;
    open_.erase(key);
    keys_.insert(key);
  }
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
  PartText text = read_part_text(path, notice);
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
