// A voxel light buffer of a view: light at the samples of a volume (docs/techniques/voxel_lights.md).
#pragma once

#include "passes/common/frame.h"
#include "passes/voxels/placed_voxels.h"
#include "scene/listed_lights.h"

namespace lightgrid {

// In OpenCL's memory, until the view's next build_voxels(). Values: four a sample, x fastest, of voxel-bits;
// what they are: kernels/voxels/cpu/build_voxels.cl.
struct VoxelVolume {
  SharedBuffer* irradiance = nullptr;
  SharedBuffer* directions = nullptr;
  cl::Buffer lookup;           // VoxelLookup
  std::string kernel_defines;  // of kernels that read it
  size_t bytes = 0;            // of both
};

// The same for OpenGL: two 3D textures, interpolated between samples, and a uniform block.
struct VoxelTextures {
  GLuint irradiance = 0, directions = 0, lookup = 0;
  bool log_depth = false;  // VOXELS_LOG
  size_t bytes = 0;
};

// Places the volume around what is visible, and adds up the lights at its samples. Deterministic: a sample is
// the sum of its lights in an order that depends on the lights alone. `depth`: what the frame shades from, if
// OpenCL made it.
VoxelVolume build_voxels(RenderView& v, const TileDistances& distances, const DepthBuffer& depth = {});
VoxelTextures voxels_to_gl(RenderView& v, const VoxelVolume& volume);

// The last frame's volume on the host, for tests and the oracle.
struct ReadVoxels {
  VoxelAxes axes;
  PlacedVoxels placed;
  std::vector<glm::vec4> irradiance, directions;  // without the scale by which they are stored; x fastest
};
ReadVoxels read_voxels(RenderView& v);

// The lights that each pixel got light of in the last frame: those of any of the eight samples around it.
ListedLights listed_of_voxels(RenderView& v);

}  // namespace lightgrid
