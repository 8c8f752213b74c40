#include "renderer/shared_light_cells.h"

#include "renderer/gpu_scene.h"

namespace lightgrid {

// Below 3 ms: a core takes less than 0.7 microseconds for a triangle. An H200 takes 1 to 2 ms for as many as
// these, most of it to wait for the largest triangle.
size_t triangles_per_frame(const ClDeviceInfo& device) {
  return device.cpu ? 4096 * size_t(device.compute_units) : 32768;
}

SharedLightCells::SharedLightCells(const Renderer& renderer)
    : device_(*renderer.cl), cells_(*renderer.cl, *renderer.kernels) {}

void SharedLightCells::make(const GpuScene& gpu, const RayScene& rays, std::span<const CellLight> lights,
                            size_t max_bytes) {
  if (const auto moved = moved_.since_last(gpu, rays)) {
    for (const WorldBox& box : *moved)
      if (!box.empty()) cells_.forget_near(box.min - rays.origin(), box.max - rays.origin());
  } else {
    cells_.forget();
  }
  cells_.make(rays, lights, {.bytes = max_bytes, .triangles = triangles_per_frame(device_.info())});
}

}  // namespace lightgrid
