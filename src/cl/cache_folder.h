// Where PoCL keeps what it compiles. Without a folder to write to it offers no device and gives no reason.
#pragma once

#include <filesystem>
#include <string>

namespace lightgrid {

// The folder that PoCL uses: POCL_CACHE_DIR, else pocl/kcache in XDG_CACHE_HOME or in HOME's .cache, else in /tmp.
std::filesystem::path pocl_cache_folder();

// Makes the folder where it is missing. Returns why no file can be made in it; empty where one can.
std::string why_not_writable(const std::filesystem::path& folder);

}  // namespace lightgrid
