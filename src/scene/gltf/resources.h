// Bytes of a glTF file and of its URIs: files in its own folder, and data URIs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "scene/gltf/reporter.h"

namespace lightgrid::gltf {

// Reads a whole regular file of 1 to max_bytes bytes; a folder, pipe or device is an error. `place` precedes
// the message ("image 3: "), or is empty.
std::vector<uint8_t> read_regular_file(const Reporter& report, const std::string& place,
                                       const std::filesystem::path& path, size_t max_bytes);

// Reads a buffer's or image's URI (RFC 3986, RFC 2397): a data URI is decoded; a relative path is
// percent-decoded and read, unless it leaves `folder`, whether by "..", from the root or by a link.
std::vector<uint8_t> read_uri(const Reporter& report, const std::string& place,
                              const std::filesystem::path& folder, const std::string& uri, size_t max_bytes);

}  // namespace lightgrid::gltf
