#include "passes/light_index/gl_state.h"

namespace lightgrid {

void begin_light_indices(const LightIndexLayout& layout) {
  glDisable(GL_DITHER);
  glDisable(GL_FRAMEBUFFER_SRGB);
  glDisable(GL_BLEND);
  if (layout.slots == 1) return;  // a single slot has nothing to shift
  glEnable(GL_BLEND);
  if (layout.packing == LidrPacking::maxblend) {
    glBlendEquation(GL_MAX);
    return;
  }
  // Existing contents move down by a slot. An extra quarter of a step makes both rounding and truncation give
  // the right number, as the article's 0.251 does for 2 bits.
  const float down = 1.0f / float(1u << layout.shift) + 0.25f / 255;
  glBlendEquation(GL_FUNC_ADD);
  glBlendFunc(GL_ONE, GL_CONSTANT_COLOR);
  glBlendColor(down, down, down, down);
}

void write_group(const LightIndexLayout& layout, uint32_t group) {
  for (uint32_t target = 0; target < layout.targets(); ++target) {
    GLboolean on[4];
    for (uint32_t c = 0; c < 4; ++c)
      on[c] = group == all_channels || (target * 4 + c) / layout.channels == group;
    glColorMaski(target, on[0], on[1], on[2], on[3]);
  }
}

void end_light_indices() {
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDisable(GL_BLEND);
  glBlendEquation(GL_FUNC_ADD);
}

std::vector<uint16_t> read_channels(const LightIndexLayout& layout, const PixelGrid& grid) {
  const size_t pixels = grid.pixels(), stride = layout.targets() * 4;
  std::vector<uint16_t> channels(pixels * stride), image(pixels * 4);
  for (uint32_t target = 0; target < layout.targets(); ++target) {
    glReadBuffer(GL_COLOR_ATTACHMENT0 + target);
    if (layout.channel_bits == 16) {
      glReadPixels(0, 0, grid.width, grid.height, GL_RGBA, GL_UNSIGNED_SHORT, image.data());
    } else {
      std::vector<uint8_t> bytes(pixels * 4);
      glReadPixels(0, 0, grid.width, grid.height, GL_RGBA, GL_UNSIGNED_BYTE, bytes.data());
      image.assign(bytes.begin(), bytes.end());
    }
    for (size_t i = 0; i < pixels; ++i) {
      for (uint32_t c = 0; c < layout.target_channels(); ++c)
        channels[i * stride + target * 4 + c] = image[i * 4 + c];
    }
  }
  glReadBuffer(GL_COLOR_ATTACHMENT0);
  return channels;
}

}  // namespace lightgrid
