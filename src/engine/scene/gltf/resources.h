// The bytes of a glTF file, of its container (plain JSON, or JSON and a binary chunk in a GLB: glTF 2.0,
// section 4) and of its URIs: files in its own folder, and data URIs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scene/gltf/reporter.h"

namespace lightgrid::gltf {

// Reads a whole regular file of 1 to max_bytes bytes; a folder, pipe or device is an error. `place` precedes
// the message ("image 3: "), or is empty.
std::vector<uint8_t> read_regular_file(const Reporter& report, const std::string& place,
                                       const std::filesystem::path& path, size_t max_bytes);

// The files that a glTF file may name.
struct FileReach {
  std::vector<std::filesystem::path> folders;  // folders of the file and, if that is a link, of the link
  bool anywhere = false;                       // others too
};
FileReach reach_of(const std::filesystem::path& gltf, bool anywhere);

// Reads a buffer's or image's URI (RFC 3986, RFC 2397): a data URI is decoded; a relative path is
// percent-decoded, looked for in the folders in turn and read, unless it leaves the folder, whether by "..",
// from the root or by a link. Backslashes, which some exporters write, are tried as slashes with a warning.
std::vector<uint8_t> read_uri(Reporter& report, const std::string& place, const FileReach& reach,
                              const std::string& uri, size_t max_bytes);

// For GivenByFile::open (scene/property_rows.h): reads the URIs that the properties in `file` give.
std::function<std::pair<std::vector<uint8_t>, std::string>(const std::string& where, const std::string& uri)>
property_files(const std::filesystem::path& file, bool anywhere);

struct Container {
  std::string_view json;
  std::span<const uint8_t> binary;  // empty without a binary chunk
  bool is_glb = false;
};

// Decided by content, not by the file's name. The parts point into `bytes`. Chunks of unknown type are
// skipped; a chunk that does not fit is an error.
Container open_container(const Reporter& report, std::span<const uint8_t> bytes);

}  // namespace lightgrid::gltf
