// Blending that adds light indices to images: its state, and a test that it preserves them. Vendors round
// differently, and one wrong bit names another light.
#pragma once

#include <functional>

#include "passes/light_index/layout.h"
#include "renderer/pass_context.h"

namespace lightgrid {

inline constexpr uint32_t no_channels = 0xffffffffu, all_channels = 0xfffffffeu;

// Blending that adds an index to the earlier ones. Turns off dithering and sRGB encoding, which would change
// stored numbers.
void begin_light_indices(const LightIndexLayout& layout);
// Restricts writing to one group's channels, to no_channels or to all_channels.
void write_group(const LightIndexLayout& layout, uint32_t group);
void end_light_indices();

// Input of unpack_light_index for each pixel: targets() * 4 values, row 0 at the bottom. Reads the
// framebuffer that is bound for reading.
std::vector<uint16_t> read_channels(const LightIndexLayout& layout, const PixelGrid& grid);

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
void require_exact_blending(PassContext& work, const LightIndexLayout& layout);

}  // namespace lightgrid
