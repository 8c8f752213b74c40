// The inputs of the kernel that fills a voxel light buffer: the places of its samples in a frame, and the
// lights in groups.
#pragma once

#include "cl/buffers.h"
#include "passes/voxels/voxel_settings.h"
#include "renderer/pass_context.h"
#include "shared/voxel_volume.h"

namespace lightgrid {

// Encloses what a view shows. Conservative.
struct VisibleBox {
  glm::dvec3 low{0}, high{0};            // along the axes of the world, from the eye, metres
  double nearest_m = 0, farthest_m = 0;  // along the view axis
};

// Encloses opaque surfaces by the depth bounds of tiles, and blended ones by their boxes. Without depth
// bounds it encloses all by their boxes. A view that shows nothing gets a box at the near plane.
VisibleBox visible_box(const ViewState& seen, const TileDistances& distances);

// The axes of the volume: where lights are for the kernel that fills it.
struct VoxelAxes {
  glm::dmat3 from_world{1};  // orthogonal, possibly a reflection
  glm::dvec3 origin{0};      // world, metres
  bool log_depth = false;    // VOXELS_LOG of shared/voxel_volume.h
};

// A function of the view alone. voxel-space=world: x, z and y of the world, from a point near the eye that
// many views share. view: the view's own.
VoxelAxes voxel_axes(const View& view, VoxelSpace space);

struct PlacedVoxels {
  VoxelGrid grid;
  std::vector<VoxelSlice> slices;  // size_z
  VoxelLookup lookup;
};

// Samples on the faces of the box too, so that nothing visible lies outside. In the world they lie at whole
// multiples of their spacing, which is a power of 2^(1/4) metres: while the camera moves little, the same
// points stay samples. grid.groups, scale and largest are left to the caller.
PlacedVoxels place_voxels(const ViewState& seen, const VoxelAxes& axes, const VisibleBox& box);

glm::uvec3 voxel_size(VoxelSize size);

class GroupedLights {
 public:
  // Places the plan's lights along these axes, and uploads them where they differ from the last ones.
  void update(PassContext& work, const VoxelAxes& axes);

  uint32_t groups() const { return groups_; }
  // Grows whenever a light changed.
  int version() const { return version_; }
  // The largest value of any light, of a channel of its radiant intensity.
  float brightest() const { return brightest_; }
  size_t memory_bytes() const;

  // Laid out as kernels/voxels/voxel_light.h says.
  UploadedBuffer boxes, places, colors, cones;

 private:
  void sort(const ViewState& seen);

  std::vector<glm::dvec4>
      sorted_by_;                // world position and radius of the plan's lights, by which order_ was made
  std::vector<uint32_t> order_;  // order of the plan's lights: neighbours are near each other
  std::vector<float> places_, boxes_;
  std::vector<glm::vec4> colors_, cones_;
  uint32_t groups_ = 0;
  int version_ = 0;
  float brightest_ = 0;
};

}  // namespace lightgrid
