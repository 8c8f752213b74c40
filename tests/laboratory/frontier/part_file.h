// A part in a folder of its own, for tests that write, cut off and open it.
#pragma once

#include <fstream>

#include "frontier/faults.h"
#include "frontier/record_file.h"
#include "frontier/some_records.h"
#include "support/read_files.h"
#include "support/temp_folder.h"

namespace lightgrid::lab {

inline void write_text(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

struct PartFile {
  TempFolder folder;
  std::filesystem::path path = part_path(folder.path, 1, 4);
  Told told;

  RecordFile open(const FrontierPart& part = some_part()) { return RecordFile(path, part, told.notice()); }
  std::string text() const { return file_bytes(path); }

  // Three records, and the end.
  void fill() {
    RecordFile file = open();
    for (int view = 0; view < 3; ++view) file.append(some_record(8, view));
    file.finish(0.5);
  }
  std::string fault(const FrontierPart& part = some_part()) {
    return fault_of([&] { open(part); });
  }
};

}  // namespace lightgrid::lab
