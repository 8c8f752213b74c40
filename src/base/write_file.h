// Files written whole or not at all.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

namespace lightgrid {

// Writes to a name beside `path` and renames, so that a reader, or a run cut short, never leaves half a file
// under `path`. A link at `path` is replaced, not followed; a device or pipe there is written to as it is.
// Throws an input error where the path cannot be opened (no such folder, a folder itself, not writable) and
// a machine error where the disk is full or fails.
void write_file(const std::filesystem::path& path, const std::vector<uint8_t>& bytes);
void write_file(const std::filesystem::path& path, std::string_view text);

// Makes the folder and those above it; an input error where that cannot be.
void make_folder(const std::filesystem::path& path);

}  // namespace lightgrid
