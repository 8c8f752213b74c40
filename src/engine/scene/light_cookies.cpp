#include "scene/light_cookies.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "base/image.h"
#include "scene/gltf/images.h"

namespace lightgrid {
namespace {

using std::numbers::pi;

struct Level {
  int width = 0, height = 0;
  std::vector<glm::vec3> texels;
};

Level base_level(const Bitmap& bitmap) {
  Level level{bitmap.width, bitmap.height, {}};
  for (size_t i = 0; i < bitmap.rgba.size(); i += 4) {
    glm::vec3& texel = level.texels.emplace_back();
    for (int c = 0; c < 3; ++c) texel[c] = linear_from_srgb(float(bitmap.rgba[i + size_t(c)]) / 255);
  }
  return level;
}

// Texel i covers texels 2 i and 2 i + 1, of which the second may be missing at the end.
Level next_level(const Level& in) {
  Level out{(in.width + 1) / 2, (in.height + 1) / 2, {}};
  for (int y = 0; y < out.height; ++y) {
    for (int x = 0; x < out.width; ++x) {
      glm::dvec3 sum(0);
      int count = 0;
      for (int v = 2 * y; v < std::min(2 * y + 2, in.height); ++v) {
        for (int u = 2 * x; u < std::min(2 * x + 2, in.width); ++u, ++count)
          sum += in.texels[size_t(v) * size_t(in.width) + size_t(u)];
      }
      out.texels.emplace_back(sum / double(count));
    }
  }
  return out;
}

// RGB9E5: mantissas times 2^(exponent - 24).
uint32_t packed(const glm::vec3& color) {
  const float largest = std::max({color.r, color.g, color.b, 0.0f});
  int exponent = 0;
  std::frexp(largest, &exponent);
  exponent = std::clamp(exponent + 15, 0, 31);
  if (std::round(std::ldexp(largest, 24 - exponent)) > 511) ++exponent;
  uint32_t word = uint32_t(exponent) << 27;
  for (int c = 0; c < 3; ++c)
    word |= uint32_t(std::min(std::round(std::ldexp(std::max(color[c], 0.0f), 24 - exponent)), 511.0f))
            << (9 * c);
  return word;
}

glm::dvec3 unpacked(uint32_t word) {
  const double scale = std::ldexp(1.0, int(word >> 27) - 24);
  return scale * glm::dvec3(word & 511, word >> 9 & 511, word >> 18 & 511);
}

// u and v in images of width and height 1.
glm::dvec3 bilinear(const Cookie& cookie, uint32_t number, double u, double v, bool wraps) {
  const auto size = [&](uint32_t base) { return int((base + (1u << number) - 1) >> number); };
  const int width = size(cookie.width), height = size(cookie.height);
  const double x = std::ldexp(u * cookie.width, -int(number)) - 0.5,
               y = std::ldexp(v * cookie.height, -int(number)) - 0.5;
  const double x0 = std::floor(x), y0 = std::floor(y);
  const auto texel = [&](int column, int row) {
    column = wraps ? (column + width) % width : std::clamp(column, 0, width - 1);
    row = std::clamp(row, 0, height - 1);
    return unpacked(cookie.words[cookie.words[number] + size_t(row) * size_t(width) + size_t(column)]);
  };
  const int column = int(x0), row = int(y0);
  return glm::mix(glm::mix(texel(column, row), texel(column + 1, row), x - x0),
                  glm::mix(texel(column, row + 1), texel(column + 1, row + 1), x - x0), y - y0);
}

// texels: as wide as one pixel. The weight between two levels is linear in the width.
glm::dvec3 trilinear(const Cookie& cookie, double texels, double u, double v, bool wraps) {
  int exponent = 0;
  const double mantissa = 2 * std::frexp(std::max(texels, 1.0), &exponent);
  const uint32_t level = uint32_t(exponent - 1);
  if (level + 1 >= cookie.levels) return bilinear(cookie, cookie.levels - 1, u, v, wraps);
  return glm::mix(bilinear(cookie, level, u, v, wraps), bilinear(cookie, level + 1, u, v, wraps),
                  mantissa - 1);
}

}  // namespace

const Property<SharedTable> light_cookie{"cookie", nullptr, {.parse = parse_cookie}};

FileTable parse_cookie(const std::vector<uint8_t>& bytes) {
  std::vector<Level> levels{base_level(gltf::decoded_image(bytes, max_cookie_side))};
  while (levels.back().texels.size() > 1) levels.push_back(next_level(levels.back()));
  FileTable out;
  out.shape = {uint32_t(levels[0].width), uint32_t(levels[0].height)};
  uint32_t place = uint32_t(levels.size());
  for (const Level& level : levels) {
    out.shape.push_back(place);
    place += uint32_t(level.texels.size());
  }
  for (const Level& level : levels)
    for (const glm::vec3& texel : level.texels) out.shape.push_back(packed(texel));
  return out;
}

Cookie cookie_of(const FileTable& table) {
  const std::span<const uint32_t> words = std::span(table.shape).subspan(2);
  return {table.shape[0], table.shape[1], words[0], words};
}

SharedTable cookie_of(const Light& light) { return is_directional(light) ? nullptr : light_cookie.of(light); }

bool is_projector(const Light& light) { return has_cone(light) && light.outer_cone_rad < max_projector_rad; }

glm::dvec3 cookie_share(const Cookie& cookie, const Light& light, const glm::dvec3& p, double footprint_m) {
  const double distance = glm::length(p);
  if (!(distance > 0)) return glm::dvec3(0);
  if (is_projector(light)) {
    if (!(p.z > 0)) return glm::dvec3(0);
    const double half = 0.5 / std::tan(double(light.outer_cone_rad)), cosine = p.z / distance;
    const double u = 0.5 + half * p.x / p.z, v = 0.5 - half * p.y / p.z;
    const double texels =
        footprint_m / distance * half * std::max(cookie.width, cookie.height) / (cosine * cosine);
    return trilinear(cookie, texels, std::clamp(u, 0.0, 1.0), std::clamp(v, 0.0, 1.0), false);
  }
  const double across = std::hypot(p.x, p.z);
  const double u = 0.5 + std::atan2(p.x, p.z) / (2 * pi), v = std::atan2(across, p.y) / pi;
  const double of_u = cookie.width / (2 * pi) / std::max(across / distance, 1e-6), of_v = cookie.height / pi;
  return trilinear(cookie, footprint_m / distance * std::max(of_u, of_v), u, v, true);
}

double pixel_width(const View& view) {
  const double width = 2 / (std::abs(view.clip_from_view[1][1]) * view.height);
  return view.orthographic ? -width : width;
}

}  // namespace lightgrid
