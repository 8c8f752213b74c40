// The settings that `lightgrid bench --tune` found fastest on a device, stored beside the program cache.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "cl/device.h"

namespace lightgrid {

// Settings by their names on the command line: {"kernel-shape", "lanes"}. Only settings that change no
// result.
using TunedSizes = std::map<std::string, std::string>;

// $XDG_CACHE_HOME/lightgrid/tuned.json or ~/.cache/lightgrid/tuned.json; LIGHTGRID_TUNED names another file,
// and "off" gives an empty path.
std::filesystem::path tuned_sizes_file();

// The entry for this device and driver; empty if there is none, or no such file. Never throws: the cache is
// optional. Values are not checked: readers ignore unknown ones.
TunedSizes read_tuned_sizes(const ClDeviceInfo& device,
                            const std::filesystem::path& file = tuned_sizes_file());

// Replaces the entry of this device and keeps the others. Throws Error(input) if the file cannot be written.
void write_tuned_sizes(const ClDeviceInfo& device, const TunedSizes& sizes,
                       const std::filesystem::path& file = tuned_sizes_file());

}  // namespace lightgrid
