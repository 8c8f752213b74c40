// The part of LightCuller that reduces a depth buffer to an interval of distances for each tile.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "cl/launch.h"
#include "cl/transfer.h"
#include "culling/culler_state.h"
#include "culling/light_arrays.h"

namespace lightgrid {

static constexpr uint usual_depth_group = 256, depth_tiles_an_item = 16;

// Slots outside the view stay empty; those inside get `near` and `far`.
cl::Buffer LightCuller::State::empty_bounds(int planes, float near, float far) {
  std::vector<float> values(size_t(params_.bins_x) * params_.bins_y * planes * BIN_SIZE);
  for (size_t i = 0; i < values.size(); ++i)
    values[i] = i / BIN_SIZE % planes % 2 == 0 ? far_away : -far_away;
  for (uint ty = 0; ty < params_.tiles_y; ++ty) {
    for (uint tx = 0; tx < params_.tiles_x; ++tx) {
      values[bounds_index(params_, planes, 0, tx, ty)] = near;
      values[bounds_index(params_, planes, 1, tx, ty)] = far;
    }
  }
  cl::Buffer buffer = device_buffer(device_, values.size() * sizeof(float));
  bounds_bytes_ = std::max(bounds_bytes_, values.size() * sizeof(float));
  write_buffer(device_, "light culling: bounds", buffer, values.data(), values.size() * sizeof(float));
  return buffer;
}

// Sets where kernels find the view's values in the depth buffer.
void LightCuller::State::read_layout(const DepthInput& depth) {
  if (!depth.values()) throw input_error("depth_bounds: the buffer of depth values is missing");
  if (depth.x < 0) throw input_error("depth_bounds: x is {}", depth.x);
  if (depth.y < 0) throw input_error("depth_bounds: y is {}", depth.y);
  const uint64_t width = uint64_t(depth.x) + params_.width, samples = uint64_t(options_.samples);
  const uint64_t row = depth.row_pixels ? uint64_t(std::max(depth.row_pixels, 0)) : uint64_t(params_.width);
  if (row < width) {
    throw input_error("depth_bounds: row_pixels is {}, less than the {} that x and the view's width need",
                      depth.row_pixels, width);
  }
  const uint64_t values = ((uint64_t(depth.y) + params_.height - 1) * row + width) * samples;
  const size_t given = bytes_of(depth.values);
  if (given / sizeof(float) < values) {
    throw input_error(
        "depth_bounds: the depth values are a buffer of {} bytes, fewer than the {} of {} rows of {} pixels "
        "with {} samples",
        given, values * sizeof(float), depth.y + params_.height, row, samples);
  }
  const uint64_t first = (uint64_t(depth.y) * row + uint64_t(depth.x)) * samples;
  if (first > 0xffffffffu || row * samples > 0xffffffffu) {
    throw input_error("depth_bounds: y is {} and row_pixels {}: the view begins past 2^32 values", depth.y,
                      row);
  }
  params_.depth_row = uint(row * samples);
  params_.depth_first = uint(first);
}

cl::Buffer LightCuller::State::straight_depth(const DepthInput& depth, uint first, uint row) {
  const StraightView& s = *oblique_;
  if (!straighten_kernel_) straighten_kernel_ = NamedKernel(programs_, "culling/straighten_depth", "");
  const size_t width = size_t(params_.width) * options_.samples;
  const cl::Buffer& straight = straight_depth_.at_least(device_, width * params_.height * sizeof(float));
  const cl_float4 plane = {{s.tilt_x, s.tilt_y, s.offset, s.scale}};
  straighten_kernel_.launch(device_, "straighten_depth", cl::NDRange(width, params_.height), cl::NullRange,
                            {{"depth", depth.values},
                             {"first", cl_uint(first)},
                             {"row", cl_uint(row)},
                             {"plane", plane},
                             {"nothing", s.nothing},
                             {"samples", cl_uint(options_.samples)},
                             {"straight", straight},
                             {"p", params_upload_.buffer()}});
  return straight;
}

// Makes the result of depth_bounds from its buffers.
DepthBounds LightCuller::State::own_bounds(DepthBoundsMode mode, const cl::Buffer& blend) {
  if (!bounds_view_) bounds_view_ = std::make_shared<BoundsView>();
  *bounds_view_ = view_;
  return {{opaque_, mode, bounds_view_},
          {options_.blend ? blend : cl::Buffer(), DepthBoundsMode::minmax, bounds_view_}};
}

DepthBounds LightCuller::State::depth_bounds(const DepthInput& depth) {
  require_view("depth_bounds");
  if (options_.depth_bounds == DepthBoundsMode::none) {
    const float near = params_.orthographic ? -far_away : 0.0f;
    if (!opaque_()) opaque_ = empty_bounds(2, near, far_away);
    invalid_tiles_counter_ = 0;
    return own_bounds(DepthBoundsMode::minmax, opaque_);
  }
  read_layout(depth);
  const bool lanes = options_.shape == KernelShape::lanes;
  if (!opaque_()) opaque_ = empty_bounds(planes_of(options_.depth_bounds), far_away, -far_away);
  if (!blend_()) blend_ = options_.blend ? empty_bounds(2, far_away, -far_away) : device_buffer(device_, 0);
  // The kernel depends on the view's depth direction: it is rebuilt when that changes.
  if (!bounds_kernel_ || bounds_kernel_standard_ != bool(params_.standard_depth)) {
    bounds_kernel_standard_ = params_.standard_depth;
    std::string defines =
        fmt::format("-DTILE={} -DSAMPLES={} -DDEPTH_MODE={}{}{}", options_.tile, options_.samples,
                    int(options_.depth_bounds), params_.standard_depth ? " -DSTANDARD_DEPTH" : "",
                    options_.blend ? " -DBLEND" : "");
    depth_group_ = usual_depth_group;
    while (depth_group_ > device_.info().max_group_items) depth_group_ /= 2;
    if (!lanes && depth_group_ != usual_depth_group) defines += fmt::format(" -DGROUP={}", depth_group_);
    bounds_kernel_ =
        NamedKernel(programs_, lanes ? "culling/cpu/depth_bounds" : "culling/gpu/depth_bounds", defines);
  }
  const uint depth_first = params_.depth_first, depth_row = params_.depth_row;
  if (oblique_) {
    params_.depth_first = 0;
    params_.depth_row = params_.width * uint(options_.samples);
  }
  upload_params();
  const cl::Buffer values_in = oblique_ ? straight_depth(depth, depth_first, depth_row) : depth.values;
  const uint tiles_x = params_.tiles_x, tiles_y = params_.tiles_y;
  // An item, or a group, processes several tiles side by side.
  const uint group = lanes ? 1 : depth_group_, values = uint(options_.tile * options_.samples);
  const uint tiles = lanes ? depth_tiles_an_item : std::max(depth_group_ / values, 1u);
  const uint counter = invalid_tiles_counter_ == invalid_tiles_counters[0] ? invalid_tiles_counters[1]
                                                                           : invalid_tiles_counters[0];
  const uint other = invalid_tiles_counters[0] + invalid_tiles_counters[1] - counter;
  bounds_kernel_.launch(device_, "depth_bounds", cl::NDRange((tiles_x + tiles - 1) / tiles * group, tiles_y),
                        cl::NDRange(group, 1),
                        {{"depth", values_in},
                         {"opaque", opaque_},
                         {"blend", blend_},
                         {"counters", counters_},
                         {"counter", cl_uint(counter)},
                         {"next_counter", cl_uint(other)},
                         {"p", params_upload_.buffer()}});
  invalid_tiles_counter_ = counter;
  return own_bounds(options_.depth_bounds, blend_);
}

TileBounds LightCuller::State::bounds_of(std::span<const DepthInterval> intervals) {
  require_view("bounds_of");
  if (const size_t tiles = size_t(params_.tiles_x) * params_.tiles_y; intervals.size() > tiles) {
    throw input_error("bounds_of: {} intervals for {} tiles", intervals.size(), tiles);
  }
  cl::Buffer buffer = empty_bounds(2, far_away, -far_away);
  std::vector<float> values(size_t(params_.bins_x) * params_.bins_y * 2 * BIN_SIZE);
  read_buffer(device_, "light culling: bounds", buffer, values.data(), values.size() * sizeof(float));
  for (size_t i = 0; i < intervals.size(); ++i) {
    const uint tx = uint(i) % params_.tiles_x, ty = uint(i) / params_.tiles_x;
    const bool some = intervals[i].near <= intervals[i].far;
    values[bounds_index(params_, 2, 0, tx, ty)] =
        some ? std::clamp(intervals[i].near, -far_away, far_away) : far_away;
    values[bounds_index(params_, 2, 1, tx, ty)] =
        some ? std::clamp(intervals[i].far, -far_away, far_away) : -far_away;
  }
  write_buffer(device_, "light culling: bounds", buffer, values.data(), values.size() * sizeof(float));
  return {buffer, DepthBoundsMode::minmax, std::make_shared<BoundsView>(view_)};
}

std::vector<DepthInterval> LightCuller::State::read_bounds(const TileBounds& bounds) {
  require_view("read_bounds");
  require_bounds(bounds, "read_bounds");
  const int planes = planes_of(bounds.mode);
  std::vector<float> values(size_t(params_.bins_x) * params_.bins_y * planes * BIN_SIZE);
  read_buffer(device_, "light culling: bounds", bounds.values, values.data(), values.size() * sizeof(float));
  std::vector<DepthInterval> intervals;
  intervals.reserve(size_t(params_.tiles_x) * params_.tiles_y);
  for (uint ty = 0; ty < params_.tiles_y; ++ty) {
    for (uint tx = 0; tx < params_.tiles_x; ++tx) {
      const auto at = [&](int plane) { return values[bounds_index(params_, planes, plane, tx, ty)]; };
      DepthInterval& i = intervals.emplace_back(DepthInterval{at(0), at(1)});
      if (planes == 4) i = {std::min(i.near, at(2)), std::max(i.far, at(3))};
    }
  }
  return intervals;
}

uint32_t LightCuller::State::invalid_depth_tiles() {
  cl_uint count = 0;
  if (invalid_tiles_counter_ == 0) return count;
  read_buffer(device_, "light culling: counters", counters_, &count, sizeof count,
              invalid_tiles_counter_ * sizeof count);
  return count;
}

}  // namespace lightgrid
