// Pictures of other programs as EXR or HDR files.
#pragma once

#include <filesystem>

#include "base/image.h"

namespace lightgrid {

// Channels R, G and B of 16 or 32 bits, linear; others are left out, and alpha is 1. NaN and infinite values
// stay. Throws Error(input) that names the file unless it is an EXR of rows with one part, of this size, that
// has these channels, and at most 16.
Image load_exr_picture(const std::filesystem::path& path, int width, int height);

// A picture of linear radiance by the extension, .hdr or .exr, with at most 8192 pixels along each side, as
// above. Throws Error(input) that names the file.
Image load_radiance_picture(const std::filesystem::path& path);

}  // namespace lightgrid
