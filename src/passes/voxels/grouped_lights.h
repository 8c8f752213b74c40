// Point and spot lights along the axes of a voxel light buffer, neighbours in groups: what
// kernels/voxels/*/build_voxels.cl reads.
#pragma once

#include "cl/buffers.h"
#include "passes/voxels/placed_voxels.h"

namespace lightgrid {

class GroupedLights {
 public:
  // Places the plan's lights along these axes, and uploads them where they differ from the last ones.
  void update(Work& work, const Seen& seen, const VoxelAxes& axes);

  uint32_t groups() const { return groups_; }
  // Grows whenever a light changed.
  int version() const { return version_; }
  // The largest value of any light, of a channel of its radiant intensity.
  float brightest() const { return brightest_; }
  size_t memory_bytes() const;

  // As kernels/voxels/voxel_light.h says.
  UploadedBuffer boxes, places, colors, cones;

 private:
  void sort(const Seen& seen);

  std::vector<glm::dvec4>
      sorted_by_;                // world position and radius of the plan's lights, by which order_ was made
  std::vector<uint32_t> order_;  // of the plan's lights: neighbours are near each other
  std::vector<float> places_, boxes_;
  std::vector<glm::vec4> colors_, cones_;
  uint32_t groups_ = 0;
  int version_ = 0;
  float brightest_ = 0;
};

}  // namespace lightgrid
