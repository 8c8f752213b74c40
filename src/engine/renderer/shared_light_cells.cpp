#include "renderer/shared_light_cells.h"

#include "renderer/gpu_scene.h"

namespace lightgrid {

// Below 3 ms: a core takes less than 0.7 microseconds for a triangle.
constexpr size_t triangles_per_core = 4096;

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
  cells_.make(rays, lights,
              {.bytes = max_bytes, .triangles = triangles_per_core * size_t(device_.info().compute_units)});
}

}  // namespace lightgrid
