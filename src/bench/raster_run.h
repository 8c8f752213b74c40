// A built-in scene's opaque and masked triangles, for repeated rasterising. Masks are not looked up: masked
// triangles are drawn whole.
#pragma once

#include <string>
#include <vector>

#include "bench/kernel_costs.h"
#include "plan/settings.h"
#include "raster/raster_view.h"
#include "scene/scene.h"

namespace lightgrid {

// Names of the rows that a case of the rasteriser may have.
const std::vector<std::string>& raster_rows();

class RasterRun {
 public:
  // The scene's first camera. Draws twice, so that kernels are built and room has its size.
  RasterRun(ClDevice& device, ProgramCache& programs, const Scene& scene, int width, int height,
            const Settings& settings);

  // Vertices to the visibility buffer, with the wait in which the rasteriser reads its counters.
  void run() { raster_.draw(); }

  KernelWork work() const;  // of the last run

 private:
  RasterScene geometry_;
  RasterView raster_;
  KernelWork scene_;
};

}  // namespace lightgrid
