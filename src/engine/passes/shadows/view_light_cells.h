// The light cells of a view's lights (rays/light_cells.h), from which find_shadows takes exact hard
// shadows. The setting shadow-cells leaves them out.
#pragma once

#include "passes/shadows/shadow_lights.h"
#include "renderer/pass_context.h"
#include "renderer/shared_light_cells.h"

namespace lightgrid {

class ViewLightCells {
 public:
  // True if rays of the view may use them: the kernel is of the device's own kind, or a CPU runs that for
  // GPUs; and rays begin at a light's centre.
  static bool serve(const PassContext& work, bool lanes);

  // When the view, lights or surfaces changed. records: shadow_light_records() of `lights`.
  void look(PassContext& work, const std::vector<ShadowLight>& records, const std::vector<CullLight>& lights);
  // In each frame.
  void make(PassContext& work, const RayScene& rays);

  // LIGHT_CELL_ARGUMENTS of kernels/rays/light_cells.h, of all of the view's lights. Before each launch:
  // other views may have made other lists since the last.
  ClArguments arguments(ClDevice& device);
  size_t memory_bytes() const { return shared_->cells().memory_bytes() + tables_.bytes(); }

 private:
  std::shared_ptr<SharedLightCells> shared_;
  std::vector<CellLight> lights_;
  UploadedBuffer tables_;
};

}  // namespace lightgrid
