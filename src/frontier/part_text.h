// The lines of a part as text: docs/frontier_json.md#lines.
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>

#include "frontier/record_file.h"

namespace lightgrid {

struct PartText {
  FrontierPart part;          // its records: those that are complete
  bool described = false;     // has its first line
  uintmax_t whole_bytes = 0;  // of the complete lines
  bool half_line = false;
  std::set<std::string> keys;                  // of the complete records
  std::map<std::string, FrontierRecord> open;  // by key
};

// A complete line that is not what it should be is an error: only the last line can be cut off by a process's
// end. Throws Error(input) that names file and line.
PartText read_part_text(const std::filesystem::path& path, const Notice& notice);

// With a newline. Bytes that are not UTF-8 become U+FFFD.
std::string line_text(const nlohmann::json& line);

// The line starts with its version, so that half of it still shows what the file is.
std::string header_line(const FrontierPart& part);

}  // namespace lightgrid
