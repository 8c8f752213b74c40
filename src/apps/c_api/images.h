// Images in the caller's memory.
#pragma once

#include <cstring>
#include <string>

#include "base/image.h"
#include "c_api/call.h"

namespace lightgrid::app::c {

// Throws Error(input) that names the field, unless there is an image of that format and, if they are not 0,
// sides.
const lightgrid_image& checked(const lightgrid_image* image, const std::string& name, lightgrid_format format,
                               int width = 0, int height = 0);

size_t pixel_bytes(lightgrid_format format);

inline char* row_of(const lightgrid_image& image, int y) {
  return static_cast<char*>(image.pixels) + ptrdiff_t(y) * image.row_bytes;
}

// Pixels without gaps, row 0 at the bottom, to the image.
inline void write_pixels(const lightgrid_image& to, const void* from) {
  const size_t row = size_t(to.width) * pixel_bytes(to.format);
  for (int y = 0; y < to.height; ++y)
    std::memcpy(row_of(to, y), static_cast<const char*>(from) + size_t(y) * row, row);
}

inline void read_pixels(const lightgrid_image& from, void* to) {
  const size_t row = size_t(from.width) * pixel_bytes(from.format);
  for (int y = 0; y < from.height; ++y)
    std::memcpy(static_cast<char*>(to) + size_t(y) * row, row_of(from, y), row);
}

}  // namespace lightgrid::app::c
