#include "compare/reference_sample.h"

#include <algorithm>

#include "base/timer.h"
#include "scene/random.h"

namespace lightgrid::lab {
std::vector<PixelBlock> shuffled_blocks(const PixelGrid& grid, uint64_t seed) {
  std::vector<PixelBlock> blocks;
  for (int y = 0; y < grid.height; y += PixelBlock::side) {
    for (int x = 0; x < grid.width; x += PixelBlock::side) blocks.push_back({x, y});
  }
  Random random(seed);
  for (size_t i = blocks.size(); i > 1; --i) std::swap(blocks[i - 1], blocks[size_t(random.next() % i)]);
  return blocks;
}

std::vector<uint32_t> pixels_of(const std::vector<PixelBlock>& blocks, const PixelGrid& grid) {
  std::vector<uint32_t> pixels;
  for (const PixelBlock& block : blocks) {
    for (int y = block.y; y < std::min(block.y + PixelBlock::side, grid.height); ++y) {
      for (int x = block.x; x < std::min(block.x + PixelBlock::side, grid.width); ++x)
        pixels.push_back(uint32_t(grid.index(x, y)));
    }
  }
  std::sort(pixels.begin(), pixels.end());
  return pixels;
}

void render_forward_at(RenderView& v, const std::vector<PixelBlock>& blocks, Image& image) {
  draw_forward_at(v, pixels_of(blocks, v.grid()), image);
}

bool is_quick_for_forward(const View& view, size_t lights, double max_ms) {
  return double(view.grid().values()) * double(lights) < 16e3 * max_ms;
}

double estimate_forward_ms(RenderView& v, const std::vector<PixelBlock>& shuffled) {
  Image image;
  const auto time_of = [&](size_t count) {
    const Timer timer;
    render_forward_at(v, {shuffled.begin(), shuffled.begin() + std::ptrdiff_t(count)}, image);
    return timer.elapsed_ms();
  };
  const double without_pixels = (time_of(0), time_of(0));  // the first call builds programs
  for (size_t count = 8;; count = std::min(8 * count, shuffled.size())) {
    const double ms = std::max(time_of(count) - without_pixels, 0.0);
    if (ms >= 250 || count == shuffled.size())
      return without_pixels + ms * double(shuffled.size()) / double(count);
  }
}

size_t sample_size(size_t lights) {
  return std::clamp<size_t>(size_t(4e9) / std::max<size_t>(lights, 1), 256, 65536);
}

}  // namespace lightgrid::lab
