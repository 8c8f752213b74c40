// Surfaces for light passes over pixels, which have no instance there. Two ways of Stone, "The Dark
// Side of Deferred Shading: Light Groups" (2009): an image next to the surfaces' has the number of each
// pixel's surface (MaskPlan::of_instance), by which the values that effects read of it are found
// (shared/surface_values.h); or the stencil has a few bits of its mask, and the hardware tests them.
#pragma once

#include "passes/common/frame.h"

namespace lightgrid {

// A value of setting::number_bits.
struct SurfaceNumberFormat {
  int bits;
  const char* name;     // name of the target, counted as memory_bytes.gbuffer
  GLenum format, type;  // format of the texture, one unsigned channel; type of glReadPixels
  size_t bytes;         // per pixel
};

inline constexpr SurfaceNumberFormat surface_number_formats[] = {
    {8, "surface_numbers_8", GL_R8UI, GL_UNSIGNED_BYTE, 1},
    {16, "surface_numbers_16", GL_R16UI, GL_UNSIGNED_SHORT, 2},
};

const SurfaceNumberFormat& surface_number_format(const Settings& settings);

// Returns whether there is an image of numbers: an effect has masks, and the stencil does not test them.
bool has_surface_numbers(const FramePlan& plan);
// Bytes per pixel of that image, or 0.
size_t surface_number_bytes(const FramePlan& plan);

// The view's image, drawn or not; 0: there is none. Throws Error(input) where the scene has more masks than
// numbers of these bits.
GLuint surface_number_image(PassContext& work);
// The same as bytes in OpenCL's memory, row 0 at the bottom; null: there is none.
SharedBuffer* surface_numbers_in_cl(PassContext& work, TargetUse use);
// Copies the image, which is this attachment of a framebuffer, into that memory.
SharedBuffer& surface_numbers_to_cl(PassContext& work, GLuint framebuffer, int attachment, GLuint texture);

// SURFACE_NUMBER_ARGUMENTS of kernels/resolve/surface_numbers.h, and the define of its numbers.
ClArguments surface_number_arguments(const FramePlan& plan, SharedBuffer* numbers);
std::string surface_number_define(const FramePlan& plan);

// Masks as bits of a stencil. Bits that decide alike share one, and those that decide nothing have none.
struct StencilMasks {
  std::vector<uint8_t> of_light;    // by index into LightPlan::local
  std::vector<uint8_t> of_surface;  // by number
  int bits = 0;                     // that are needed
};
// Throws Error(input) where they need more bits than the plan has.
StencilMasks stencil_masks(const ViewState& seen);

}  // namespace lightgrid
