// Images in memory and as files. Linear light, float, row 0 at the bottom (as OpenGL has it); the file
// writers turn them over.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace lightgrid {

struct Image {
  int width = 0, height = 0;
  std::vector<glm::vec4> pixels;  // linear RGBA, scene-referred; alpha is coverage

  Image() = default;
  Image(int width, int height) : width(width), height(height), pixels(size_t(width) * height, glm::vec4(0)) {}
  glm::vec4& at(int x, int y) { return pixels[size_t(y) * width + x]; }
  const glm::vec4& at(int x, int y) const { return pixels[size_t(y) * width + x]; }
};

// The tone map of measured pictures: Khronos PBR Neutral (Khronos Group 2024). It subtracts the 0.04 that a
// dielectric reflects, keeps base colours below 0.8 and compresses brighter ones towards white. Input:
// linear, scene-referred. Output: linear in [0, 1]; negative gives 0, infinity white, NaN stays NaN.
glm::vec3 tone_map_neutral(glm::vec3 linear);
float srgb_from_linear(float linear);
float linear_from_srgb(float srgb);
// For each sRGB byte the smallest linear value that maps to it, then a value that none reaches: devices find
// the same bytes with them (shared/tone_map.h).
const std::array<float, 257>& srgb_thresholds();

// Pictures alone have one: each linear value is multiplied by 2^ev before the tone map. Files of linear
// values and errors are without it.
struct Exposure {
  double ev = 0;
  bool automatic = false;  // ev was taken from a picture

  float scale() const { return float(std::exp2(ev)); }
};

// The exposure at which the logarithmic mean of the picture's luminances becomes 0.18, to half a stop, so
// that pictures that differ little share it. Pixels that are black, not finite, or below 1/10,000 of the 99th
// percentile are left out; 0 if none is left. At least -60 and at most 60.
Exposure automatic_exposure(const Image& image);

// Bytes as PNG files store them: row 0 at the top, RGB, tone-mapped. A pixel that contains NaN becomes
// magenta (255, 0, 255), to be noticed. Deterministic.
std::vector<uint8_t> srgb_bytes(const Image& image, const Exposure& exposure = {});

// The same without the tone map: for images of numbers (difference_image, heat_map), whose legends need it.
std::vector<uint8_t> srgb_bytes_as_is(const Image& image);

// Eight bits, 1 to 4 channels, row 0 at the top, at least 1x1. RGB with at most 256 colours is written
// with a palette.
std::vector<uint8_t> encode_png(int width, int height, int channels, const std::vector<uint8_t>& bytes);
void save_png(const std::filesystem::path& path, const Image& image, const Exposure& exposure = {});
// The same without the tone map (srgb_bytes_as_is).
void save_png_as_is(const std::filesystem::path& path, const Image& image);
void save_exr(const std::filesystem::path& path, const Image& image);  // 32-bit float RGB, linear

// A channel of an EXR file: the 32 bits of a float, or a whole number, of each pixel; row 0 at the bottom.
struct ExrChannel {
  std::string name;
  bool whole = false;
  std::vector<uint32_t> words;
};
void save_exr(const std::filesystem::path& path, int width, int height,
              const std::vector<ExrChannel>& channels);  // in the order of their names' bytes
// In the file's order. Throws Error(input) unless the file is an EXR of rows with one part, of this size, and
// of at most 16 channels of 32 bits.
std::vector<ExrChannel> load_exr(const std::filesystem::path& path, int width, int height);

bool is_exr(const std::filesystem::path& path);  // by its extension
// Throws Error(input) unless the extension is .png or .exr; call it before long work.
void check_image_path(const std::filesystem::path& path);

// By extension: .png exposed and through the tone map, .exr linear; anything else is an input error.
// Whatever saves a picture writes the file whole or not at all, and throw as write_file does
// (base/write_file.h).
void save_image(const std::filesystem::path& path, const Image& image, const Exposure& exposure = {});

}  // namespace lightgrid
