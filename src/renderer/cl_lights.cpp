#include "renderer/cl_lights.h"

#include <fmt/format.h>

#include "renderer/light_texels.h"

namespace lightgrid {

void ClLights::upload(RenderView& v) {
  const LightTexels texels = light_texels(v.scene, v.view, v.plan);
  ClDevice& device = *v.renderer.cl;
  constexpr const char* what = "uploading lights";
  positions.put(device, what, texels.positions);
  colors.put(device, what, texels.colors);
  cones.put(device, what, texels.cones);
  directional.put(device, what, texels.directional);
  view.put(device, what, std::vector<ViewParams>{v.params});
  std::vector<float> edges;
  if (v.plan.z_bins > 1) {
    const auto keys = z_bin_keys(cull_view(v.view, v.plan));
    edges.assign(keys.begin(), keys.end());
  }
  bin_edges.put(device, what, edges);
  edges.clear();
  if (v.plan.slices > 1) {
    const auto keys = slice_keys(cull_view(v.view, v.plan));
    edges.assign(keys.begin(), keys.end());
  }
  slice_edges.put(device, what, edges);
}

size_t ClLights::memory_bytes() const {
  size_t bytes = 0;
  for (const UploadedBuffer* b : {&positions, &colors, &cones, &directional, &view, &bin_edges, &slice_edges})
    bytes += b->bytes();
  return bytes;
}

std::string light_defines(const RenderView& v, bool lanes, Brdf brdf) {
  std::string defines;
  if (lanes) defines += fmt::format(" -DTILE={}", v.plan.settings.tile);
  if (lanes && v.plan.settings.portable) defines += " -DPORTABLE";
  if (v.plan.index_bits == 32) defines += " -DINDEX_32";
  if (v.plan.z_bins > 1) defines += " -DZ_BINS";
  if (v.plan.spots) defines += " -DSPOTS";
  if (brdf == Brdf::blinn) defines += " -DBLINN";
  if (brdf == Brdf::lambert) defines += " -DLAMBERT";
  for (const char* define : range_defines(v.plan.settings.ranges)) defines += fmt::format(" -D{}", define);
  if (v.view.orthographic) defines += " -DORTHOGRAPHIC";
  return defines;
}

bool shades_in_lanes(const RenderView& v) {
  const KernelShape shape = v.plan.settings.kernel_shape;
  return shape == KernelShape::lanes || (shape == KernelShape::automatic && v.renderer.cl->info().cpu);
}

}  // namespace lightgrid
