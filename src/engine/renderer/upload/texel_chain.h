// Mip chains in plain memory, for kernels that filter textures themselves.
//
// Each level lies row by row with one more column and one more row than it has texels: what follows the last
// texel by the texture's wrap mode. The 2 x 2 texels of a bilinear filter are then two loads, whatever the
// place. A texel has 4 or 8 channels of 16 bits, linear: colours are decoded from sRGB before they are
// averaged. A level is the average of the one above it, weighted by area where a side is odd (Guthe,
// Heckbert, "Non-Power-of-Two Mipmapping", NVIDIA 2005), and rounded.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "scene/scene.h"
#include "shared/surface_records.h"

namespace lightgrid {

// `channels` numbers a texel, row 0 first, without the added column and row.
struct TexelImage {
  int width = 0, height = 0, channels = 0;
  std::vector<uint16_t> values;
};

// RGBA; with `srgb`, the first three decoded.
TexelImage linear_texels(const Bitmap& bitmap, bool srgb);

// Half the size, rounded down, but 1 at least.
TexelImage next_level(const TexelImage& image);

// The chain of `image` and, with `mips`, of all smaller ones, as it lies in memory.
struct TexelChain {
  uint32_t width = 0, height = 0, last_level = 0;
  std::array<uint32_t, MAP_LEVELS> level_first{};  // texels
  std::vector<uint16_t> values;
};
TexelChain make_chain(TexelImage image, Wrap wrap_u, Wrap wrap_v, bool mips);

// The fourth channel of a chain in 8 bits. Each texel has those of the 2 x 2 texels that a filter there
// takes: x, x + 1, and the same of the next row, from the lowest byte on.
std::vector<uint32_t> alpha_quads(const TexelChain& chain);

}  // namespace lightgrid
