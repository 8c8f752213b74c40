#include "passes/shadows/view_light_cells.h"

namespace lightgrid {
namespace {

const OwnSetting<bool> shadow_cells{"shadow-cells",
                                    "portable",
                                    "on CPUs exact hard shadows of point and spot lights at rest come from "
                                    "lists of triangles around each light, "
                                    "or all from the tree",
                                    {{"on", true}, {"off", false}},
                                    {.common = true, .shown_if_given = true}};

}  // namespace

bool ViewLightCells::serve(const Work& work, const RayScene& rays, bool lanes) {
  const Settings& settings = work.plan.settings;
  return lanes && work.renderer.cl->info().cpu && shadow_cells.of(settings) &&
         settings.shadows == ShadowMethod::exact && !settings.soft_shadows() && !settings.picks_shadows() &&
         rays.defines().find("RAYS_VEILS") == std::string::npos;
}

// With a light's own range, and not with what a view's rounding adds to it: lists then serve all views.
void ViewLightCells::look(Work& work, const RayScene& rays, const std::vector<CullLight>& lights) {
  shared_ = work.gpu.light_cells(work.plan.settings.blended_casters());
  lights_.assign(lights.size(), {});
  for (size_t i = 0; i < work.plan.local.size(); ++i) {
    const glm::dvec3 at = lights[i].position - rays.origin();
    lights_[i] = {at.x, at.y, at.z, lights[i].radius_m};
  }
}

void ViewLightCells::make(Work& work, const RayScene& rays) {
  shared_->make(work.gpu, rays, lights_, work.plan.settings.shadow_memory);
}

ClArguments ViewLightCells::arguments(ClDevice& device) {
  tables_.put(device, "uploading tables of light cells", shared_->cells().tables(lights_));
  return ClArguments{{"light_cells", tables_.buffer()}} + shared_->cells().arguments();
}

}  // namespace lightgrid
