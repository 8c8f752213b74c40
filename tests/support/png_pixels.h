// A PNG's pixels, for tests of pictures that the program wrote.
#pragma once

#include <png.h>

#include <cstdint>
#include <filesystem>
#include <vector>

namespace lightgrid {

struct PngPixels {
  int width = 0, height = 0;
  std::vector<uint8_t> rgb;  // row 0 at the top
  uint8_t at(int x, int y, int channel) const { return rgb[(size_t(y) * width + x) * 3 + channel]; }
};

// Empty if the file cannot be read.
inline PngPixels read_png(const std::filesystem::path& path) {
  PngPixels pixels;
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  if (!png_image_begin_read_from_file(&header, path.c_str())) return pixels;
  header.format = PNG_FORMAT_RGB;
  pixels.rgb.resize(PNG_IMAGE_SIZE(header));
  if (!png_image_finish_read(&header, nullptr, pixels.rgb.data(), 0, nullptr)) return {};
  pixels.width = int(header.width);
  pixels.height = int(header.height);
  return pixels;
}

}  // namespace lightgrid
