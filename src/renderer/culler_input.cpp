#include "renderer/culler_input.h"

#include <cmath>

namespace lightgrid {

CullView cull_view(const View& view) {
  return {view.width, view.height, view.clip_from_view, view.view_from_world, view.eye, {}, {}};
}

CullView cull_view(const View& view, const FramePlan& plan) {
  CullView culled = cull_view(view);
  culled.slice_edges = slice_edges(plan.settings.slice_spacing, plan.slices, plan.slice_near_m, plan.slice_far_m);
  culled.z_bin_edges = slice_edges(plan.settings.slice_spacing, plan.z_bins, plan.slice_near_m, plan.slice_far_m);
  return culled;
}

std::vector<CullLight> cull_lights_of(const Scene& scene, std::span<const int> indices, const LightRanges& ranges) {
  std::vector<CullLight> lights;
  lights.reserve(indices.size());
  for (int i : indices) {
    const Light& light = scene.lights[i];
    lights.push_back({light.position, range_of(light, size_t(i), ranges), glm::normalize(glm::dvec3(light.direction)),
                      light.type == LightType::spot ? std::cos(double(light.outer_cone_rad)) : -1.0});
  }
  return lights;
}

CullerOptions culler_options(const FramePlan& plan) {
  CullerOptions options;
  options.cull_test = plan.settings.cull_test;
  options.depth_bounds = plan.settings.depth_bounds;
  options.shape = plan.settings.kernel_shape;
  options.tile = plan.settings.tile;
  options.portable = plan.settings.portable;
  options.group_size = plan.settings.group_size;
  options.blend = plan.blend_grid;
  options.lists = plan.settings.grid_lists;
  options.index_bits = plan.index_bits;
  return options;
}

}  // namespace lightgrid
