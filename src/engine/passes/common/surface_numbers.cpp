#include "passes/common/surface_numbers.h"

#include <algorithm>

#include "base/error.h"
#include "plan/settings/masks.h"
#include "plan/settings/surfaces.h"
#include "scene/effect_terms.h"

namespace lightgrid {

const SurfaceNumberFormat& surface_number_format(const Settings& settings) {
  return *std::ranges::find(surface_number_formats, settings[setting::number_bits],
                            &SurfaceNumberFormat::bits);
}

bool has_surface_numbers(const FramePlan& plan) { return plan.masks.needed && plan.masks.stencil_bits == 0; }

size_t surface_number_bytes(const FramePlan& plan) {
  return has_surface_numbers(plan) ? surface_number_format(plan.settings).bytes : 0;
}

namespace {

// The name of the effect that has masks.
std::string words_of_masks(const FramePlan& plan) {
  const auto effect = std::ranges::find_if(plan.effects, [](const Effect* e) { return has_masks(*e); });
  return effect == plan.effects.end() ? "masks" : words_of(**effect);
}

void require_numbers_of(const ViewState& seen) {
  const int bits = seen.plan.settings[setting::number_bits];
  if (seen.plan.masks.values.size() <= size_t(1) << bits) return;
  const std::string key = setting::number_bits_key;
  throw input_error("scene \"{}\": instances have {} different masks of {}; {}={} numbers {}: use {}",
                    seen.scene.name, seen.plan.masks.values.size(), words_of_masks(seen.plan), key, bits,
                    size_t(1) << bits,
                    bits == 8 ? key + "=16" : "forward techniques or visibility, which take any number");
}

}  // namespace

GLuint surface_number_image(PassContext& work) {
  if (!has_surface_numbers(work.plan)) return 0;
  require_numbers_of(work);
  const SurfaceNumberFormat& format = surface_number_format(work.plan.settings);
  const GLuint texture = work.targets.texture(format.name, format.format, TargetUse::gbuffer);
  if (work.grid().samples > 1) return texture;  // which has no filter
  // A texture of integers that interpolates is incomplete, and reads as 0.
  glTextureParameteri(texture, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTextureParameteri(texture, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  return texture;
}

SharedBuffer* surface_numbers_in_cl(PassContext& work, TargetUse use) {
  if (!has_surface_numbers(work.plan)) return nullptr;
  require_numbers_of(work);
  return &work.shared_samples("surface numbers", surface_number_format(work.plan.settings).bytes, use);
}

SharedBuffer& surface_numbers_to_cl(PassContext& work, GLuint framebuffer, int attachment, GLuint texture) {
  const size_t bytes = work.grid().values() * surface_number_bytes(work.plan);
  auto pass = work.timer.pass("group_numbers_to_cl", "gl");
  SharedBuffer& copy = *surface_numbers_in_cl(work, TargetUse::image);
  work.renderer.pixel_copies.to_buffer({framebuffer, GL_COLOR_ATTACHMENT0 + GLenum(attachment), texture},
                                       GL_RED_INTEGER, surface_number_format(work.plan.settings).type,
                                       work.grid(), copy.gl_buffer());
  copy.hand_to_cl(bytes);
  pass.moves(bytes, bytes);
  return copy;
}

ClArguments surface_number_arguments(const FramePlan& plan, SharedBuffer* numbers) {
  if (!numbers) return {};
  return {{"surface_numbers", numbers->cl_buffer()}, {"last_number", cl_uint(plan.masks.values.size() - 1)}};
}

std::string surface_number_define(const FramePlan& plan) {
  return has_surface_numbers(plan) ? fmt::format(" -DNUMBER_BITS={}", plan.settings[setting::number_bits])
                                   : "";
}

namespace {

// Who has one bit: lights, then surfaces.
struct Members {
  std::vector<bool> lights, surfaces;
};

bool is_part_of(const std::vector<bool>& part, const std::vector<bool>& whole) {
  for (size_t i = 0; i < part.size(); ++i)
    if (part[i] && !whole[i]) return false;
  return true;
}

bool some(const std::vector<bool>& of) { return std::ranges::find(of, true) != of.end(); }

}  // namespace

StencilMasks stencil_masks(const ViewState& seen) {
  const FramePlan& plan = seen.plan;
  std::vector<Members> bits;
  for (int bit = 0; bit < 32; ++bit) {
    Members m;
    for (const int light : plan.lights.local)
      m.lights.push_back(mask_of(seen.scene.lights[size_t(light)]) >> bit & 1);
    for (const uint32_t mask : plan.masks.values) m.surfaces.push_back(mask >> bit & 1);
    // A bit whose pairs another one has too decides nothing.
    const auto covers = [&](const Members& other) {
      return is_part_of(m.lights, other.lights) && is_part_of(m.surfaces, other.surfaces);
    };
    if (!some(m.lights) || !some(m.surfaces) || std::ranges::any_of(bits, covers)) continue;
    std::erase_if(bits, [&](const Members& other) {
      return is_part_of(other.lights, m.lights) && is_part_of(other.surfaces, m.surfaces);
    });
    bits.push_back(std::move(m));
  }
  StencilMasks out{std::vector<uint8_t>(plan.lights.local.size()),
                   std::vector<uint8_t>(plan.masks.values.size()), int(bits.size())};
  const char* key = setting::stencil_masks_key;
  if (out.bits > plan.masks.stencil_bits)
    throw input_error("scene \"{}\": its {} need {} bits of a stencil, and {}={} has {}: use {}={}",
                      seen.scene.name, words_of_masks(plan), out.bits, key,
                      plan.settings[setting::stencil_masks], plan.masks.stencil_bits, key,
                      out.bits > max_stencil_masks(plan.settings[setting::volume_culling]) ? "off"
                      : out.bits <= 6                                                      ? "6"
                                                                                           : "8");
  for (size_t b = 0; b < bits.size(); ++b) {
    for (size_t i = 0; i < out.of_light.size(); ++i) out.of_light[i] |= uint8_t(bits[b].lights[i] << b);
    for (size_t i = 0; i < out.of_surface.size(); ++i) out.of_surface[i] |= uint8_t(bits[b].surfaces[i] << b);
  }
  return out;
}

}  // namespace lightgrid
