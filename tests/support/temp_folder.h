// A new empty folder, removed with its contents at the end of the test.
#pragma once

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace lightgrid {

struct TempFolder {
  std::filesystem::path path;

  TempFolder() {
    auto name = (std::filesystem::temp_directory_path() / "lightgrid_XXXXXX").string();
    if (!mkdtemp(name.data())) std::abort();
    path = name;
  }
  ~TempFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;
};

}  // namespace lightgrid
