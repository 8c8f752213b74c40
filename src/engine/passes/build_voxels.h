// A voxel light buffer of a view: light at the samples of a volume (docs/techniques/voxel_lights.md).
#pragma once

#include "passes/common/light_source.h"
#include "passes/voxels/voxel_inputs.h"

namespace lightgrid {

// In OpenCL's memory, until the view's next build_voxels(). Values: four a sample, x fastest, of voxel-bits;
// what they are: kernels/voxels/cpu/build_voxels.cl.
struct VoxelVolume {
  SharedBuffer* irradiance = nullptr;
  SharedBuffer* directions = nullptr;
  cl::Buffer lookup;           // VoxelLookup
  std::string kernel_defines;  // defines of kernels that read it
  size_t bytes = 0;            // bytes of both
};

// Places the volume around what is visible, and adds up the lights at its samples. Deterministic: a sample is
// the sum of its lights in an order that depends on the lights alone. `depth`: what the frame shades from, if
// OpenCL made it.
VoxelVolume build_voxels(PassContext& work, Cached<VoxelBuffers>& cache, const TileDistances& distances,
                         const DepthBuffer& depth = {});

// The light of the volume. With voxel-lights-exact the lights of the pixel's cell that matter most are taken
// out of it: `grid` has their lists, else it is null.
LightSource from_voxels(PassContext& work, Cached<VoxelBuffers>& cache, const VoxelVolume& volume,
                        const LightSource* grid);

// The last frame's volume on the host, for tests and the oracle.
struct ReadVoxels {
  VoxelAxes axes;
  PlacedVoxels placed;
  std::vector<glm::vec4> irradiance, directions;  // without the scale by which they are stored; x fastest
};
ReadVoxels read_voxels(PassContext& work, Cached<VoxelBuffers>& cache);

// The lights of any of the eight samples around each pixel, where `read` says that samples lie. depth: what
// the frame shaded from; null: the depth image.
ListedLights list_voxels(PassContext& work, const ReadVoxels& read, const DepthBuffer& depth);

}  // namespace lightgrid
