// Tests whether blending preserves light indices. Vendors round differently, and one wrong bit names another
// light.
#pragma once

#include <functional>

#include "passes/light_index/layout.h"
#include "renderer/pass_caches.h"

namespace lightgrid {

// 256 x 256 pixels: enough for each pair of channel values.
inline constexpr int probe_size = 256;

// Draws an index a pixel into cleared images of the layout, one round after another (0: no light, but shifts
// the others on); round r writes the channels of group r / slots. Returns read_channels().
using LightIndexBlender = std::function<std::vector<uint16_t>(
    const LightIndexLayout& layout, const std::vector<std::vector<uint32_t>>& rounds)>;

// Sends every possible history of a channel, or each index, through `blend`. Empty if all come out unchanged,
// else a description of the first failure.
std::string why_blending_fails(const LightIndexLayout& layout, const LightIndexBlender& blend);

// Tests this machine's blending, each layout once a process. Throws Error(machine) if it fails.
void require_exact_blending(Work& work, const LightIndexLayout& layout);

}  // namespace lightgrid
