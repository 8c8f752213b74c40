// Files written whole or not at all.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

#include "base/error.h"

namespace lightgrid {

// "PATH: cannot be written: REASON" of an errno: a machine error if the disk is full or fails, otherwise an
// input error.
Error write_error(const std::filesystem::path& path, int code);

// Writes to a temporary name beside `path` and renames, so that neither a reader nor an interrupted run finds
// half a file under `path`. A link at `path` is replaced, not followed; a device, a pipe, and a link in /dev
// or /proc are written to directly. Throws an input error if the path cannot be opened (no such folder, a
// folder itself, not writable) and a machine error if the disk is full or fails.
void write_file(const std::filesystem::path& path, const std::vector<uint8_t>& bytes);
void write_file(const std::filesystem::path& path, std::string_view text);

// Makes the folder and its parents. Throws an input error if that fails or no file can be made in it, and a
// machine error if the disk is full or fails.
void make_folder(const std::filesystem::path& path);

}  // namespace lightgrid
