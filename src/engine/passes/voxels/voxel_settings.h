// The voxel light buffer (docs/techniques/voxel_lights.md).
#pragma once

#include "plan/settings.h"

namespace lightgrid {

// Which space the samples divide.
enum class VoxelSpace { world, view };
enum class VoxelSize { s16x16x4, s32x32x8, s64x64x16, s128x128x16, s128x128x32, s128x128x64, s256x256x64 };

}  // namespace lightgrid

namespace lightgrid::setting {

inline const Setting<VoxelSize> voxel_size{
    480,
    "voxel-size",
    "samples of voxel_lights' volume: along x, z and y of the world; or across, up and in depth of the view",
    {{"128x128x16", VoxelSize::s128x128x16},
     {"16x16x4", VoxelSize::s16x16x4},
     {"32x32x8", VoxelSize::s32x32x8},
     {"64x64x16", VoxelSize::s64x64x16},
     {"128x128x32", VoxelSize::s128x128x32},
     {"128x128x64", VoxelSize::s128x128x64},
     {"256x256x64", VoxelSize::s256x256x64}}};

inline const Setting<VoxelSpace> voxel_space{
    490,
    "voxel-space",
    "the volume divides a box of the world around what is visible, or the view by distance",
    {{"world", VoxelSpace::world}, {"view", VoxelSpace::view}}};

inline const Setting<int> voxel_lights_exact{510,
                                             "voxel-lights-exact",
                                             "number of lights per pixel that are shaded exactly, from a "
                                             "light grid: the most important ones; the volume has the rest",
                                             {"0", "1", "2", "4", "8"}};

}  // namespace lightgrid::setting
