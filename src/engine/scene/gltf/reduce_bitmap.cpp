#include "scene/gltf/reduce_bitmap.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/image.h"

namespace lightgrid::gltf {
namespace {

// The pixels of a row or column that one smaller pixel covers, the first and last of them in part.
struct Cover {
  int first = 0;
  std::vector<double> weights;  // they add up to 1
};

std::vector<Cover> covers(int from, int to) {
  std::vector<Cover> all;
  const double scale = double(from) / to;
  for (int i = 0; i < to; ++i) {
    const double begin = i * scale, end = std::min<double>(from, begin + scale);
    Cover& cover = all.emplace_back(Cover{std::min(int(begin), from - 1), {}});
    for (int k = cover.first; k < from && k < end - 1e-9; ++k)
      cover.weights.push_back((std::min(end, k + 1.0) - std::max(begin, double(k))) / scale);
  }
  return all;
}

double value_of(uint8_t byte, bool color) {
  static const auto linear = [] {
    std::array<double, 256> values{};
    for (int i = 0; i < 256; ++i) values[size_t(i)] = 255.0 * double(linear_from_srgb(float(i) / 255));
    return values;
  }();
  return color ? linear[byte] : double(byte);
}

uint8_t byte_of(double value, bool color) {
  return uint8_t(
      std::clamp(std::lround(color ? 255 * double(srgb_from_linear(float(value / 255))) : value), 0l, 255l));
}

}  // namespace

BitmapSize reduced_size(int width, int height, int side) {
  const int largest = std::max(width, height);
  if (largest <= side) return {width, height};
  const auto scaled = [&](int length) {
    return std::max(1, int(std::lround(double(length) * side / largest)));
  };
  return {scaled(width), scaled(height)};
}

Bitmap reduced(Bitmap bitmap, int side, bool colors) {
  const BitmapSize size = reduced_size(bitmap.width, bitmap.height, side);
  if (size.width == bitmap.width && size.height == bitmap.height) return bitmap;
  Bitmap out{.name = std::move(bitmap.name), .width = size.width, .height = size.height};
  out.rgba.reserve(size_t(size.width) * size_t(size.height) * 4);
  const std::vector<Cover> columns = covers(bitmap.width, size.width);
  for (const Cover& row : covers(bitmap.height, size.height)) {
    for (const Cover& column : columns) {
      std::array<double, 4> sums{};
      for (size_t j = 0; j < row.weights.size(); ++j) {
        const size_t line = size_t(row.first) + j;
        const uint8_t* from = &bitmap.rgba[(line * size_t(bitmap.width) + size_t(column.first)) * 4];
        for (const double weight : column.weights)
          for (size_t c = 0; c < 4; ++c)
            sums[c] += row.weights[j] * weight * value_of(*from++, colors && c < 3);
      }
      for (size_t c = 0; c < 4; ++c) out.rgba.push_back(byte_of(sums[c], colors && c < 3));
    }
  }
  return out;
}

}  // namespace lightgrid::gltf
