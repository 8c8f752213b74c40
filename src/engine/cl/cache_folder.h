// The folder in which PoCL stores compiled kernels. If it cannot write there, it offers no device and gives
// no reason.
#pragma once

#include <filesystem>
#include <string>

namespace lightgrid {

// The folder that PoCL uses: POCL_CACHE_DIR, else pocl/kcache in XDG_CACHE_HOME or in HOME's .cache, else in
// /tmp.
std::filesystem::path pocl_cache_folder();

// Creates the folder if missing. Returns why no file can be created in it; empty if one can.
std::string why_not_writable(const std::filesystem::path& folder);

}  // namespace lightgrid
