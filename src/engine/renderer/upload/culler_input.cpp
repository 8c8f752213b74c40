#include "renderer/upload/culler_input.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "plan/settings/cull_test.h"
#include "plan/settings/grid.h"
#include "plan/settings/kernels.h"
#include "plan/settings/samples.h"

namespace lightgrid {

CullView cull_view(const View& view) {
  return {view.width, view.height, view.clip_from_view, view.view_from_world, view.eye, {}, {}};
}

CullView cull_view(const View& view, const FramePlan& plan) {
  CullView culled = cull_view(view);
  culled.slice_edges = slice_edges(plan.settings[setting::slice_spacing], plan.lists.slices,
                                   plan.lists.near_m, plan.lists.far_m);
  culled.z_bin_edges = slice_edges(plan.settings[setting::slice_spacing], plan.lists.z_bins,
                                   plan.lists.near_m, plan.lists.far_m);
  return culled;
}

CullLight cull_light(const LightBounds& b) { return {b.position, b.radius_m, b.direction, b.cos_outer}; }

std::vector<CullLight> cull_lights_of(const Scene& scene, std::span<const int> indices,
                                      const LightRanges& ranges) {
  std::vector<CullLight> lights;
  cull_lights_of(scene, indices, ranges, lights);
  return lights;
}

void cull_lights_of(const Scene& scene, std::span<const int> indices, const LightRanges& ranges,
                    std::vector<CullLight>& lights) {
  lights.resize(indices.size());
  const auto convert = [&](size_t begin, size_t end) {
    for (size_t at = begin; at < end; ++at) {
      const size_t index = size_t(indices[at]);
      const Light& light = scene.lights[index];
      lights[at] = cull_light(bounds_of(light, range_of(light, index, ranges)));
      lights[at].mask = mask_of(light);
    }
  };
  // Below that a thread takes longer to start.
  constexpr size_t part = 8192;
  if (lights.size() <= part) {
    convert(0, lights.size());
  } else {
    parallel_for(int((lights.size() + part - 1) / part),
                 [&](int i) { convert(size_t(i) * part, std::min(size_t(i + 1) * part, lights.size())); });
  }
}

CullerOptions culler_options(const FramePlan& plan) {
  CullerOptions options;
  options.cull_test = plan.settings[setting::cull_test];
  options.depth_bounds = plan.settings[setting::depth_bounds];
  options.shape = plan.settings[setting::kernel_shape];
  options.tile = plan.settings[setting::tile];
  options.samples = plan.settings[setting::samples];
  options.portable = plan.settings[setting::portable];
  options.group_size = plan.settings[setting::group_size];
  options.blend = plan.lists.blend_grid;
  options.lists = plan.settings[setting::grid_lists];
  options.index_bits = plan.lights.index_bits;
  return options;
}

}  // namespace lightgrid
