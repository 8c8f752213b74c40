#include "frames/frame_culler.h"

#include <algorithm>
#include <numeric>

#include "base/error.h"
#include "cl/transfer.h"
#include "culling/cull_pipeline.h"
#include "frames/frame_lists.h"
#include "oracle/position.h"
#include "plan/settings/cull_test.h"
#include "plan/settings/grid.h"
#include "plan/settings/kernels.h"

namespace lightgrid::lab {
namespace {

double far_of_surfaces(const CapturedFrame& frame) {
  double far_m = frame.surfaces_far_m;
  for (int y = 0; y < frame.view.height && frame.surfaces_far_m == 0; ++y) {
    for (int x = 0; x < frame.view.width; ++x) {
      const float depth = frame.depth[frame.view.grid().index(x, y)];
      if (!is_covered(frame, x, y) || !(depth >= 0 && depth <= 1)) continue;
      const double distance = -position_from_depth(frame.view, x, y, depth).z;
      if (distance < 1e12) far_m = std::max(far_m, distance);
    }
  }
  return far_m > frame.view.near_m ? far_m : frame.view.near_m + 1;
}

}  // namespace

Settings frame_settings(const CapturedFrame& frame, const std::vector<std::string>& set) {
  Settings settings;
  settings.set(setting::tile, frame.tile);
  for (const std::string& assignment : set) apply_setting(settings, assignment);
  return settings;
}

CullerOptions culler_options(const Settings& settings) {
  CullerOptions options;
  options.cull_test = settings[setting::cull_test];
  options.depth_bounds = settings[setting::depth_bounds];
  options.shape = settings[setting::kernel_shape];
  options.tile = settings[setting::tile];
  options.portable = settings[setting::portable];
  options.group_size = settings[setting::group_size];
  options.lists = settings[setting::grid_lists];
  return options;
}

TechniqueNeeds grid_needs(const std::string& technique, const Settings& settings) {
  TechniqueNeeds needs = find_technique(technique).needs;
  if (!needs.lists.light_grid) throw input_error("technique {}: shades from no light grid", technique);
  needs.lists.slices |= settings.given(setting::slices);
  needs.lists.z_bins |= settings.given(setting::z_bins);
  return needs;
}

Settings grid_settings(Settings settings, const TechniqueNeeds& needs) {
  if (!needs.lists.slices) settings.set(setting::slices, 1);
  if (!needs.lists.z_bins) settings.set(setting::z_bins, 1);
  return settings;
}

CullView cull_view_of(const CapturedFrame& frame, const Settings& settings) {
  CullView view = cull_view(frame.view);
  if (settings[setting::slices] == 1 && settings[setting::z_bins] == 1) return view;
  const double far_m = far_of_surfaces(frame);
  view.slice_edges =
      slice_edges(settings[setting::slice_spacing], settings[setting::slices], frame.view.near_m, far_m);
  view.z_bin_edges =
      slice_edges(settings[setting::slice_spacing], settings[setting::z_bins], frame.view.near_m, far_m);
  return view;
}

const std::vector<std::string>& culling_settings() {
  static const std::vector<std::string> keys = {"cull-test",     "depth-bounds", "tile",       "slices",
                                                "slice-spacing", "z-bins",       "grid-lists", "kernel-shape",
                                                "portable",      "group-size"};
  return keys;
}

std::vector<CullLight> cull_lights_of(const CapturedFrame& frame) {
  Scene scene;
  scene.lights = local_world_lights(frame);
  std::vector<int> all(scene.lights.size());
  std::iota(all.begin(), all.end(), 0);
  return cull_lights_of(scene, all);
}

cl::Buffer upload_depth(ClDevice& device, const CapturedFrame& frame) {
  const size_t bytes = frame.depth.size() * sizeof(float);
  cl::Buffer buffer = device_buffer(device, bytes);
  write_buffer(device, "depth", buffer, frame.depth.data(), bytes);
  return buffer;
}

FrameCuller::FrameCuller(ClDevice& device, ProgramCache& programs, const CapturedFrame& frame,
                         const Settings& settings, const TechniqueNeeds& needs)
    : device_(device),
      settings_(grid_settings(with_tuned(settings, read_tuned_sizes(device.info())), needs)),
      view_(cull_view_of(frame, settings_)),
      culler_(device, programs, culler_options(settings_)),
      storage_(device) {
  culler_.set_lights(cull_lights_of(frame));
  culler_.set_view(view_);
  depth_.values = upload_depth(device, frame);
}

void FrameCuller::run() {
  bounds_ = culler_.depth_bounds(depth_);
  grid_ = culler_.cull(bounds_.opaque, storage_);
}

FrameGrid FrameCuller::grid() {
  FrameGrid grid;
  grid.lists = read_grid(device_, grid_, storage_);
  grid.tile = settings_[setting::tile];
  grid.slice_edges = view_.slice_edges;
  grid.z_bin_edges = view_.z_bin_edges;
  grid.settings = to_strings(settings_);
  return grid;
}

std::vector<DepthInterval> FrameCuller::intervals() { return culler_.read_bounds(bounds_.opaque); }

}  // namespace lightgrid::lab
