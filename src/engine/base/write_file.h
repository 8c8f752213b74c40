// Files written whole or not at all.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
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

struct NamedBytes {
  std::string name;
  std::string_view bytes;
};

// Files of a folder that belong together, in place of those of these names and of `outdated`. All are written
// under temporary names first, so that a full disk leaves the folder as it was. Then the first one and
// `outdated` are removed and the others renamed, the first one last: whatever ends that in between leaves a
// folder without the first file, never files of two times beside it. Throws as write_file.
void write_files(const std::filesystem::path& folder, std::span<const NamedBytes> files,
                 std::span<const char* const> outdated = {});

// Makes the folder and its parents. Throws an input error if that fails or no file can be made in it, and a
// machine error if the disk is full or fails.
void make_folder(const std::filesystem::path& path);

}  // namespace lightgrid
