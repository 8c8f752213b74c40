#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "base/image.h"
#include "base/parallel.h"
#include "shared/tone_map.h"

namespace lightgrid {
namespace {

constexpr glm::u8vec3 nan_marker = {255, 0, 255};

uint8_t byte_of(float unit) { return static_cast<uint8_t>(std::clamp(unit, 0.f, 1.f) * 255.f + 0.5f); }

bool has_nan(glm::vec3 v) { return std::isnan(v.x) || std::isnan(v.y) || std::isnan(v.z); }

template <typename Map>
std::vector<uint8_t> bytes_of(const Image& image, const Map& map) {
  std::vector<uint8_t> bytes(size_t(image.width) * image.height * 3);
  parallel_for(image.height, [&](int row) {
    uint8_t* out = &bytes[size_t(row) * image.width * 3];
    for (int x = 0; x < image.width; ++x, out += 3) {
      const auto linear = glm::vec3(image.at(x, image.height - 1 - row));
      const auto mapped = map(linear);
      for (int c = 0; c < 3; ++c) {
        out[c] = has_nan(linear) ? nan_marker[c] : byte_of(srgb_from_linear(mapped[c]));
      }
    }
  });
  return bytes;
}

}  // namespace

glm::vec3 tone_map_neutral(glm::vec3 linear) { return tone::tone_mapped(linear); }

float srgb_from_linear(float linear) {
  return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.f / 2.4f) - 0.055f;
}

float linear_from_srgb(float srgb) {
  return srgb <= 0.04045f ? srgb / 12.92f : std::pow((srgb + 0.055f) / 1.055f, 2.4f);
}

// By halving the floats between 0 and 2, which are in the order of their bits.
const std::array<float, 257>& srgb_thresholds() {
  static const std::array<float, 257> least = [] {
    std::array<float, 257> all{};
    for (int byte = 1; byte < 256; ++byte) {
      uint32_t below = 0, at = std::bit_cast<uint32_t>(2.0f);
      while (at - below > 1) {
        const uint32_t middle = below + (at - below) / 2;
        (byte_of(srgb_from_linear(std::bit_cast<float>(middle))) < byte ? below : at) = middle;
      }
      all[size_t(byte)] = std::bit_cast<float>(at);
    }
    all[256] = std::numeric_limits<float>::infinity();
    return all;
  }();
  return least;
}

Exposure automatic_exposure(const Image& image) {
  constexpr double middle = 0.18, darkest = 1e-4, max_ev = 60;
  std::vector<float> luminances;
  luminances.reserve(image.pixels.size());
  for (const glm::vec4& pixel : image.pixels) {
    const float luminance = glm::dot(glm::vec3(pixel), glm::vec3(0.2126f, 0.7152f, 0.0722f));
    if (luminance > 0 && std::isfinite(luminance)) luminances.push_back(luminance);
  }
  if (luminances.empty()) return {0, true};
  const auto bright = luminances.begin() + ptrdiff_t(luminances.size() * 99 / 100);
  std::nth_element(luminances.begin(), bright, luminances.end());
  const double least = darkest * *bright;
  double logarithms = 0;
  size_t count = 0;
  for (const float luminance : luminances) {
    if (luminance >= least) {
      logarithms += std::log2(double(luminance));
      ++count;
    }
  }
  const double ev = std::log2(middle) - logarithms / double(count);
  return {std::clamp(std::round(2 * ev) / 2, -max_ev, max_ev), true};
}

std::vector<uint8_t> srgb_bytes(const Image& image, const Exposure& exposure) {
  return bytes_of(image,
                  [scale = exposure.scale()](glm::vec3 linear) { return tone_map_neutral(scale * linear); });
}

std::vector<uint8_t> srgb_bytes_as_is(const Image& image) {
  return bytes_of(image, [](glm::vec3 linear) { return glm::clamp(linear, 0.f, 1.f); });
}

}  // namespace lightgrid
