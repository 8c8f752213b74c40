// OpenGL's state while light indices are drawn, shared by the passes and the blending probe.
#pragma once

#include "passes/light_index/layout.h"

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

}  // namespace lightgrid
