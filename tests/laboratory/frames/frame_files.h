// The small frame as files, to read, write and damage.
#pragma once

#include <fstream>

#include <gtest/gtest.h>

#include "base/error.h"
#include "frames/captured_frame.h"
#include "support/temp_folder.h"

namespace lightgrid::lab {

inline std::string file_bytes(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

inline void write_bytes(const std::filesystem::path& path, const std::string& bytes) {
  std::filesystem::remove(path);  // some file systems delay the truncation and rewrite of a file
  std::ofstream(path, std::ios::binary) << bytes;
}

inline FrameGrid small_grid() {
  FrameGrid grid;
  grid.lists.cells_x = 3;
  grid.lists.cells_y = 2;
  grid.lists.slices = 2;
  grid.slice_edges = {4.1f};
  for (uint32_t cell = 0; cell < 12; ++cell) {
    grid.lists.cells.push_back({grid.lists.indices.size(), cell % 4});
    for (uint32_t i = 0; i < cell % 4; ++i) grid.lists.indices.push_back(cell + 3 * i);
  }
  grid.settings = {{"tile", "16"}, {"cull_test", "planes+aabb"}};
  return grid;
}

// The error of reading the folder, its grid included; empty if it is read.
inline std::string fault_of(const std::filesystem::path& folder) {
  try {
    read_frame_grid(folder, read_frame(folder));
    return "";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input) << error.what();
    return error.what();
  }
}

}  // namespace lightgrid::lab
