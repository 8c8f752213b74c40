// What `lightgrid bench --tune` found to be fastest on a device, kept beside the program cache.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "cl/device.h"

namespace lightgrid {

// Settings by their names on the command line: {"kernel-shape", "lanes"}. Only such as change no result.
using TunedSizes = std::map<std::string, std::string>;

// $XDG_CACHE_HOME/lightgrid/tuned.json or ~/.cache/lightgrid/tuned.json; LIGHTGRID_TUNED names another, and "off"
// none: empty.
std::filesystem::path tuned_sizes_file();

// What the file says of this device with this driver; empty where it says nothing, or is no such file. A cache may
// fail: never throws. Values are not checked: a reader takes those that it knows.
TunedSizes read_tuned_sizes(const ClDeviceInfo& device, const std::filesystem::path& file = tuned_sizes_file());

// Puts `sizes` in the place of what the file says of this device, and keeps the rest. Throws Error(input) where the
// file cannot be written.
void write_tuned_sizes(const ClDeviceInfo& device, const TunedSizes& sizes,
                       const std::filesystem::path& file = tuned_sizes_file());

}  // namespace lightgrid
