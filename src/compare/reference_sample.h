// The brute-force image at a sample of pixels, for views at which all of them would take too long.
#pragma once

#include <cstdint>
#include <vector>

#include "passes/passes.h"

namespace lightgrid {

// A square of up to 4 x 4 pixels, cut off at the image's right and upper edge: what a rasteriser shades at once.
struct PixelBlock {
  static constexpr int side = 4;
  int x = 0, y = 0;  // of its first pixel, row 0 at the bottom
};

// All blocks of an image in an order that depends on the seed alone: any first part of it is a sample.
std::vector<PixelBlock> shuffled_blocks(int width, int height, uint64_t seed);

// Their pixels (y * width + x), ascending.
std::vector<uint32_t> pixels_of(const std::vector<PixelBlock>& blocks, int width, int height);

// Renders `forward` into `image` where the blocks are; other pixels hold the background. The frame's depth image is whole
// afterwards.
void render_forward_at(RenderView& v, const std::vector<PixelBlock>& blocks, Image& image);

// So few pairs of a pixel and a light (16,000 a millisecond) that no machine takes that long for a frame.
bool is_quick_for_forward(const View& view, size_t lights, double most_ms);

// Milliseconds that a whole frame of `forward` would take, from ever more blocks of the view until they take a quarter of
// a second.
double estimate_forward_ms(RenderView& v, const std::vector<PixelBlock>& shuffled);

// How many pixels the sample has: four thousand million pairs of a pixel and a light, but 256 to 65,536 pixels.
size_t sample_size(size_t lights);

}  // namespace lightgrid
