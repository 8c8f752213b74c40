#include "culling/light_culler.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/error.h"
#include "cl/avx512.h"
#include "cl/launch.h"
#include "culling/cull_pipeline.h"
#include "culling/culler_options.h"
#include "culling/light_arrays.h"
#include "culling/oblique_view.h"
#include "culling/two_floats.h"
#include "shared/light_grid.h"

namespace lightgrid {
namespace {

constexpr float widen = 4.8e-7f;    // as kernels/common/depth_interval.h
constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr uint lane_count = 16, depth_group = 256, depth_tiles_an_item = 16, mask_group = 64, z_bin_group = 64;
constexpr uint most_regions = 64, most_region_bins = 16;

int planes_of(DepthBoundsMode mode) {
  if (mode == DepthBoundsMode::halfz || mode == DepthBoundsMode::halfz_modified) return 4;
  return mode == DepthBoundsMode::mask32 ? 3 : 2;
}

float rounded_up(double value) { return std::nextafter(float(value), infinity); }
float rounded_down(double value) { return std::nextafter(float(value), -infinity); }

// Where a tile's value of a plane lies: kernels/common/depth_bounds.h.
size_t bounds_index(const CullParams& p, int planes, int plane, uint tx, uint ty) {
  const size_t bin = size_t(ty / BIN_TILES) * p.bins_x + tx / BIN_TILES;
  return (bin * planes + plane) * BIN_SIZE + slot_of_tile(tx % BIN_TILES, ty % BIN_TILES);
}

// One step of the stored format where it is coarser than slack covers, else 0. 32-bit floats near 1, where
// standard depth has the distance, are up to 2^-24 apart; near 0, where reversed depth has it, much closer.
float depth_step(DepthFormat format, bool standard_depth) {
  if (format == DepthFormat::d16) return 1.0f / 65535;
  if (format == DepthFormat::d24) return 1.0f / 16777215;
  return standard_depth ? float(half_ulp) : 0.0f;
}

// Near and far of each range between two edges, metres. A pixel's range follows from comparing its stored
// depth with the edges' keys, so a range ends where its key lies, which differs from the edge by the key's own
// rounding: centimetres in standard depth near 1. One step of the depth format on either side is for the
// surface's true distance, and rounding for what shading makes of it.
template <size_t most>
std::vector<cl_float2> ranges_between(const CullView& view, const std::vector<float>& edges,
                                      const std::array<float, most>& keys, const CullParams& p) {
  const double margin = p.orthographic ? widen * std::abs(double(p.depth_b) * p.depth_a) : 0.0;
  const double step = p.depth_step;
  std::vector<cl_float2> ranges;
  float near = p.orthographic ? -far_away : 0.0f;
  for (size_t i = 0; i < edges.size(); ++i) {
    const double limit = 2.0 * far_away;
    const double nearest = std::min(distance_of_key(view, keys[i] - step), limit);
    const double farthest = std::min(distance_of_key(view, keys[i] + step), limit);
    const double far = farthest + widen * std::abs(farthest) + margin;
    ranges.push_back({{near, far < far_away ? rounded_up(far) : far_away}});
    near = rounded_down(std::min(nearest - widen * std::abs(nearest) - margin, double(far_away)));
  }
  ranges.push_back({{near, far_away}});
  return ranges;
}

}  // namespace

LightCuller::LightCuller(ClDevice& device, ProgramCache& programs, const CullerOptions& options)
    : device_(device), programs_(programs), options_(options), lights_(std::make_unique<GrowingBuffer>()) {
  check_options(options);
  if (options_.shape == KernelShape::automatic) {
    options_.shape = device.info().cpu ? KernelShape::lanes : KernelShape::group;
  }
  params_buffer_ = device_buffer(device_, sizeof(CullParams));
  const cl_uint zeros[8] = {};
  counters_ = device_buffer(device_, sizeof zeros);
  device_.queue().enqueueWriteBuffer(counters_, CL_TRUE, 0, sizeof zeros, zeros);
  slices_ = device_buffer(device_, 0);
}

LightCuller::~LightCuller() = default;
LightCuller::LightCuller(LightCuller&&) noexcept = default;

void LightCuller::set_lights(std::span<const CullLight> lights) {
  light_count_ = uint(lights.size());
  light_stride_ = (light_count_ + lane_count - 1) / lane_count * lane_count;
  cones_ = std::any_of(lights.begin(), lights.end(), [](const CullLight& light) { return light.cos_outer >= 0; });
  host_lights_.assign(lights.begin(), lights.end());
  const LightOrigin origin = choose_origin(lights);
  fixed_origin_ = origin.fixed;
  cone_slack_m_ = origin.cone_slack_m;
  uploaded_origin_.reset();
  if (fixed_origin_) upload_lights(*fixed_origin_, farthest_surface);
}

void LightCuller::upload_lights(const glm::dvec3& origin, double eye_reach) {
  uploaded_origin_ = origin;
  if (host_lights_.empty()) return;
  const std::vector<float> values = light_arrays(host_lights_, origin, eye_reach, light_stride_);
  device_.queue().enqueueWriteBuffer(lights_->at_least(device_, values.size() * sizeof(float)), CL_TRUE, 0,
                                     values.size() * sizeof(float), values.data());
}

// Uploads the positions relative to the eye where no fixed origin serves.
void LightCuller::follow_eye() {
  const bool fixed = fixed_origin_ && glm::length(eye_ * 0.5 - *fixed_origin_ * 0.5) < farthest_surface / 2;
  const glm::dvec3 origin = fixed ? *fixed_origin_ : eye_;
  params_.cone_slack_m = fixed && cones_ ? rounded_up(cone_slack_m_) : 0.0f;
  if (uploaded_origin_ != origin) upload_lights(origin, fixed ? farthest_surface : 0);
}

void LightCuller::set_view(const CullView& view) {
  check_view(view, options_.tile);
  oblique_.reset();
  if (is_oblique(view)) {
    oblique_ = std::make_unique<StraightView>(straightened(view, options_.depth_format, options_.samples));
  }
  const CullParams room = params_;
  params_ = cull_params(oblique_ ? oblique_->view : view, options_.tile);
  params_.pool_blocks = room.pool_blocks, params_.staging_units = room.staging_units;
  params_.inset = options_.pixel_centres && options_.samples == 1 ? 0.5f : 0.0f;
  params_.depth_step = oblique_ ? oblique_->depth_step : depth_step(options_.depth_format, params_.standard_depth);
  eye_ = view.eye;
  const auto upload = [&](cl::Buffer& buffer, const std::vector<cl_float2>& ranges) {
    if (ranges.size() == 1) return;
    buffer = device_buffer(device_, ranges.size() * sizeof ranges[0]);
    device_.queue().enqueueWriteBuffer(buffer, CL_TRUE, 0, ranges.size() * sizeof ranges[0], ranges.data());
  };
  upload(slices_, ranges_between(view, view.slice_edges, slice_keys(view), params_));
  upload(z_bins_, ranges_between(view, view.z_bin_edges, z_bin_keys(view), params_));
  z_bin_count_ = uint(view.z_bin_edges.size() + 1);
  const glm::uvec2 tiles(params_.tiles_x, params_.tiles_y);
  if (tiles != bounds_tiles_ || room.orthographic != params_.orthographic) {
    bounds_tiles_ = tiles;
    opaque_ = blend_ = cl::Buffer();
  }
}

// Every slot outside the view stays empty; those inside begin as given.
cl::Buffer LightCuller::empty_bounds(int planes, float near, float far) {
  std::vector<float> values(size_t(params_.bins_x) * params_.bins_y * planes * BIN_SIZE);
  for (size_t i = 0; i < values.size(); ++i) values[i] = i / BIN_SIZE % planes % 2 == 0 ? far_away : -far_away;
  for (uint ty = 0; ty < params_.tiles_y; ++ty) {
    for (uint tx = 0; tx < params_.tiles_x; ++tx) {
      values[bounds_index(params_, planes, 0, tx, ty)] = near, values[bounds_index(params_, planes, 1, tx, ty)] = far;
    }
  }
  cl::Buffer buffer = device_buffer(device_, values.size() * sizeof(float));
  bounds_bytes_ = std::max(bounds_bytes_, values.size() * sizeof(float));
  device_.queue().enqueueWriteBuffer(buffer, CL_TRUE, 0, values.size() * sizeof(float), values.data());
  return buffer;
}

void LightCuller::choose_regions() {
  params_.region_bins = 4;
  const auto regions = [&](uint bins) { return (bins + params_.region_bins - 1) / params_.region_bins; };
  while (regions(params_.bins_x) * regions(params_.bins_y) > most_regions && params_.region_bins < most_region_bins) {
    params_.region_bins *= 2;
  }
  params_.regions_x = regions(params_.bins_x), params_.regions_y = regions(params_.bins_y);
}

void LightCuller::upload_params() {
  choose_regions();
  params_.light_count = light_count_, params_.light_stride = light_stride_;
  params_.index_capacity = uint(index_capacity_);
  const glm::dvec3 eye = eye_ - uploaded_origin_.value_or(eye_);
  const TwoFloats x = two_floats(eye.x), y = two_floats(eye.y), z = two_floats(eye.z);
  params_.eye_x = x.value, params_.eye_y = y.value, params_.eye_z = z.value;
  params_.eye_rest_x = x.rest, params_.eye_rest_y = y.rest, params_.eye_rest_z = z.rest;
  if (params_uploads_ && std::memcmp(&uploaded_, &params_, sizeof params_) == 0) return;
  uploaded_ = params_, ++params_uploads_;
  device_.queue().enqueueWriteBuffer(params_buffer_, CL_FALSE, 0, sizeof uploaded_, &uploaded_);
}

cl::Buffer LightCuller::straight_depth(const DepthInput& depth, uint first, uint row) {
  const StraightView& s = *oblique_;
  if (!straight_depth_) straight_depth_ = std::make_unique<GrowingBuffer>();
  if (!straighten_kernel_()) straighten_kernel_ = programs_.kernel("straighten_depth", "");
  const size_t width = size_t(params_.width) * options_.samples;
  const cl::Buffer& straight = straight_depth_->at_least(device_, width * params_.height * sizeof(float));
  const cl_float4 plane = {{s.tilt_x, s.tilt_y, s.offset, s.scale}};
  launch(device_, "straighten_depth", straighten_kernel_, cl::NDRange(width, params_.height), cl::NullRange, depth.values,
         cl_uint(first), cl_uint(row), plane, s.nothing, cl_uint(options_.samples), straight, params_buffer_);
  return straight;
}

DepthBounds LightCuller::depth_bounds(const DepthInput& depth) {
  if (options_.depth_bounds == DepthBoundsMode::none) {
    const float near = params_.orthographic ? -far_away : 0.0f;
    if (!opaque_()) opaque_ = empty_bounds(2, near, far_away);
    return {{opaque_, DepthBoundsMode::minmax}, {options_.blend ? opaque_ : cl::Buffer(), DepthBoundsMode::minmax}};
  }
  const bool lanes = options_.shape == KernelShape::lanes;
  if (!opaque_()) opaque_ = empty_bounds(planes_of(options_.depth_bounds), far_away, -far_away);
  if (!blend_()) blend_ = options_.blend ? empty_bounds(2, far_away, -far_away) : device_buffer(device_, 0);
  // Depth's sense is the view's: a kernel is built for the one met.
  if (!bounds_kernel_() || bounds_kernel_standard_ != bool(params_.standard_depth)) {
    bounds_kernel_standard_ = params_.standard_depth;
    const std::string defines =
        fmt::format("-DTILE={} -DSAMPLES={} -DDEPTH_MODE={}{}{}", options_.tile, options_.samples, int(options_.depth_bounds),
                    params_.standard_depth ? " -DSTANDARD_DEPTH" : "", options_.blend ? " -DBLEND" : "");
    bounds_kernel_ = programs_.kernel(lanes ? "depth_bounds_lanes" : "depth_bounds_group", defines);
  }
  const uint row = uint(depth.row_pixels > 0 ? depth.row_pixels : int(params_.width));
  const uint depth_row = row * uint(options_.samples);
  const uint depth_first = (uint(depth.y) * row + uint(depth.x)) * uint(options_.samples);
  params_.depth_row = oblique_ ? params_.width * uint(options_.samples) : depth_row;
  params_.depth_first = oblique_ ? 0 : depth_first;
  upload_params();
  const cl::Buffer values_in = oblique_ ? straight_depth(depth, depth_first, depth_row) : depth.values;
  const uint tiles_x = params_.tiles_x, tiles_y = params_.tiles_y;
  // An item, or a group, takes tiles side by side.
  const uint group = lanes ? 1 : depth_group, values = uint(options_.tile * options_.samples);
  const uint tiles = lanes ? depth_tiles_an_item : std::max(depth_group / values, 1u);
  launch(device_, "depth_bounds", bounds_kernel_, cl::NDRange((tiles_x + tiles - 1) / tiles * group, tiles_y),
         cl::NDRange(group, 1), values_in, opaque_, blend_, counters_, params_buffer_);
  return {{opaque_, options_.depth_bounds}, {options_.blend ? blend_ : cl::Buffer(), DepthBoundsMode::minmax}};
}

TileBounds LightCuller::bounds_of(std::span<const DepthInterval> intervals) {
  cl::Buffer buffer = empty_bounds(2, far_away, -far_away);
  std::vector<float> values(size_t(params_.bins_x) * params_.bins_y * 2 * BIN_SIZE);
  device_.queue().enqueueReadBuffer(buffer, CL_TRUE, 0, values.size() * sizeof(float), values.data());
  for (size_t i = 0; i < intervals.size(); ++i) {
    const uint tx = uint(i) % params_.tiles_x, ty = uint(i) / params_.tiles_x;
    const bool some = intervals[i].near <= intervals[i].far;
    values[bounds_index(params_, 2, 0, tx, ty)] = some ? std::clamp(intervals[i].near, -far_away, far_away) : far_away;
    values[bounds_index(params_, 2, 1, tx, ty)] = some ? std::clamp(intervals[i].far, -far_away, far_away) : -far_away;
  }
  device_.queue().enqueueWriteBuffer(buffer, CL_TRUE, 0, values.size() * sizeof(float), values.data());
  return {buffer, DepthBoundsMode::minmax};
}

std::vector<DepthInterval> LightCuller::read_bounds(const TileBounds& bounds) {
  const int planes = planes_of(bounds.mode);
  std::vector<float> values(size_t(params_.bins_x) * params_.bins_y * planes * BIN_SIZE);
  device_.queue().enqueueReadBuffer(bounds.values, CL_TRUE, 0, values.size() * sizeof(float), values.data());
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

CullInputs LightCuller::read_inputs(const TileBounds& bounds) {
  follow_eye();
  upload_params();
  CullInputs in{params_, bounds.mode, {}, {}, {}};
  const auto read = [&](const cl::Buffer& buffer, auto& values, size_t count) {
    values.resize(count);
    if (count) device_.queue().enqueueReadBuffer(buffer, CL_TRUE, 0, count * sizeof values[0], values.data());
  };
  if (light_count_) read(lights_->get(), in.lights, world_arrays * size_t(light_stride_));
  read(bounds.values, in.bounds, size_t(params_.bins_x) * params_.bins_y * planes_of(bounds.mode) * BIN_SIZE);
  constexpr float endless = std::numeric_limits<float>::infinity();
  if (params_.slices > 1) read(slices_, in.slices, params_.slices);
  else in.slices.emplace_back(-endless, endless);
  return in;
}

CullPipeline& LightCuller::pipeline(DepthBoundsMode mode) {
  PipelineOptions options;
  // Asked at the first cull: who wants depth bounds alone builds nothing else.
  if (!avx512_) avx512_ = !options_.portable && options_.shape == KernelShape::lanes && builds_avx512(device_, programs_);
  options.avx512 = *avx512_;
  options.slices = params_.slices > 1;
  options.group_size = options_.group_size;
  options.cones = cones_;
  options.index_bytes = options_.index_bits == 32 || light_count_ > 65536 ? 4 : 2;
  options.light_defines = fmt::format("-DCULL_TEST={}{}", int(options_.cull_test), cones_ ? " -DSPOTS" : "");
  options.defines = fmt::format("{} -DDEPTH_MODE={}{}{}", options.light_defines, int(mode),
                                options.slices ? " -DSLICES" : "", options.index_bytes == 4 ? " -DINDEX_32" : "");
  std::unique_ptr<CullPipeline>& made = pipelines_[int(mode)];
  if (!made || made->options != options) {
    made = options_.shape == KernelShape::lanes ? make_lanes_pipeline(device_, programs_, options)
                                                : make_group_pipeline(device_, programs_, options);
  }
  return *made;
}

LightGrid LightCuller::cull(const TileBounds& bounds, GridStorage& storage) {
  LightGrid grid;
  grid.cells_x = int(params_.tiles_x), grid.cells_y = int(params_.tiles_y), grid.slices = int(params_.slices);
  grid.index_bits = options_.index_bits == 32 || light_count_ > 65536 ? 32 : 16;
  grid.cell_bytes = size_t(grid.cells_x) * grid.cells_y * grid.slices * sizeof(cl_uint2);
  const size_t index_bytes = grid.index_bits / 8, largest = device_.info().max_allocation_bytes;
  if (grid.cell_bytes > largest) {
    throw machine_error("light culling: {} x {} x {} cells need more memory than {} allows; use larger tiles or fewer slices",
                        grid.cells_x, grid.cells_y, grid.slices, device_.info().name);
  }
  cl::Buffer cells = storage.cells(grid.cell_bytes);
  if (light_count_ == 0) {
    device_.queue().enqueueFillBuffer(cells, cl_uint(0), 0, grid.cell_bytes);
    storage.indices(0);
    if (options_.lists == GridLists::masks) storage.masks(0);
    if (z_bin_count_ > 1) storage.z_bins(0);
    device_.queue().finish();
    return grid;
  }
  follow_eye();
  CullPipeline& kernels = pipeline(bounds.mode);
  params_.pool_blocks = std::max(params_.pool_blocks, 2048 + light_stride_ / 4);
  params_.staging_units = std::max(params_.staging_units, params_.tiles_x * params_.tiles_y * 4);
  index_capacity_ = std::max<size_t>(index_capacity_, size_t(params_.tiles_x) * params_.tiles_y * 64);
  // The whole chain is enqueued at the sizes of last time, with one wait at its end; where something did not fit, nothing
  // was written past its room, and the chain runs again with more.
  for (;;) {
    cl::Buffer indices = storage.indices(index_capacity_ * index_bytes);
    upload_params();
    if (z_bin_count_ > 1) enqueue_z_bins(grid, storage);
    kernels.prepare(params_);
    kernels.enqueue({params_, params_buffer_, lights_->get(), bounds.values, slices_, counters_, cells, indices});
    cl_uint counters[8];
    device_.queue().enqueueReadBuffer(counters_, CL_TRUE, 0, sizeof counters, counters);
    const uint64_t total = counters[4] | uint64_t(counters[5]) << 32;
    const auto grown = [&](uint64_t wanted, uint64_t unit_bytes, const char* what) {
      const uint64_t most = std::min<uint64_t>(0xffffffffu, largest / unit_bytes);
      if (wanted > most) {
        throw machine_error("light culling: {} {} need more memory than {} allows; use fewer or smaller lights", wanted, what,
                            device_.info().name);
      }
      return std::min(most, wanted + wanted / 4);
    };
    if (counters[0] > params_.pool_blocks) {
      params_.pool_blocks = uint(grown(counters[0], 16 * kernels.candidate_bytes(), "blocks of 16 candidate lights"));
    } else if (counters[1] > params_.staging_units) {
      params_.staging_units = uint(grown(counters[1], 64, "units of 16 list entries"));
    } else if (total > index_capacity_) {
      index_capacity_ = grown(total, index_bytes, "light indices");
    } else if (counters[3]) {  // what was asked for went round 2^32
      throw machine_error("light culling: candidates and lists need more memory than {} can be asked for; use fewer or smaller lights",
                          device_.info().name);
    } else {
      grid.index_count = total;
      grid.index_bytes = total * index_bytes;
      if (options_.lists == GridLists::masks) make_masks(grid, storage);
      return grid;
    }
  }
}

void LightCuller::enqueue_z_bins(LightGrid& grid, GridStorage& storage) {
  grid.z_bin_bytes = light_count_ * sizeof(cl_uint);
  if (!z_bins_kernel_()) z_bins_kernel_ = programs_.kernel("light_z_bins", "");
  launch(device_, "light_z_bins", z_bins_kernel_, cl::NDRange((light_count_ + z_bin_group - 1) / z_bin_group * z_bin_group),
         cl::NDRange(z_bin_group), lights_->get(), z_bins_, cl_uint(z_bin_count_), storage.z_bins(grid.z_bin_bytes),
         params_buffer_);
}

void LightCuller::make_masks(LightGrid& grid, GridStorage& storage) {
  const size_t cells = grid.cell_bytes / sizeof(cl_uint2), largest = device_.info().max_allocation_bytes;
  grid.mask_words = (light_count_ + 31) / 32;
  grid.mask_bytes = cells * grid.mask_words * sizeof(cl_uint);
  if (grid.mask_bytes > largest) {
    throw machine_error("light culling: masks of {} cells for {} lights need {} bytes, more than {} allows; use lists, larger "
                        "tiles or fewer slices", cells, light_count_, grid.mask_bytes, device_.info().name);
  }
  cl::Kernel& kernel = masks_kernels_[grid.index_bits == 32];
  if (!kernel()) kernel = programs_.kernel("lists_to_masks", grid.index_bits == 32 ? "-DINDEX_32" : "");
  launch(device_, "lists_to_masks", kernel, cl::NDRange((cells + mask_group - 1) / mask_group * mask_group),
         cl::NDRange(mask_group), storage.cells(grid.cell_bytes), storage.indices(grid.index_bytes), cl_uint(cells),
         cl_uint(grid.mask_words), storage.masks(grid.mask_bytes));
}

uint32_t LightCuller::strange_tiles() {
  cl_uint count = 0;
  device_.queue().enqueueReadBuffer(counters_, CL_TRUE, 2 * sizeof count, sizeof count, &count);
  const cl_uint zero = 0;
  device_.queue().enqueueWriteBuffer(counters_, CL_TRUE, 2 * sizeof zero, sizeof zero, &zero);
  return count;
}

size_t LightCuller::memory_bytes() const {
  size_t bytes = sizeof(CullParams) + world_arrays * size_t(light_stride_) * sizeof(float) + bounds_bytes_ * (options_.blend ? 2 : 1);
  if (straight_depth_) bytes += straight_depth_->bytes();
  for (const auto& pipeline : pipelines_) bytes += pipeline ? pipeline->memory_bytes() : 0;
  return bytes;
}

}  // namespace lightgrid
