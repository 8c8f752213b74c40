#include "frontier/record_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/write_file.h"
#include "frontier/json_fields.h"

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
  std::map<std::string, std::map<int, int>> views;  // by scene: of each shard
  for (const FrontierPart& part : parts) {
    for (const FrontierRecord& r : part.records) {
      int& count = views[r.point.scene][part.shard];
      if (r.series.empty()) count = std::max(count, r.view + 1);
    }
  }
  for (auto& [scene, counts] : views) {
    std::erase_if(counts, [](const auto& of_shard) { return of_shard.second == 0; });
    if (counts.empty()) continue;
    const auto [least, most] =
        std::ranges::minmax_element(counts, [](const auto& a, const auto& b) { return a.second < b.second; });
    const auto first_of = [&](int count) {
      return std::ranges::find(counts, count, &std::pair<const int, int>::second)->first;
    };
    if (least->second == most->second) continue;
    notice(fmt::format("{}: {} views in shard {}, {} in shard {}: points of different views are compared",
                       scene, least->second, least->first, most->second, first_of(most->second)));
  }
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

// What is known then is what reading the line again would tell.
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
  json entries = json::object();
  for (const TimeOfRecord& time : times) {
    json& entry = entries[time.key];
    entry = time.refused;
    if (time.refused.empty()) entry = {exact_number(time.frame_ms), exact_number(time.baseline_ms)};
  }
  add({{"times", entries}});
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

void RecordFile::finish(double load_at_end) {
  add({{"finished", {{"load_at_end", finite_number(load_at_end)}}}});
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

}  // namespace lightgrid
