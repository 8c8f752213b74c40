#include "culling/light_culler.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "shared/light_grid.h"

namespace lightgrid {
namespace {

constexpr int cpu_lanes = 16;
constexpr int group_items = 64;
constexpr int scan_items = 256;
constexpr size_t load_margin = 64;  // floats that a vector load may read past the last candidate

cl::Buffer device_buffer(ClDevice& device, size_t bytes) {
  return {device.context(), CL_MEM_READ_WRITE, std::max<size_t>(bytes, 64)};
}

std::string shape_define(bool lanes) {
  return lanes ? fmt::format("-DLANES={}", cpu_lanes) : fmt::format("-DGROUP={}", group_items);
}

}  // namespace

cl::Buffer& ClGridStorage::grown(cl::Buffer& buffer, size_t& size, size_t bytes) {
  if (bytes > size) buffer = device_buffer(device_, bytes), size = bytes;
  return buffer;
}

LightCuller::LightCuller(ClDevice& device, ProgramCache& programs, const CullerOptions& options)
    : device_(device), programs_(programs), options_(options) {
  if (options_.shape == KernelShape::automatic) {
    options_.shape = device.info().cpu ? KernelShape::lanes : KernelShape::group;
  }
  const bool lanes = options_.shape == KernelShape::lanes;
  if (options_.depth_bounds == DepthBoundsMode::minmax) {
    bounds_ = programs_.kernel(lanes ? "depth_bounds_lanes" : "depth_bounds_group",
                               fmt::format("{} -DTILE={}{}", shape_define(lanes), options_.tile, options_.blend ? " -DBLEND" : ""));
  }
  view_buffer_ = device_buffer(device_, sizeof(ViewParams));
  totals_ = device_buffer(device_, 2 * sizeof(cl_ulong));
}

void LightCuller::build_cull_kernels() {
  if (scan_()) return;
  const bool lanes = options_.shape == KernelShape::lanes;
  const std::string suffix = lanes ? "_lanes" : "_group";
  const std::string test = fmt::format("{} -DCULL_TEST={}{}", shape_define(lanes), int(options_.cull_test),
                                       options_.spots ? " -DSPOTS" : "");
  const std::string index = options_.index_bits == 16 ? " -DINDEX=ushort" : " -DINDEX=uint";
  bins_count_ = programs_.kernel("cull_bins" + suffix, test + " -DCOUNT");
  bins_fill_ = programs_.kernel("cull_bins" + suffix, test);
  tiles_count_ = programs_.kernel("cull_tiles" + suffix, test + index + " -DCOUNT");
  tiles_fill_ = programs_.kernel("cull_tiles" + suffix, test + index);
  scan_ = programs_.kernel("scan_counts" + suffix, lanes ? "" : fmt::format("-DGROUP={}", scan_items));
}

void LightCuller::set_lights(std::span<const ViewLight> lights) {
  light_stride_ = uint((lights.size() + cpu_lanes - 1) / cpu_lanes * cpu_lanes);
  std::vector<float> spheres(4 * size_t(light_stride_) + load_margin, 0.0f);
  for (size_t i = 0; i < lights.size(); ++i) {
    spheres[i] = float(lights[i].position.x);
    spheres[light_stride_ + i] = float(lights[i].position.y);
    spheres[2 * size_t(light_stride_) + i] = float(-lights[i].position.z);
    spheres[3 * size_t(light_stride_) + i] = float(lights[i].radius_m);
  }
  spheres_ = device_buffer(device_, spheres.size() * sizeof(float));
  device_.queue().enqueueWriteBuffer(spheres_, CL_TRUE, 0, spheres.size() * sizeof(float), spheres.data());
  std::vector<glm::vec4> cones(1, glm::vec4(0, 0, 1, 2));
  if (options_.spots) {
    cones.clear();
    for (const ViewLight& light : lights) {
      // Rounding of the axis and the cosine is given to the cone: one part in 2^21 wider.
      const bool cone = light.type == LightType::spot && light.cos_outer >= 0;
      cones.emplace_back(light.direction.x, light.direction.y, -light.direction.z,
                         cone ? std::max(0.0, light.cos_outer - 5e-7) : 2.0);
    }
    cones.resize(std::max<size_t>(cones.size(), 1));
  }
  cones_ = device_buffer(device_, cones.size() * sizeof(glm::vec4));
  device_.queue().enqueueWriteBuffer(cones_, CL_TRUE, 0, cones.size() * sizeof(glm::vec4), cones.data());
}

void LightCuller::set_view(const ViewParams& view) {
  view_ = view;
  device_.queue().enqueueWriteBuffer(view_buffer_, CL_TRUE, 0, sizeof view, &view);
  const size_t tiles = size_t(view.tiles_x) * view.tiles_y, bins = size_t(view.bins_x) * view.bins_y;
  if (tiles * sizeof(cl_float2) > bounds_bytes_) {
    bounds_bytes_ = tiles * sizeof(cl_float2);
    opaque_ = device_buffer(device_, bounds_bytes_);
    blend_ = device_buffer(device_, options_.blend ? bounds_bytes_ : 0);
  }
  if (bins * sizeof(cl_uint2) > bins_bytes_) {
    bins_bytes_ = bins * sizeof(cl_uint2);
    bins_ = device_buffer(device_, bins_bytes_);
  }
}

void LightCuller::make_first_guess() {
  if (candidate_stride_ > 0) return;
  candidate_stride_ = std::max<uint>(4096, 4 * light_stride_);
  candidates_ = device_buffer(device_, (5 * size_t(candidate_stride_) + load_margin) * sizeof(float));
  index_capacity_ = size_t(view_.tiles_x) * view_.tiles_y * 64;
}

DepthBounds LightCuller::depth_bounds(cl::Buffer& depth) {
  const size_t tiles = size_t(view_.tiles_x) * view_.tiles_y;
  if (options_.depth_bounds == DepthBoundsMode::none) {
    const cl_float2 all = {{view_.orthographic ? -1e18f : 0.0f, 1e18f}};
    device_.queue().enqueueFillBuffer(opaque_, all, 0, tiles * sizeof all);
    if (options_.blend) device_.queue().enqueueFillBuffer(blend_, all, 0, tiles * sizeof all);
  } else if (options_.shape == KernelShape::lanes) {
    launch(device_, "depth_bounds", bounds_, tiles, 1, depth, opaque_, blend_, view_buffer_);
  } else {
    launch(device_, "depth_bounds", bounds_, tiles * group_items, group_items, depth, opaque_, blend_, view_buffer_);
  }
  return {opaque_, options_.blend ? blend_ : cl::Buffer()};
}

void LightCuller::run_bins(cl::Buffer& intervals, bool count) {
  const size_t items = options_.shape == KernelShape::lanes ? 1 : group_items;
  const size_t bins = size_t(view_.bins_x) * view_.bins_y;
  launch(device_, count ? "cull_bins_count" : "cull_bins_fill", count ? bins_count_ : bins_fill_, bins * items, items,
         spheres_, cl_uint(light_stride_), cones_, intervals, bins_, candidates_, cl_uint(candidate_stride_), view_buffer_);
}

void LightCuller::run_tiles(cl::Buffer& intervals, cl::Buffer& cells, cl::Buffer& indices, uint capacity, bool count) {
  const bool lanes = options_.shape == KernelShape::lanes;
  const size_t items = lanes ? 1 : group_items;
  const size_t places = lanes ? size_t(view_.bins_x) * view_.bins_y : size_t(view_.tiles_x) * view_.tiles_y;
  launch(device_, count ? "cull_tiles_count" : "cull_tiles_fill", count ? tiles_count_ : tiles_fill_, places * items,
         items, bins_, candidates_, cl_uint(candidate_stride_), cones_, intervals, cells, indices, cl_uint(capacity),
         view_buffer_);
}

void LightCuller::scan(cl::Buffer& cells, uint count, int slot) {
  const size_t items = options_.shape == KernelShape::lanes ? 1 : scan_items;
  launch(device_, "scan_counts", scan_, items, items, cells, cl_uint(count), totals_, cl_uint(slot));
}

LightGrid LightCuller::cull(cl::Buffer& intervals, GridStorage& storage) {
  build_cull_kernels();
  make_first_guess();
  LightGrid grid;
  grid.cells_x = view_.tiles_x, grid.cells_y = view_.tiles_y;
  grid.index_bits = options_.index_bits;
  const uint tiles = view_.tiles_x * view_.tiles_y, bins = view_.bins_x * view_.bins_y;
  grid.cell_bytes = size_t(tiles) * sizeof(cl_uint2);
  cl::Buffer cells = storage.cells(grid.cell_bytes);
  // The whole chain is enqueued at the sizes of last time, with one wait at its end; a count that passes its room
  // writes nothing, and the chain runs again with more.
  for (;;) {
    cl::Buffer indices = storage.indices(index_capacity_ * options_.index_bits / 8);
    run_bins(intervals, true);
    scan(bins_, bins, 0);
    run_bins(intervals, false);
    run_tiles(intervals, cells, indices, uint(index_capacity_), true);
    scan(cells, tiles, 1);
    run_tiles(intervals, cells, indices, uint(index_capacity_), false);
    cl_ulong totals[2];
    device_.queue().enqueueReadBuffer(totals_, CL_TRUE, 0, sizeof totals, totals);
    const size_t most = std::min<size_t>(0xffffffffu, device_.info().max_allocation_bytes / 20);
    if (totals[0] > candidate_stride_) {
      if (totals[0] > most) throw machine_error("light culling: {} bin candidates need more memory than {} allows; use fewer or smaller lights", totals[0], device_.info().name);
      candidate_stride_ = uint(std::min<size_t>(most, totals[0] + totals[0] / 4));
      candidates_ = device_buffer(device_, (5 * size_t(candidate_stride_) + load_margin) * sizeof(float));
    } else if (totals[1] > index_capacity_) {
      if (totals[1] > 0xffffffffu || totals[1] * options_.index_bits / 8 > device_.info().max_allocation_bytes) {
        throw machine_error("light culling: a light index list of {} entries needs more memory than {} allows; use fewer or smaller lights", totals[1], device_.info().name);
      }
      index_capacity_ = size_t(std::min<cl_ulong>(0xffffffffu, totals[1] + totals[1] / 4));
    } else {
      grid.index_count = totals[1];
      grid.index_bytes = grid.index_count * options_.index_bits / 8;
      return grid;
    }
  }
}

size_t LightCuller::memory_bytes() const {
  return sizeof(ViewParams) + 4 * size_t(light_stride_) * sizeof(float) + bounds_bytes_ * (options_.blend ? 2 : 1) +
         bins_bytes_ + 5 * size_t(candidate_stride_) * sizeof(float);
}

}  // namespace lightgrid
