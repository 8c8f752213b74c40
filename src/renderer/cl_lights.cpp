#include "renderer/cl_lights.h"

#include <fmt/format.h>

#include "renderer/culler_input.h"
#include "renderer/light_texels.h"

namespace lightgrid {

void ClLights::upload(Work& work, const Seen& seen) {
  const LightTexels texels = light_texels(seen.scene, seen.view, seen.plan);
  ClDevice& device = *work.renderer.cl;
  constexpr const char* what = "uploading lights";
  positions.put(device, what, texels.positions);
  colors.put(device, what, texels.colors);
  cones.put(device, what, texels.cones);
  directional.put(device, what, texels.directional);
  view.put(device, what, std::vector<ViewParams>{seen.params});
  std::vector<float> edges;
  if (seen.plan.z_bins > 1) {
    const auto keys = z_bin_keys(cull_view(seen.view, seen.plan));
    edges.assign(keys.begin(), keys.end());
  }
  bin_edges.put(device, what, edges);
  edges.clear();
  if (seen.plan.slices > 1) {
    const auto keys = slice_keys(cull_view(seen.view, seen.plan));
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

std::string light_defines(const Seen& seen, bool lanes, Brdf brdf) {
  std::string defines;
  if (lanes) defines += fmt::format(" -DTILE={}", seen.plan.settings.tile);
  if (lanes && seen.plan.settings.portable) defines += " -DPORTABLE";
  if (seen.plan.index_bits == 32) defines += " -DINDEX_32";
  if (seen.plan.z_bins > 1) defines += " -DZ_BINS";
  if (seen.plan.spots) defines += " -DSPOTS";
  if (brdf == Brdf::blinn) defines += " -DBLINN";
  if (brdf == Brdf::lambert) defines += " -DLAMBERT";
  for (const char* define : range_defines(seen.plan.settings.ranges)) defines += fmt::format(" -D{}", define);
  if (seen.view.orthographic) defines += " -DORTHOGRAPHIC";
  return defines;
}

bool shades_in_lanes(Work& work, const Seen& seen) {
  const KernelShape shape = seen.plan.settings.kernel_shape;
  return shape == KernelShape::lanes || (shape == KernelShape::automatic && work.renderer.cl->info().cpu);
}

}  // namespace lightgrid
