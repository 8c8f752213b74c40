#include "renderer/upload/texel_chain.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/image.h"

namespace lightgrid {
namespace {

// A row of `from` texels becomes one of `to` texels. Each of those averages `count` neighbours from `first`
// on, with weights that add up to 1.
struct Taps {
  int first, count;
  double weights[3];
};

Taps taps_of(int texel, int from, int to) {
  if (from == to) return {texel, 1, {1, 0, 0}};
  const double scale = double(from) / to, begin = texel * scale, end = begin + scale;
  Taps taps{int(begin), 0, {}};
  for (int i = taps.first; i < from && i < end - 1e-9; ++i) {
    taps.weights[taps.count++] = (std::min(end, i + 1.0) - std::max(begin, double(i))) / scale;
  }
  return taps;
}

int wrapped(int texel, int size, Wrap wrap) {
  return wrap == Wrap::repeat ? texel % size : std::min(texel, size - 1);
}

void append_level(const TexelImage& image, Wrap wrap_u, Wrap wrap_v, std::vector<uint16_t>& values) {
  for (int y = 0; y <= image.height; ++y) {
    const int row = wrapped(y, image.height, wrap_v);
    for (int x = 0; x <= image.width; ++x) {
      const size_t texel = size_t(row) * image.width + wrapped(x, image.width, wrap_u);
      const auto first = image.values.begin() + std::ptrdiff_t(texel * image.channels);
      values.insert(values.end(), first, first + image.channels);
    }
  }
}

}  // namespace

TexelImage linear_texels(const Bitmap& bitmap, bool srgb) {
  static const auto decoded = [] {
    std::array<uint16_t, 256> values;
    for (int i = 0; i < 256; ++i) values[i] = uint16_t(std::lround(linear_from_srgb(i / 255.0f) * 65535.0f));
    return values;
  }();
  TexelImage image{bitmap.width, bitmap.height, 4, std::vector<uint16_t>(bitmap.rgba.size())};
  for (size_t i = 0; i < bitmap.rgba.size(); ++i) {
    image.values[i] = srgb && i % 4 != 3 ? decoded[bitmap.rgba[i]] : uint16_t(bitmap.rgba[i] * 257);
  }
  return image;
}

TexelImage next_level(const TexelImage& image) {
  TexelImage half{std::max(image.width / 2, 1), std::max(image.height / 2, 1), image.channels, {}};
  half.values.resize(size_t(half.width) * half.height * half.channels);
  std::vector<Taps> columns;
  for (int x = 0; x < half.width; ++x) columns.push_back(taps_of(x, image.width, half.width));
  size_t to = 0;
  for (int y = 0; y < half.height; ++y) {
    const Taps rows = taps_of(y, image.height, half.height);
    for (const Taps& column : columns) {
      double sums[8] = {};
      for (int j = 0; j < rows.count; ++j) {
        for (int i = 0; i < column.count; ++i) {
          const double weight = rows.weights[j] * column.weights[i];
          const size_t texel = size_t(rows.first + j) * image.width + column.first + i;
          for (int c = 0; c < image.channels; ++c)
            sums[c] += weight * image.values[texel * image.channels + c];
        }
      }
      for (int c = 0; c < image.channels; ++c) half.values[to++] = uint16_t(std::lround(sums[c]));
    }
  }
  return half;
}

TexelChain make_chain(TexelImage image, Wrap wrap_u, Wrap wrap_v, bool mips) {
  if (std::max(image.width, image.height) >= 1 << MAP_LEVELS) {
    throw machine_error("a texture of {} x {} texels: the resolve pass takes sides of less than {}",
                        image.width, image.height, 1 << MAP_LEVELS);
  }
  TexelChain chain{uint32_t(image.width), uint32_t(image.height), 0, {}, {}};
  const size_t channels = image.channels;
  append_level(image, wrap_u, wrap_v, chain.values);
  while (mips && std::max(image.width, image.height) > 1) {
    image = next_level(image);
    chain.level_first[++chain.last_level] = uint32_t(chain.values.size() / channels);
    append_level(image, wrap_u, wrap_v, chain.values);
  }
  return chain;
}

std::vector<uint32_t> alpha_quads(const TexelChain& chain) {
  const size_t texels = chain.values.size() / 4;
  std::vector<uint32_t> quads(texels);
  // The last column and row hold what no filter's first texel is.
  const auto alpha = [&](size_t texel) {
    return texel < texels ? (chain.values[4 * texel + 3] * 255u + 32767u) / 65535u : 0u;
  };
  for (uint32_t level = 0; level <= chain.last_level; ++level) {
    const size_t pitch = std::max(chain.width >> level, 1u) + 1,
                 rows = std::max(chain.height >> level, 1u) + 1;
    for (size_t i = 0; i < pitch * rows; ++i) {
      const size_t texel = chain.level_first[level] + i;
      quads[texel] =
          alpha(texel) | alpha(texel + 1) << 8 | alpha(texel + pitch) << 16 | alpha(texel + pitch + 1) << 24;
    }
  }
  return quads;
}

}  // namespace lightgrid
