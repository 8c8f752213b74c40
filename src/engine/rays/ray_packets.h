// Packets of points as kernels/rays/*/occlusion.cl and others read them.
#pragma once

#include <array>
#include <vector>

#include "rays/ray_scene.h"

namespace lightgrid {

struct PackedRays {
  std::vector<float> points;                       // blocks of 16 x, 16 y, 16 z, 16 gaps
  std::vector<int> own;                            // a point
  std::vector<std::array<uint32_t, 4>> packets{};  // block, light, lanes, 0
};

// Throws input: a packet whose block or light (of `lights`) does not exist.
PackedRays packed_rays(std::span<const RayPoint> points, size_t lights, std::span<const RayPacket> packets);

}  // namespace lightgrid
