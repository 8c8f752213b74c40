// Depth bounds and light grids as the tests of culling read them: from OpenCL to plain vectors.
#pragma once

#include <vector>

#include "culling/light_culler.h"

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
std::vector<T> read_buffer(const cl::Buffer& buffer, size_t count) {
  std::vector<T> values(count);
  if (count) test_device().queue().enqueueReadBuffer(buffer, CL_TRUE, 0, count * sizeof(T), values.data());
  return values;
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

// float2 a tile: least and greatest distance.
struct Intervals {
  std::vector<glm::vec2> opaque, blend;
};

inline Intervals depth_intervals(const View& view, const std::vector<float>& depth,
                                 const CullerOptions& options) {
  LightCuller culler(test_device(), test_programs(), options);
  const ViewParams params = view_params(view, options.tile, 0, 0, glm::vec3(0));
  culler.set_view(params);
  cl::Buffer values = buffer_of(depth);
  const DepthBounds bounds = culler.depth_bounds(values);
  const size_t tiles = size_t(params.tiles_x) * params.tiles_y;
  Intervals intervals{read_buffer<glm::vec2>(bounds.opaque, tiles), {}};
  if (options.blend) intervals.blend = read_buffer<glm::vec2>(bounds.blend, tiles);
  return intervals;
}

struct CulledGrid {
  ViewParams params{};
  LightGrid grid;
  std::vector<glm::uvec2> cells;  // first, count
  std::vector<uint32_t> indices;  // widened

  std::vector<uint32_t> list(size_t cell) const {
    return {indices.begin() + cells[cell].x, indices.begin() + cells[cell].x + cells[cell].y};
  }
  bool operator==(const CulledGrid& other) const { return cells == other.cells && indices == other.indices; }
};

// The grid of these lights over given intervals, one a tile.
inline CulledGrid cull_cells(const View& view, const std::vector<ViewLight>& lights,
                             const std::vector<glm::vec2>& intervals, const CullerOptions& options) {
  LightCuller culler(test_device(), test_programs(), options);
  CulledGrid result;
  result.params = view_params(view, options.tile, int(lights.size()), 0, glm::vec3(0));
  culler.set_lights(lights);
  culler.set_view(result.params);
  cl::Buffer bounds = buffer_of(intervals);
  ClGridStorage storage(test_device());
  result.grid = culler.cull(bounds, storage);
  result.cells = read_buffer<glm::uvec2>(storage.cells(0), size_t(result.grid.cells_x) * result.grid.cells_y);
  if (options.index_bits == 16) {
    const auto narrow = read_buffer<uint16_t>(storage.indices(0), result.grid.index_count);
    result.indices.assign(narrow.begin(), narrow.end());
  } else {
    result.indices = read_buffer<uint32_t>(storage.indices(0), result.grid.index_count);
  }
  return result;
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
  camera.near_m = near_m, camera.far_m = far_m;
  return make_view(camera, width, height);
}

inline View orthographic_view_of(int width, int height, double half_height_m, double near_m, double far_m) {
  Camera camera;
  camera.orthographic = true;
  camera.half_height_m = half_height_m, camera.half_width_m = half_height_m * width / height;
  camera.near_m = near_m, camera.far_m = far_m;
  return make_view(camera, width, height);
}

}  // namespace lightgrid
