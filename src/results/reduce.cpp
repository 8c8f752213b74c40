#include "results/reduce.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lightgrid {
namespace {

// Calls visit(block, pixel) for each pixel, block by block.
template <typename Visit>
void for_each_pixel(int width, int height, int factor, const Visit& visit) {
  const int across = blocks_along(width, factor);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      visit(size_t(y / factor) * across + x / factor, size_t(y) * width + x);
    }
  }
}

double distance(const glm::vec4& a, const glm::vec4& b) {
  double largest = 0;
  for (int c = 0; c < 3; ++c) {
    const double d = std::abs(double(a[c]) - double(b[c]));
    if (std::isnan(d) && a[c] != b[c]) return std::numeric_limits<double>::infinity();
    if (!std::isnan(d)) largest = std::max(largest, d);
  }
  return largest;
}

}  // namespace

Image mean_of_blocks(const Image& image, int factor) {
  Image result(blocks_along(image.width, factor), blocks_along(image.height, factor));
  std::vector<float> count(result.pixels.size(), 0);
  for_each_pixel(image.width, image.height, factor, [&](size_t block, size_t pixel) {
    result.pixels[block] += image.pixels[pixel];
    count[block] += 1;
  });
  for (size_t i = 0; i < count.size(); ++i) result.pixels[i] /= count[i];
  return result;
}

std::vector<uint32_t> largest_of_blocks(const std::vector<uint32_t>& counts, int width, int height,
                                        int factor) {
  std::vector<uint32_t> result(size_t(blocks_along(width, factor)) * blocks_along(height, factor), 0);
  for_each_pixel(width, height, factor,
                 [&](size_t block, size_t pixel) { result[block] = std::max(result[block], counts[pixel]); });
  return result;
}

Image worst_of_blocks(const Image& picture, const Image& image, const Image& reference, int factor) {
  Image result(blocks_along(image.width, factor), blocks_along(image.height, factor));
  std::vector<double> worst(result.pixels.size(), -1);
  for_each_pixel(image.width, image.height, factor, [&](size_t block, size_t pixel) {
    const double d = distance(image.pixels[pixel], reference.pixels[pixel]);
    if (d > worst[block]) worst[block] = d, result.pixels[block] = picture.pixels[pixel];
  });
  return result;
}

}  // namespace lightgrid
