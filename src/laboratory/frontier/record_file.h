// A part of a sweep as a file: one JSON object a line, append-only (docs/frontier_json.md#parts). A process
// that is killed leaves at most one half-written line; opening the file again drops it, with a notice, and
// tells which records are there.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "frontier/record.h"
#include "run/frames.h"

namespace lightgrid {
class JsonFields;
}  // namespace lightgrid

namespace lightgrid::lab {

using ClockTimes = std::pair<const char*, std::vector<double> FrontierRecord::*>;  // a key and its member

using Notice = std::function<void(const std::string&)>;  // receives one line; null: nobody reads it

// 16 hexadecimal digits: FNV-1a (Fowler, Noll, Vo 1991), 64 bits. Records and requests are found again by it.
std::string content_hash(const std::string& text);

// The content hash by which a record is found again: of point, view, size, lights, series and radius scale.
std::string record_key(const FrontierRecord& record);

// A record loses nothing on its way through JSON, except that bytes that are not UTF-8 (possible in a path)
// become U+FFFD in the file. Readers throw Error(input) that names the field.
nlohmann::json to_json(const FrontierRecord& record);
nlohmann::json to_json(const FrontierMachine& machine);
nlohmann::json header_json(const FrontierPart& part);  // without records
FrontierRecord record_of(const nlohmann::json& line);
FrontierPart part_of(const nlohmann::json& header);
nlohmann::json to_json(const FrontierConditions& conditions);
FrontierConditions conditions_of(const nlohmann::json& object);

// "records-3-of-16.jsonl", for shard 3 of 16: parts of one sweep may share a folder.
std::filesystem::path part_path(const std::filesystem::path& folder, int shard, int shards);

// The content of a part's lines. Lines are read in order, both from the file and as they are written to it.
struct PartLines {
  FrontierPart part;                           // its records: those that are complete
  bool described = false;                      // the first line was read
  std::set<std::string> keys;                  // keys of the complete records
  std::map<std::string, FrontierRecord> open;  // by key: figures whose times are being measured
  uintmax_t whole_bytes = 0;                   // bytes of the complete lines
  bool half_line = false;

  // Throws Error(input). `place`: for notices, "FILE: line 7".
  void take(const nlohmann::json& line, const std::string& place, const Notice& notice);

 private:
  void add_record(FrontierRecord record, const std::string& place, const Notice& notice);
  // Adds the times of one clock to these members.
  void add_times_of_clock(const JsonFields& times, const char* name, std::span<const ClockTimes> members);
  FrontierRecord& open_record(const std::string& key);
};

// Throws Error(input) that names file and line.
PartLines read_part_lines(const std::filesystem::path& path, const Notice& notice);
// With a newline. The header begins with the version, so that half of it still shows what the file is.
std::string line_text(const nlohmann::json& line);
std::string header_line(const FrontierPart& part);

struct TimeOfRecord {
  std::string key;
  double frame_ms = 0, baseline_ms = 0;
  std::string refused;                     // why the point did not run; the times then do not count
  std::optional<DeviceTimes> device = {};  // times of the same frame
  double baseline_device_ms = 0;
  std::optional<double> cpu_ms = {}, baseline_cpu_ms = {};
};

class RecordFile {
 public:
  // Opens `path` for `part` (whose records are ignored), created if it is not there. Reads the records that
  // are there; a half-written last line is cut off and `notice` told. Throws Error(input) that names file and
  // line if the file is not a part, is of another request, commit, seed, shard or machine (times of two
  // machines are not one part), is being written by another process, or cannot be written; Error(machine) if
  // the disk is full.
  RecordFile(const std::filesystem::path& path, const FrontierPart& part, const Notice& notice);
  ~RecordFile();
  RecordFile(const RecordFile&) = delete;
  RecordFile& operator=(const RecordFile&) = delete;

  bool has(const std::string& key) const { return lines_.keys.contains(key); }
  // In the file when it returns, even if the process is killed then. Throws Error(machine) if the disk is
  // full: nothing of the records is in the file then.
  void append(const FrontierRecord& record) { append(std::span(&record, 1)); }
  // Several of them in one line: after a kill all of them are there, or none.
  void append(std::span<const FrontierRecord> records);

  // A record whose times follow is open: its figures are kept, but it is none of the part's records until it
  // is complete. All of these throw as append() does, and are whole or not there after a kill. Keys:
  // record_key of open records.
  void begin(const FrontierRecord& record);
  void add_times(const std::vector<TimeOfRecord>& times);     // times of a round; the first begins a process
  void add_conditions(const FrontierConditions& conditions);  // conditions in this process's last round
  void add_cull_times(const std::map<std::string, double>& times_ms);  // likewise
  void complete(const std::vector<std::string>& keys);
  const std::map<std::string, FrontierRecord>& open_records() const { return lines_.open; }

  // Nothing more is to be measured. `load_at_end`: the system's one-minute load average; `warnings`: of the
  // run. Throws like append().
  void finish(double load_at_end, const std::vector<Warning>& warnings = {});
  const FrontierPart& part() const { return lines_.part; }  // with all records

 private:
  void add(const nlohmann::json& line);
  void write_text(const std::string& text);

  std::filesystem::path path_;
  int file_ = -1;
  bool process_begun_ = false;
  PartLines lines_;
};

// Reads a finished or half-finished part, even while it is written. A half-written last line is left out, a
// record that is there twice counts once, each with a notice. Throws Error(input) that names file and line.
FrontierPart read_part(const std::filesystem::path& path, const Notice& notice);

// Reads every part (part_path) of the folders, in the order of shards. `notice` is told of half-written
// lines, of shards that are missing and of parts that are not finished, whose points are missing from the
// answer, and of scenes that parts measured on different numbers of views. Throws Error(input) that names the
// file if a folder is not there or holds no part, if two parts are not of one sweep, and if a shard is there
// twice.
std::vector<FrontierPart> read_parts(const std::vector<std::filesystem::path>& folders, const Notice& notice);

// Throws Error(input), "`place`: ...", if two parts are not of one sweep: request, commit, seed, baseline,
// shards. `wanted`: what the other is, for the message: "this run", "records-0-of-2.jsonl".
void check_same_sweep(const std::string& place, const FrontierPart& part, const FrontierPart& other,
                      const std::string& wanted);

// True if point `index` of the request is in shard `shard` of `shards`: every shards-th of them, so that each
// shard has all scenes' costs in like shares. Points are shared out, not views: times are summed over the
// views of a point, and those of two machines cannot be. Throws Error(input) for less than one shard and for
// a shard that is not there.
bool in_shard(size_t index, int shard, int shards);

}  // namespace lightgrid::lab
