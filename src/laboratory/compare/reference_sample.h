// The brute-force image at a sample of pixels, for views where all pixels would take too long.
#pragma once

#include <cstdint>
#include <vector>

#include "base/image.h"
#include "run/frames.h"

namespace lightgrid::lab {

// A square of up to 4 x 4 pixels, cut off at the image's right and upper edge: rasterisers shade such blocks
// at once.
struct PixelBlock {
  static constexpr int side = 4;
  int x = 0, y = 0;  // its lower left pixel, row 0 at the bottom
};

// All blocks of an image in an order that depends on the seed alone: every prefix is a sample.
std::vector<PixelBlock> shuffled_blocks(const PixelGrid& grid, uint64_t seed);

// The pixels (y * width + x) of the blocks, ascending.
std::vector<uint32_t> pixels_of(const std::vector<PixelBlock>& blocks, const PixelGrid& grid);

// Renders `forward` into `image` inside the blocks; other pixels get the background. The frame's depth image
// is complete afterwards.
void render_forward_at(RenderView& v, const std::vector<PixelBlock>& blocks, Image& image);

// True if there are so few pairs of a pixel and a light (16,000 a millisecond) that every machine is fast
// enough.
bool is_quick_for_forward(const View& view, size_t lights, double max_ms);

// Estimated milliseconds for a whole frame of `forward`, from increasing numbers of blocks until they take a
// quarter of a second.
double estimate_forward_ms(RenderView& v, const std::vector<PixelBlock>& shuffled);

// Number of pixels of the sample: four thousand million pairs of a pixel and a light, but 256 to 65,536
// pixels.
size_t sample_size(size_t lights);

}  // namespace lightgrid::lab
