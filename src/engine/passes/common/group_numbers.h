// Light groups for light passes over pixels, which do not know the instance there (scene/light_groups.h). Two
// ways of Stone, "The Dark Side of Deferred Shading: Light Groups" (2009): an image beside the surfaces' has
// the number of each pixel's mask (GroupPlan::masks), which a table leads to the mask; or the stencil
// has a few groups, and the hardware tests them.
#pragma once

#include "passes/common/frame.h"

namespace lightgrid {

// A value of the setting group-ids.
struct GroupNumberFormat {
  int bits;
  const char* name;     // name of the target, counted as memory_bytes.gbuffer
  GLenum format, type;  // format of the texture, one unsigned channel; type of glReadPixels
  size_t bytes;         // a pixel
};

inline constexpr GroupNumberFormat group_number_formats[] = {
    {8, "group_numbers_8", GL_R8UI, GL_UNSIGNED_BYTE, 1},
    {16, "group_numbers_16", GL_R16UI, GL_UNSIGNED_SHORT, 2},
};

const GroupNumberFormat& group_number_format(const Settings& settings);

// Returns whether there is an image of numbers: groups are required, and not by the stencil.
bool has_group_numbers(const FramePlan& plan);
// Its bytes a pixel, or 0.
size_t group_number_bytes(const FramePlan& plan);

// The view's image, drawn or not; 0: there is none. Throws Error(input) where the scene has more masks than
// numbers of these bits.
GLuint group_number_image(Work& work);
// The same as bytes in OpenCL's memory, row 0 at the bottom; null: there is none.
SharedBuffer* group_numbers_in_cl(Work& work, TargetUse use);
// Copies the image, which is this attachment of a framebuffer, into that memory.
SharedBuffer& group_numbers_to_cl(Work& work, GLuint framebuffer, int attachment, GLuint texture);

// GROUP_NUMBER_ARGUMENTS of kernels/resolve/group_numbers.h, and the define of its numbers.
ClArguments group_number_arguments(const FramePlan& plan, SharedBuffer* numbers);
std::string group_number_define(const FramePlan& plan);

// Groups as bits of a stencil. Groups that decide alike share a bit, and those that decide nothing have none.
struct StencilGroups {
  std::vector<uint8_t> of_light;  // by index into LightPlan::local
  std::vector<uint8_t> of_mask;   // by index into GroupPlan::masks
  int bits = 0;                   // that are needed
};
// Throws Error(input) where they need more bits than the plan has.
StencilGroups stencil_groups(const Seen& seen);

}  // namespace lightgrid
