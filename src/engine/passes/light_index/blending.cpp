#include "passes/light_index/blending.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>

#include "base/error.h"
#include "passes/light_index/lidr_settings.h"
#include "shared/light_index.h"

namespace lightgrid {

void begin_light_indices(const LightIndexLayout& layout) {
  glDisable(GL_DITHER);
  glDisable(GL_FRAMEBUFFER_SRGB);
  glDisable(GL_BLEND);
  if (layout.slots == 1) return;  // a single slot has nothing to shift
  glEnable(GL_BLEND);
  if (layout.maxblended()) {
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

namespace {

constexpr size_t pixels = size_t(probe_size) * probe_size;

// Fills all slots of a group of 8-bit channels; a channel's final byte encodes everything drawn into it. Over
// the pixels each channel ends as each possible byte.
std::vector<uint32_t> shifted_indices(const LightIndexLayout& layout, uint32_t round) {
  const uint32_t slot = layout.slots - 1 - round % layout.slots;
  std::vector<uint32_t> indices(pixels, 0);
  for (uint32_t p = 0; p < pixels; ++p) {
    for (uint32_t c = 0; c < layout.channels; ++c) {
      const uint32_t byte = ((c % 2 ? p >> 8 : p) ^ (37 * c + 101 * (round / layout.slots))) & 255;
      indices[p] |= light_index_in_word(byte, slot, layout.shift) << layout.shift * c;
    }
  }
  return indices;
}

// Each pair of indices or, for 16-bit channels, each index with another. Never index 0.
std::vector<uint32_t> paired_indices(const LightIndexLayout& layout, uint32_t round) {
  std::vector<uint32_t> indices(pixels);
  for (uint32_t p = 0; p < pixels; ++p) {
    if (layout.channel_bits == 8) {
      indices[p] = (round % 2 ? p >> 8 : p) & 255;
    } else {
      indices[p] = (round % 2 ? p * 40503 : p) & 65535;
    }
    indices[p] = std::max(indices[p], 1u);
  }
  return indices;
}

std::vector<uint32_t> all_indices(const LightIndexLayout& layout, uint32_t round) {
  std::vector<uint32_t> indices(pixels);
  for (uint32_t p = 0; p < pixels; ++p) indices[p] = (p + 31 * round) & ((1u << 8 * layout.channels) - 1);
  return indices;
}

std::vector<std::vector<uint32_t>> rounds_of(const LightIndexLayout& layout) {
  std::vector<std::vector<uint32_t>> rounds;
  for (uint32_t round = 0; round < layout.overlap; ++round) {
    rounds.push_back(layout.packing == LidrPacking::bitshift ? shifted_indices(layout, round)
                     : layout.maxblended()                   ? paired_indices(layout, round)
                                                             : all_indices(layout, round));
  }
  return rounds;
}

// Expected result of unpacking: lights in the order drawn or, for two at once, the lower first, without
// repeats.
std::vector<uint32_t> lights_drawn(const LightIndexLayout& layout,
                                   const std::vector<std::vector<uint32_t>>& rounds, size_t pixel) {
  std::vector<uint32_t> lights;
  for (uint32_t first = 0; first < layout.overlap; first += layout.slots) {
    std::vector<uint32_t> group;
    for (uint32_t r = first; r < first + layout.slots; ++r) {
      if (rounds[r][pixel] != 0) group.push_back(rounds[r][pixel] - 1);
    }
    if (layout.maxblended()) {
      std::sort(group.begin(), group.end());
      group.erase(std::unique(group.begin(), group.end()), group.end());
    }
    lights.insert(lights.end(), group.begin(), group.end());
  }
  return lights;
}

// Integer textures allow no linear filter, even unused.
GlTexture index_image() {
  GlTexture image = make_texture_2d(GL_R32UI, probe_size, probe_size);
  glTextureParameteri(image.name(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTextureParameteri(image.name(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  return image;
}

std::vector<uint16_t> blend_in_opengl(PassContext& work, const LightIndexLayout& layout,
                                      const std::vector<std::vector<uint32_t>>& rounds) {
  std::vector<GlTexture> images;
  std::vector<GLuint> names;
  for (uint32_t i = 0; i < layout.targets(); ++i) {
    images.push_back(make_texture_2d(layout.format(), probe_size, probe_size));
    names.push_back(images.back().name());
  }
  const GlFramebuffer framebuffer = make_framebuffer(names, 0);
  const GlTexture indices = index_image();
  const GlVertexArray nothing = make_vertex_array();
  const float none[4] = {};
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
  glViewport(0, 0, probe_size, probe_size);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_STENCIL_TEST);
  glDisable(GL_CULL_FACE);
  for (uint32_t i = 0; i < layout.targets(); ++i)
    glClearNamedFramebufferfv(framebuffer.name(), GL_COLOR, GLint(i), none);
  begin_light_indices(layout);
  glUseProgram(
      work.program("shaders/screen.vert", "shaders/light_index_probe.frag", layout.defines()).name());
  glBindVertexArray(nothing.name());
  bind_texture(Sampler::indices, indices.name());
  for (size_t r = 0; r < rounds.size(); ++r) {
    glTextureSubImage2D(indices.name(), 0, 0, 0, probe_size, probe_size, GL_RED_INTEGER, GL_UNSIGNED_INT,
                        rounds[r].data());
    write_group(layout, uint32_t(r) / layout.slots);
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }
  end_light_indices();
  glBindVertexArray(0);
  return read_channels(layout, {probe_size, probe_size});
}

}  // namespace

std::string why_blending_fails(const LightIndexLayout& layout, const LightIndexBlender& blend) {
  const auto rounds = rounds_of(layout);
  const std::vector<uint16_t> channels = blend(layout, rounds);
  LightIndexLayout whole = layout;  // entries are compared with their shares
  whole.share_bits = 0;
  const size_t stride = layout.targets() * 4;
  std::vector<uint32_t> unpacked, expected;
  std::string first;
  size_t failed = 0;
  for (size_t p = 0; p < pixels; ++p) {
    unpack_light_index(whole, {&channels[p * stride], stride}, false, unpacked);
    expected = lights_drawn(layout, rounds, p);
    if (unpacked == expected) continue;
    if (failed++ == 0)
      first = fmt::format("lights {} become {}", fmt::join(expected, " "), fmt::join(unpacked, " "));
  }
  return failed ? fmt::format("{}, and so {} of {} states", first, failed, pixels) : "";
}

void require_exact_blending(PassContext& work, const LightIndexLayout& layout) {
  static std::map<std::string, std::string> tried;
  const GlContext& gl = *work.renderer.gl;
  const auto [found, added] = tried.try_emplace(gl.renderer + gl.version + layout.name());
  if (added) {
    found->second = why_blending_fails(
        layout, [&](const LightIndexLayout& l, const std::vector<std::vector<uint32_t>>& rounds) {
          return blend_in_opengl(work, l, rounds);
        });
  }
  if (!found->second.empty()) {
    throw machine_error(
        "lidr: blending of \"{}\" does not keep light indices ({}): {}; lidr-packing=sort needs no blending",
        gl.renderer, layout.name(), found->second);
  }
}

}  // namespace lightgrid
