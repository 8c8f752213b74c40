#include "renderer/cl_lights.h"

#include <fmt/format.h>

#include "renderer/culler_input.h"
#include "renderer/work.h"

namespace lightgrid {

void ClLights::upload(ClDevice& device, const Scene& scene, const View& seen, const FramePlan& plan,
                      const ViewParams& params) {
  const LightTable table = light_table(scene, seen, plan);
  constexpr const char* what = "uploading lights";
  for (size_t i = 0; i < light_column_count; ++i) columns_[i].put(device, what, table.columns[i].values);
  directional.put(device, what, table.directional);
  view.put(device, what, std::vector<ViewParams>{params});
  const auto put_edges = [&](UploadedBuffer& to, int count, const auto& keys_of) {
    std::vector<float> edges;
    if (count > 1) {
      const auto keys = keys_of(cull_view(seen, plan));
      edges.assign(keys.begin(), keys.end());
    }
    to.put(device, what, edges);
  };
  put_edges(bin_edges, plan.z_bins, z_bin_keys);
  put_edges(slice_edges, plan.slices, slice_keys);
}

size_t ClLights::memory_bytes() const {
  size_t bytes = directional.bytes() + view.bytes() + bin_edges.bytes() + slice_edges.bytes();
  for (const UploadedBuffer& column : columns_) bytes += column.bytes();
  return bytes;
}

ClArguments ClLights::columns() const {
  ClArguments arguments;
#define LIGHT_NAMED(condition, type, member, array, texels) \
  arguments.emplace_back(#array, columns_[arguments.size()].buffer());
  LIGHT_TABLE(LIGHT_NAMED)
#undef LIGHT_NAMED
  return arguments;
}

std::string light_defines(const Seen& seen, bool lanes, Brdf brdf) {
  std::string defines;
  if (lanes) defines += fmt::format(" -DTILE={}", seen.plan.settings.tile);
  if (lanes && seen.plan.settings.portable) defines += " -DPORTABLE";
  if (seen.plan.index_bits == 32) defines += " -DINDEX_32";
  if (seen.plan.z_bins > 1) defines += " -DZ_BINS";
  for (const char* define : light_table_defines(seen.plan)) defines += fmt::format(" -D{}", define);
  if (brdf == Brdf::blinn) defines += " -DBLINN";
  if (brdf == Brdf::lambert) defines += " -DLAMBERT";
  if (seen.view.orthographic) defines += " -DORTHOGRAPHIC";
  return defines;
}

bool shades_in_lanes(Work& work, const Seen& seen) {
  const KernelShape shape = seen.plan.settings.kernel_shape;
  return shape == KernelShape::lanes || (shape == KernelShape::automatic && work.renderer.cl->info().cpu);
}

}  // namespace lightgrid
