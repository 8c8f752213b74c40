// OpenGL's state while light indices are drawn: the same for the passes and for what probes the machine.
#pragma once

#include "passes/light_index/layout.h"

namespace lightgrid {

inline constexpr uint32_t no_channels = 0xffffffffu, all_channels = 0xfffffffeu;

// Blending by which an index joins those before it. Dithering and sRGB encoding, which would change stored numbers, are
// off.
void begin_light_indices(const LightIndexLayout& layout);
// One group's channels, no_channels, or all_channels are written.
void write_group(const LightIndexLayout& layout, uint32_t group);
void end_light_indices();

// As unpack_light_index wants a pixel: targets() * 4 values of each, row 0 at the bottom. From the framebuffer that is bound
// for reading.
std::vector<uint16_t> read_channels(const LightIndexLayout& layout, int width, int height);

}  // namespace lightgrid
