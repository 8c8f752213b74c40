// The light cells of a scene (rays/light_cells.h), for all views of it.
#pragma once

#include "rays/light_cells.h"
#include "renderer/moved_instances.h"

namespace lightgrid {

class SharedLightCells {
 public:
  // `renderer` outlives it.
  explicit SharedLightCells(const Renderer& renderer);

  // In each frame of a view, before its kernels read the cells. rays: always the same scene.
  void make(const GpuScene& gpu, const RayScene& rays, std::span<const CellLight> lights, size_t max_bytes);
  const LightCells& cells() const { return cells_; }

 private:
  ClDevice& device_;
  LightCells cells_;
  MovedInstances moved_;
};

}  // namespace lightgrid
