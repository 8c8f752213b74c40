// Does blending keep light indices whole? Vendors round differently, and a bit lost is another light.
#pragma once

#include <functional>

#include "renderer/render_view.h"
#include "passes/light_index/layout.h"

namespace lightgrid {

// 256 x 256 pixels: enough for each pair of channel values.
inline constexpr int probe_size = 256;

// Draws into cleared images of the layout, one round after another, an index a pixel (0: what no light draws, but that moves
// the others on); round r goes to the channels of group r / slots. Returns read_channels().
using LightIndexBlender =
    std::function<std::vector<uint16_t>(const LightIndexLayout& layout, const std::vector<std::vector<uint32_t>>& rounds)>;

// Every history that a channel can have, or each index, through `blend`; empty where all come out as they went in, else
// what came out of the first that does not.
std::string why_blending_fails(const LightIndexLayout& layout, const LightIndexBlender& blend);

// With this machine's blending. Each layout is tried once a process. Throws Error(machine).
void require_exact_blending(RenderView& v, const LightIndexLayout& layout);

}  // namespace lightgrid
