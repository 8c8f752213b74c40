// Depth bounds and light grids as the tests of culling read them: from OpenCL to plain vectors.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "culling/light_culler.h"
#include "scene/view_lights.h"

namespace lightgrid {

inline ClDevice& test_device() {
  static ClDevice device;
  return device;
}

inline ProgramCache& test_programs() {
  static ProgramCache programs(test_device());
  return programs;
}

template <typename T>
cl::Buffer buffer_of(const std::vector<T>& values) {
  cl::Buffer buffer(test_device().context(), CL_MEM_READ_WRITE,
                    std::max<size_t>(values.size() * sizeof(T), 64));
  if (!values.empty()) {
    test_device().queue().enqueueWriteBuffer(buffer, CL_TRUE, 0, values.size() * sizeof(T), values.data());
  }
  return buffer;
}

// Here the world is view space.
inline CullView cull_view_of(const View& view, const std::vector<float>& slice_edges = {}) {
  return {view.width, view.height, view.clip_from_view, glm::dmat4(1), glm::dvec3(0), slice_edges};
}

inline std::vector<CullLight> cull_lights_of(const std::vector<ViewLight>& lights) {
  std::vector<CullLight> out;
  for (const ViewLight& light : lights) {
    out.push_back({light.position, light.radius_m, light.direction,
                   light.type == LightType::spot ? light.cos_outer : -1.0});
  }
  return out;
}

// Least and greatest distance of each tile.
struct Intervals {
  std::vector<DepthInterval> opaque, blend;
};

inline Intervals depth_intervals(const View& view, const std::vector<float>& depth,
                                 const CullerOptions& options) {
  LightCuller culler(test_device(), test_programs(), options);
  culler.set_view(cull_view_of(view));
  const DepthBounds bounds = culler.depth_bounds({buffer_of(depth)});
  Intervals intervals{culler.read_bounds(bounds.opaque), {}};
  if (options.blend) intervals.blend = culler.read_bounds(bounds.blend);
  return intervals;
}

struct CulledGrid {
  CullParams params{};
  LightGrid grid;
  std::vector<glm::uvec2> cells;  // first, count
  std::vector<uint32_t> indices;  // widened
  std::vector<uint32_t> masks;

  std::vector<uint32_t> list(size_t cell) const {
    return {indices.begin() + cells[cell].x, indices.begin() + cells[cell].x + cells[cell].y};
  }
  bool operator==(const CulledGrid& other) const { return cells == other.cells && indices == other.indices; }
};

// The grid of these lights over the bounds that `bounds_of` gets from the culler.
template <typename Bounds>
CulledGrid cull_within(const View& view, const std::vector<ViewLight>& lights, const CullerOptions& options,
                       const std::vector<float>& slice_edges, const Bounds& bounds_of) {
  LightCuller culler(test_device(), test_programs(), options);
  culler.set_lights(cull_lights_of(lights));
  culler.set_view(cull_view_of(view, slice_edges));
  ClGridStorage storage(test_device());
  CulledGrid result;
  result.grid = culler.cull(bounds_of(culler), storage);
  result.params = culler.params();
  const HostGrid host = read_grid(test_device(), result.grid, storage);
  result.cells = host.cells;
  result.indices = host.indices;
  result.masks = host.masks;
  return result;
}

// Given intervals, one a tile.
inline CulledGrid cull_cells(const View& view, const std::vector<ViewLight>& lights,
                             const std::vector<glm::vec2>& intervals, const CullerOptions& options,
                             const std::vector<float>& slice_edges = {}) {
  std::vector<DepthInterval> given;
  for (const glm::vec2& i : intervals) given.push_back({i.x, i.y});
  return cull_within(view, lights, options, slice_edges,
                     [&](LightCuller& culler) { return culler.bounds_of(given); });
}

// From a depth image.
inline CulledGrid cull_depth(const View& view, const std::vector<ViewLight>& lights,
                             const std::vector<float>& depth, const CullerOptions& options) {
  return cull_within(view, lights, options, {},
                     [&](LightCuller& culler) { return culler.depth_bounds({buffer_of(depth)}).opaque; });
}

inline size_t tile_count(const View& view, int tile) {
  return size_t((view.width + tile - 1) / tile) * ((view.height + tile - 1) / tile);
}

inline ViewLight point_light(glm::dvec3 position_view, double radius_m) {
  ViewLight light;
  light.position = position_view;
  light.radius_m = radius_m;
  return light;
}

inline ViewLight spot_light(glm::dvec3 position_view, glm::dvec3 direction_view, double radius_m,
                            double outer_rad) {
  ViewLight light = point_light(position_view, radius_m);
  light.type = LightType::spot;
  light.direction = glm::normalize(direction_view);
  light.cos_outer = std::cos(outer_rad);
  light.cos_inner = std::max(1.0, light.cos_outer + 0.001);
  return light;
}

// A view with the camera at the origin that looks along -z.
inline View view_of(int width, int height, double fov_y_deg, double near_m = 0.1,
                    double far_m = std::numeric_limits<double>::infinity()) {
  Camera camera;
  camera.fov_y_rad = glm::radians(fov_y_deg);
  camera.near_m = near_m;
  camera.far_m = far_m;
  return make_view(camera, width, height);
}

inline View orthographic_view_of(int width, int height, double half_height_m, double near_m, double far_m) {
  Camera camera;
  camera.orthographic = true;
  camera.half_height_m = half_height_m;
  camera.half_width_m = half_height_m * width / height;
  camera.near_m = near_m;
  camera.far_m = far_m;
  return make_view(camera, width, height);
}

}  // namespace lightgrid
