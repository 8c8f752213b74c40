// Settings and volumes of the tests of voxel_lights.
#pragma once

#include "passes/build_voxels.h"
#include "passes/voxels/voxel_settings.h"
#include "support/small_scene.h"
#include "techniques/rendering.h"

namespace lightgrid {

inline constexpr double voxel_pi = 3.14159265358979323846;
inline constexpr VoxelSize coarse = VoxelSize::s16x16x4;

// A volume of the world, and where its samples are.
struct Volume {
  explicit Volume(RenderView& v) : read(read_voxels(v, v.caches.voxels)) {
    const VoxelGrid& g = read.placed.grid;
    spacing = {g.spacing_x, read.placed.slices[1].place - read.placed.slices[0].place, g.spacing_y};
    first = read.axes.origin + glm::dvec3(g.origin_x, read.placed.slices[0].place, g.origin_y);
  }
  size_t index(glm::ivec3 i) const {  // along x, z and y of the world
    return (size_t(i.z) * read.placed.grid.size_y + size_t(i.y)) * read.placed.grid.size_x + size_t(i.x);
  }
  glm::dvec3 position(glm::ivec3 i) const { return first + spacing * glm::dvec3(i.x, i.z, i.y); }
  // Along the world's axes.
  glm::dvec3 directions(size_t i) const {
    return glm::dvec3(read.directions[i].x, read.directions[i].z, read.directions[i].y);
  }
  glm::ivec3 size() const {
    return {read.placed.grid.size_x, read.placed.grid.size_y, read.placed.grid.size_z};
  }

  ReadVoxels read;
  glm::dvec3 spacing, first;  // world, metres
};

inline Settings sized(VoxelSize size, VoxelSpace space = VoxelSpace::world) {
  Settings settings;
  settings.set(setting::voxel_size, size);
  settings.set(setting::voxel_space, space);
  return settings;
}

}  // namespace lightgrid
