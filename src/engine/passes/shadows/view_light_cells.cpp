#include "passes/shadows/view_light_cells.h"

#include "plan/settings/shadows.h"

namespace lightgrid {
namespace {

const Setting<bool> shadow_cells{660,
                                 "shadow-cells",
                                 "exact hard shadows of lights at rest come from lists of the triangles "
                                 "around each light (on), or from the tree like all others (off)",
                                 {{"on", true}, {"off", false}},
                                 {.common = true, .shown_if_given = true}};

}  // namespace

bool ViewLightCells::serve(const PassContext& work, bool lanes) {
  const Settings& settings = work.plan.settings;
  return (!lanes || work.renderer.cl->info().cpu) && settings[shadow_cells] &&
         settings[setting::shadows] == ShadowMethod::exact && !soft_shadows(settings);
}

// With a light's own range, and not with what a view's rounding adds to it: lists then serve all views.
void ViewLightCells::look(PassContext& work, const std::vector<ShadowLight>& records,
                          const std::vector<CullLight>& lights) {
  shared_ = work.gpu.light_cells(blended_casters(work.plan.settings));
  lights_.clear();
  for (size_t i = 0; i < records.size(); ++i) {
    const ShadowLight& r = records[i];
    lights_.push_back(
        {r.x, r.y, r.z, lights[i].radius_m, r.w == 0, r.axis_x, r.axis_y, r.axis_z, r.cos_outer});
  }
}

void ViewLightCells::make(PassContext& work, const RayScene& rays) {
  shared_->make(work.gpu, rays, lights_, work.plan.settings[setting::shadow_memory]);
}

ClArguments ViewLightCells::arguments(ClDevice& device) {
  tables_.put(device, "uploading tables of light cells", shared_->cells().tables(lights_));
  return ClArguments{{"light_cells", tables_.buffer()}} + shared_->cells().arguments();
}

}  // namespace lightgrid
