#include "passes/common/group_numbers.h"

#include <algorithm>

#include "base/error.h"
#include "plan/settings/groups.h"
#include "plan/settings/surfaces.h"
#include "scene/light_groups.h"

namespace lightgrid {

const GroupNumberFormat& group_number_format(const Settings& settings) {
  return *std::ranges::find(group_number_formats, settings[setting::group_bits], &GroupNumberFormat::bits);
}

bool has_group_numbers(const FramePlan& plan) { return plan.groups.needed && plan.groups.stencil_bits == 0; }

size_t group_number_bytes(const FramePlan& plan) {
  return has_group_numbers(plan) ? group_number_format(plan.settings).bytes : 0;
}

namespace {

void require_numbers_of(const Seen& seen) {
  const int bits = seen.plan.settings[setting::group_bits];
  if (seen.plan.groups.masks.size() <= size_t(1) << bits) return;
  throw input_error(
      "scene \"{}\": instances have {} different masks of light groups; group-ids={} numbers {}: use {}",
      seen.scene.name, seen.plan.groups.masks.size(), bits, size_t(1) << bits,
      bits == 8 ? "group-ids=16" : "forward techniques or visibility, which take any number");
}

}  // namespace

GLuint group_number_image(Work& work) {
  if (!has_group_numbers(work.plan)) return 0;
  require_numbers_of(work);
  const GroupNumberFormat& format = group_number_format(work.plan.settings);
  const GLuint texture = work.targets.texture(format.name, format.format, TargetUse::gbuffer);
  if (work.grid().samples > 1) return texture;  // which has no filter
  // A texture of integers that interpolates is incomplete, and reads as 0.
  glTextureParameteri(texture, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTextureParameteri(texture, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  return texture;
}

SharedBuffer* group_numbers_in_cl(Work& work, TargetUse use) {
  if (!has_group_numbers(work.plan)) return nullptr;
  require_numbers_of(work);
  return &work.shared_samples("group numbers", group_number_format(work.plan.settings).bytes, use);
}

SharedBuffer& group_numbers_to_cl(Work& work, GLuint framebuffer, int attachment, GLuint texture) {
  const size_t bytes = work.grid().values() * group_number_bytes(work.plan);
  auto pass = work.timer.pass("group_numbers_to_cl", "gl");
  SharedBuffer& copy = *group_numbers_in_cl(work, TargetUse::image);
  work.renderer.pixel_copies.to_buffer({framebuffer, GL_COLOR_ATTACHMENT0 + GLenum(attachment), texture},
                                       GL_RED_INTEGER, group_number_format(work.plan.settings).type,
                                       work.grid(), copy.gl_buffer());
  copy.hand_to_cl(bytes);
  pass.moves(bytes, bytes);
  return copy;
}

ClArguments group_number_arguments(const FramePlan& plan, SharedBuffer* numbers) {
  if (!numbers) return {};
  return {{"group_numbers", numbers->cl_buffer()}, {"last_group", cl_uint(plan.groups.masks.size() - 1)}};
}

std::string group_number_define(const FramePlan& plan) {
  return has_group_numbers(plan) ? fmt::format(" -DGROUP_BITS={}", plan.settings[setting::group_bits]) : "";
}

namespace {

// Who has one group: lights, then masks of instances.
struct Members {
  std::vector<bool> lights, masks;
};

bool is_part_of(const std::vector<bool>& part, const std::vector<bool>& whole) {
  for (size_t i = 0; i < part.size(); ++i)
    if (part[i] && !whole[i]) return false;
  return true;
}

bool some(const std::vector<bool>& of) { return std::ranges::find(of, true) != of.end(); }

}  // namespace

StencilGroups stencil_groups(const Seen& seen) {
  const FramePlan& plan = seen.plan;
  std::vector<Members> groups;
  for (int group = 0; group < most_groups; ++group) {
    Members m;
    for (const int light : plan.lights.local)
      m.lights.push_back(seen.scene.lights[size_t(light)].groups >> group & 1);
    for (const uint32_t mask : plan.groups.masks) m.masks.push_back(mask >> group & 1);
    // A group whose pairs another one has too decides nothing.
    const auto covers = [&](const Members& other) {
      return is_part_of(m.lights, other.lights) && is_part_of(m.masks, other.masks);
    };
    if (!some(m.lights) || !some(m.masks) || std::ranges::any_of(groups, covers)) continue;
    std::erase_if(groups, [&](const Members& other) {
      return is_part_of(other.lights, m.lights) && is_part_of(other.masks, m.masks);
    });
    groups.push_back(std::move(m));
  }
  StencilGroups out{std::vector<uint8_t>(plan.lights.local.size()),
                    std::vector<uint8_t>(plan.groups.masks.size()), int(groups.size())};
  if (out.bits > plan.groups.stencil_bits)
    throw input_error(
        "scene \"{}\": its light groups need {} bits of a stencil, and group-stencil={} has {}: use {}",
        seen.scene.name, out.bits, plan.settings[setting::group_stencil], plan.groups.stencil_bits,
        out.bits <= most_stencil_groups(plan.settings[setting::volume_culling])
            ? fmt::format("group-stencil={}", out.bits <= 6 ? 6 : 8)
            : "group-stencil=off");
  for (size_t g = 0; g < groups.size(); ++g) {
    for (size_t i = 0; i < out.of_light.size(); ++i) out.of_light[i] |= uint8_t(groups[g].lights[i] << g);
    for (size_t i = 0; i < out.of_mask.size(); ++i) out.of_mask[i] |= uint8_t(groups[g].masks[i] << g);
  }
  return out;
}

}  // namespace lightgrid
