#include "frontier/record_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/error.h"
#include "base/json_file.h"
#include "base/write_file.h"

namespace lightgrid::lab {
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
  same("picture", there.picture, here.picture);
  same("threads", std::to_string(there.threads), std::to_string(here.threads));
}

}  // namespace

fs::path part_path(const fs::path& folder, int shard, int shards) {
  return folder / fmt::format("records-{}-of-{}.jsonl", shard, shards);
}

void check_same_sweep(const std::string& place, const FrontierPart& part, const FrontierPart& other,
                      const std::string& wanted) {
  const auto same = [&](const char* what, const auto& a, const auto& b) {
    if (a != b) throw input_error("{}: {} {} is not {}, that of {}", place, what, a, b, wanted);
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
    if (is_regular(file_)) lines_ = read_part_lines(path, notice);
    if (lines_.described) {
      const FrontierPart& there = lines_.part;
      check_same_sweep(path.string(), there, part, "this run");
      if (there.shard != part.shard)
        throw input_error("{}: is shard {} of {}, not {}", path.string(), there.shard, there.shards,
                          part.shard);
      check_machine(path, there.machine, part.machine);
    }
    if (lines_.half_line && ftruncate(file_, static_cast<off_t>(lines_.whole_bytes)) != 0)
      throw write_error(path, errno);
    if (!lines_.described) {
      FrontierPart empty = part;
      empty.machine.shard = part.shard;
      const std::string header = header_line(empty);
      write_text(header);
      lines_.take(json::parse(header), "", nullptr);
    }
  } catch (...) {
    close(file_);
    throw;
  }
}

RecordFile::~RecordFile() { close(file_); }

// The line is taken as it would be read from the file.
void RecordFile::add(const json& line) {
  const std::string text = line_text(line);
  write_text(text);
  lines_.take(json::parse(text), path_.string(), nullptr);
}

void RecordFile::append(std::span<const FrontierRecord> records) {
  if (records.empty()) return;
  json line = json::array();
  for (const FrontierRecord& record : records) line.push_back(to_json(record));
  add(records.size() == 1 ? line[0] : line);
}

void RecordFile::begin(const FrontierRecord& record) { add({{"open", to_json(record)}}); }

void RecordFile::add_times(const std::vector<TimeOfRecord>& times) {
  if (times.empty()) return;
  json line = {{"times", json::object()}};
  for (const TimeOfRecord& time : times) {
    json& entry = line["times"][time.key];
    entry = time.refused;
    if (!time.refused.empty()) continue;
    entry = {exact_number(time.frame_ms), exact_number(time.baseline_ms)};
    if (time.cpu_ms && time.baseline_cpu_ms)
      line["cpu_times"][time.key] = {exact_number(*time.cpu_ms), exact_number(*time.baseline_cpu_ms)};
    if (!time.device) continue;
    json& by_device = line["device_times"][time.key];
    for (const double ms : {time.device->device_ms, time.device->hand_over_ms, time.device->copy_ms,
                            time.device->read_back_ms, time.baseline_device_ms})
      by_device.push_back(exact_number(ms));
  }
  if (!std::exchange(process_begun_, true)) add({{"process", lines_.part.processes}});
  add(line);
}

void RecordFile::add_conditions(const FrontierConditions& conditions) {
  FrontierConditions of_this = conditions;
  of_this.process = std::max(lines_.part.processes - 1, 0);
  add({{"conditions", to_json(of_this)}});
}

void RecordFile::add_cull_times(const std::map<std::string, double>& times) {
  if (times.empty()) return;
  json entries = json::object();
  for (const auto& [key, ms] : times) entries[key] = exact_number(ms);
  add({{"cull_ms", entries}});
}

void RecordFile::complete(const std::vector<std::string>& keys) {
  if (!keys.empty()) add({{"complete", keys}});
}

void RecordFile::finish(double load_at_end, const std::vector<Warning>& warnings) {
  json line = {{"finished", {{"load_at_end", finite_number(load_at_end)}}}};
  if (!warnings.empty()) line["finished"]["warnings"] = warnings_json(warnings);
  add(line);
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

}  // namespace lightgrid::lab
