// One built OpenCL program on disk. The file holds its whole key, so that two keys never share a program, and
// a checksum of the binary, since some drivers crash on a damaged one instead of refusing it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace lightgrid {

// folder/ENTRY-HASH.bin
std::filesystem::path program_file_path(const std::filesystem::path& folder, const std::string& entry,
                                        const std::string& key);

// Empty where the file is absent, cut short, damaged or of another key.
std::vector<unsigned char> read_program_file(const std::filesystem::path& file, const std::string& key);

// Whole or not at all: written beside it and renamed. A folder that cannot be written is no error: a cache
// may fail.
void write_program_file(const std::filesystem::path& file, const std::string& key,
                        const std::vector<unsigned char>& binary);

}  // namespace lightgrid
