// A part as a file: one JSON object a line, append-only. The first line describes the part, each further one is a record.
// A process that is killed leaves at most one half-written line; opening the file again drops it, with a note, and tells
// which records are there.
#pragma once

#include <filesystem>
#include <fstream>
#include <functional>
#include <set>

#include "frontier/record.h"

namespace lightgrid {

// The content hash by which a record is found again: of point, view, size, lights, series and radius scale.
std::string record_key(const FrontierRecord& record);

nlohmann::json to_json(const FrontierRecord& record);
FrontierRecord record_of(const nlohmann::json& line);  // throws Error(input) that names the field

class RecordFile {
 public:
  // Opens `path` for `part` (whose records are ignored), created if it is not there. Reads the records that are there; a
  // half-written last line is cut off and `notice` told. Throws Error(input) if the file is of another request, commit or
  // shard, and if it cannot be written.
  RecordFile(const std::filesystem::path& path, const FrontierPart& part,
             const std::function<void(const std::string&)>& notice);

  bool has(const std::string& key) const { return keys_.contains(key); }
  void append(const FrontierRecord& record);  // flushed; throws Error(machine) if the disk is full
  const FrontierPart& part() const { return part_; }  // with all records

 private:
  std::filesystem::path path_;
  std::ofstream out_;
  FrontierPart part_;
  std::set<std::string> keys_;
};

// Reads a finished or half-finished part. Throws Error(input).
FrontierPart read_part(const std::filesystem::path& path, const std::function<void(const std::string&)>& notice);

// The points and views of shard `shard` of `shards`: every shards-th of them, by index, so that each shard has all
// scenes' costs in like shares. Throws Error(input) for 0 shards and for a shard that is not there.
bool in_shard(size_t index, int shard, int shards);

}  // namespace lightgrid
