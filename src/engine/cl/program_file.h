// One built OpenCL program on disk. The file contains its whole key, so that two keys never share a program,
// and a checksum of the binary, since some drivers crash on a damaged one instead of rejecting it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace lightgrid {

// folder/ENTRY-HASH.bin
std::filesystem::path program_file_path(const std::filesystem::path& folder, const std::string& entry,
                                        const std::string& key);

// Empty if the file is absent, truncated, damaged or of another key.
std::vector<unsigned char> read_program_file(const std::filesystem::path& file, const std::string& key);

// Writes a temporary file and renames it. A folder that cannot be written is no error: the cache is optional.
void write_program_file(const std::filesystem::path& file, const std::string& key,
                        const std::vector<unsigned char>& binary);

}  // namespace lightgrid
