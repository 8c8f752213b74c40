#include "reference/texture_sampler.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lightgrid {
namespace {

using glm::dvec2, glm::dvec4;

// IEC 61966-2-1.
double decoded(double s) { return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4); }

const std::array<double, 256>& values_of_bytes(bool srgb) {
  static const auto tables = [] {
    std::array<std::array<double, 256>, 2> made{};
    for (int i = 0; i < 256; ++i) made[0][i] = i / 255.0, made[1][i] = decoded(i / 255.0);
    return made;
  }();
  return tables[srgb];
}

bool has_levels(Filter f) { return f != Filter::nearest && f != Filter::linear; }

bool linear_within_level(Filter f) {
  return f == Filter::linear || f == Filter::linear_mipmap_nearest || f == Filter::linear_mipmap_linear;
}

bool nearest_level(Filter f) {
  return f == Filter::nearest_mipmap_nearest || f == Filter::linear_mipmap_nearest;
}

int wrapped(double i, int size, Wrap wrap) {
  if (wrap == Wrap::clamp) return int(std::clamp(i, 0.0, size - 1.0));
  const double period = wrap == Wrap::repeat ? size : 2.0 * size, in = i - std::floor(i / period) * period;
  return in < size ? int(in) : int(2 * size - 1 - in);
}

}  // namespace

TextureSampler::TextureSampler(const Bitmap& bitmap, const Texture& texture)
    : bitmap_(bitmap), texture_(texture) {
  columns_.sizes = {bitmap.width}, rows_.sizes = {bitmap.height};
  while (has_levels(texture.min_filter) && std::max(columns_.sizes.back(), rows_.sizes.back()) > 1) {
    for (Side* side : {&columns_, &rows_}) side->sizes.push_back(std::max(side->sizes.back() / 2, 1));
  }
  for (Side* side : {&columns_, &rows_}) side->shares.resize(side->sizes.size());
}

// The average of a rectangle is that of its columns and of its rows, one after the other.
const TextureSampler::Share& TextureSampler::Side::share(int level, int texel) {
  std::vector<Share>& made = shares[level];
  if (made.empty() && level == 0) {
    for (int i = 0; i < sizes[0]; ++i) made.push_back({i, {1}});
  } else if (made.empty()) {
    const double covered = double(sizes[level - 1]) / sizes[level];  // texels of the level before
    for (int i = 0; i < sizes[level]; ++i) {
      const double begin = i * covered, end = begin + covered;
      Share sum{share(level - 1, int(begin)).first, {}};
      for (int k = int(begin); k < sizes[level - 1] && k < end; ++k) {
        const double weight = (std::min(end, k + 1.0) - std::max(begin, double(k))) / covered;
        const Share& part = share(level - 1, k);
        const size_t offset = size_t(part.first - sum.first);
        sum.of_texel.resize(std::max(sum.of_texel.size(), offset + part.of_texel.size()));
        for (size_t j = 0; j < part.of_texel.size(); ++j)
          sum.of_texel[offset + j] += weight * part.of_texel[j];
      }
      made.push_back(std::move(sum));
    }
  }
  return made[texel];
}

dvec4 TextureSampler::stored(int x, int y) const {
  const uint8_t* bytes = &bitmap_.rgba[4 * (size_t(y) * bitmap_.width + x)];
  const auto& color = values_of_bytes(texture_.srgb);
  return {color[bytes[0]], color[bytes[1]], color[bytes[2]], bytes[3] / 255.0};
}

dvec4 TextureSampler::texel(int level, double x, double y) {
  const int column = wrapped(x, columns_.sizes[level], texture_.wrap_u),
            row = wrapped(y, rows_.sizes[level], texture_.wrap_v);
  if (level == 0) return stored(column, row);
  const uint64_t key = uint64_t(level) << 58 | uint64_t(row) << 29 | uint64_t(column);
  const auto [found, added] = averages_.try_emplace(key, dvec4(0));
  if (!added) return found->second;
  const Share &across = columns_.share(level, column), &down = rows_.share(level, row);
  dvec4 sum(0);
  for (size_t j = 0; j < down.of_texel.size(); ++j) {
    dvec4 of_row(0);
    for (size_t i = 0; i < across.of_texel.size(); ++i)
      of_row += across.of_texel[i] * stored(across.first + int(i), down.first + int(j));
    sum += down.of_texel[j] * of_row;
  }
  return found->second = sum;
}

dvec4 TextureSampler::filtered(int level, const dvec2& uv, bool linear) {
  const dvec2 at = uv * dvec2(columns_.sizes[level], rows_.sizes[level]);
  if (!linear) return texel(level, std::floor(at.x), std::floor(at.y));
  const dvec2 first = glm::floor(at - 0.5), t = at - 0.5 - first;
  const auto mixed_row = [&](double y) {
    return glm::mix(texel(level, first.x, y), texel(level, first.x + 1, y), t.x);
  };
  return glm::mix(mixed_row(first.y), mixed_row(first.y + 1), t.y);
}

dvec4 TextureSampler::at(const dvec2& uv, const dvec2& right, const dvec2& up) {
  const dvec2 size(bitmap_.width, bitmap_.height);
  const double detail = std::log2(std::max(glm::length(right * size), glm::length(up * size))),
               last = double(columns_.sizes.size() - 1);
  const Filter filter = texture_.min_filter;
  if (!(detail > 0)) return filtered(0, uv, texture_.mag_linear);
  const bool linear = linear_within_level(filter);
  if (!has_levels(filter)) return filtered(0, uv, linear);
  if (nearest_level(filter)) return filtered(int(std::min(std::floor(detail + 0.5), last)), uv, linear);
  const double level = std::min(detail, last), fine = std::floor(level);
  return glm::mix(filtered(int(fine), uv, linear), filtered(int(std::min(fine + 1, last)), uv, linear),
                  level - fine);
}

}  // namespace lightgrid
