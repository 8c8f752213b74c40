#include <algorithm>
#include <cmath>

#include "base/image.h"
#include "base/parallel.h"

namespace lightgrid {
namespace {

// Anything brighter, infinity included, becomes white; inf - inf and inf * 0 below would give NaN.
constexpr float brightest = 1e30f;

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

glm::vec3 tone_map_neutral(glm::vec3 linear) {
  constexpr float start_compression = 0.8f - 0.04f, desaturation = 0.15f;
  auto colour = glm::clamp(linear, 0.f, brightest);

  // Subtracts the reflection of a white surrounding by a dielectric, about 0.04.
  const float darkest = std::min({colour.r, colour.g, colour.b});
  colour -= darkest < 0.08f ? darkest - 6.25f * darkest * darkest : 0.04f;

  const float peak = std::max({colour.r, colour.g, colour.b});
  if (peak < start_compression) return colour;

  constexpr float room = 1.f - start_compression;
  const float new_peak = 1.f - room * room / (peak + room - start_compression);
  colour *= new_peak / peak;
  const float to_white = 1.f - 1.f / (desaturation * (peak - new_peak) + 1.f);
  return glm::mix(colour, glm::vec3(new_peak), to_white);
}

float srgb_from_linear(float linear) {
  return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.f / 2.4f) - 0.055f;
}

float linear_from_srgb(float srgb) {
  return srgb <= 0.04045f ? srgb / 12.92f : std::pow((srgb + 0.055f) / 1.055f, 2.4f);
}

Exposure automatic_exposure(const Image& image) {
  constexpr double middle = 0.18, darkest = 1e-4, most_ev = 60;
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
    if (luminance >= least) logarithms += std::log2(double(luminance)), ++count;
  }
  const double ev = std::log2(middle) - logarithms / double(count);
  return {std::clamp(std::round(2 * ev) / 2, -most_ev, most_ev), true};
}

std::vector<uint8_t> srgb_bytes(const Image& image, const Exposure& exposure) {
  return bytes_of(image,
                  [scale = exposure.scale()](glm::vec3 linear) { return tone_map_neutral(scale * linear); });
}

std::vector<uint8_t> srgb_bytes_as_is(const Image& image) {
  return bytes_of(image, [](glm::vec3 linear) { return glm::clamp(linear, 0.f, 1.f); });
}

}  // namespace lightgrid
