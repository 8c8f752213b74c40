#include "culling/light_culler.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/error.h"
#include "cl/avx512.h"
#include "cl/launch.h"
#include "cl/transfer.h"
#include "culling/cull_pipeline.h"
#include "culling/culler_options.h"
#include "culling/light_arrays.h"
#include "culling/oblique_view.h"
#include "culling/two_floats.h"
#include "shared/cull_tests.h"
#include "shared/light_grid.h"

namespace lightgrid {
namespace {

constexpr float widen = 4.8e-7f;    // as kernels/common/depth_interval.h
constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr uint lane_count = 16, usual_depth_group = 256, depth_tiles_an_item = 16, mask_group = 64, z_bin_group = 64;
constexpr uint most_regions = 64, most_region_bins = 16;
constexpr size_t most_lights = size_t(1) << 30;  // kernels count lights, and a bin's pairs of lights and tiles, in 32 bits
constexpr size_t most_entries = 0xffffffffu;
constexpr size_t counter_count = 8;
// Used in turn: depth_bounds counts in one and clears the other, which costs less than a separate fill.
constexpr uint invalid_tiles_counters[2] = {2, 6};

int planes_of(DepthBoundsMode mode) {
  if (mode == DepthBoundsMode::halfz || mode == DepthBoundsMode::halfz_modified) return 4;
  return mode == DepthBoundsMode::mask32 ? 3 : 2;
}

float rounded_up(double value) { return std::nextafter(float(value), infinity); }
float rounded_down(double value) { return std::nextafter(float(value), -infinity); }

// Index of a tile's value in plane `plane`: kernels/common/depth_bounds.h.
size_t bounds_index(const CullParams& p, int planes, int plane, uint tx, uint ty) {
  const size_t bin = size_t(ty / BIN_TILES) * p.bins_x + tx / BIN_TILES;
  return (bin * planes + plane) * BIN_SIZE + slot_of_tile(tx % BIN_TILES, ty % BIN_TILES);
}

size_t bounds_bytes(const CullParams& p, int planes) {
  return size_t(p.bins_x) * p.bins_y * planes * BIN_SIZE * sizeof(float);
}

size_t bytes_of(const cl::Buffer& buffer) {
  size_t bytes = 0;
  if (buffer()) clGetMemObjectInfo(buffer(), CL_MEM_SIZE, sizeof bytes, &bytes, nullptr);
  return bytes;
}

// One step of the stored format if it is coarser than the slack covers, else 0. 32-bit floats near 1, where
// standard depth stores far surfaces, are up to 2^-24 apart; near 0, where reversed depth stores them, much
// less.
float depth_step(DepthFormat format, bool standard_depth) {
  if (format == DepthFormat::d16) return 1.0f / 65535;
  if (format == DepthFormat::d24) return 1.0f / 16777215;
  return standard_depth ? float(half_ulp) : 0.0f;
}

// Near and far of each range between two edges, metres. A pixel's range follows from comparing its stored
// depth with the edges' keys, so a range ends at its key, which differs from the edge by the key's own
// rounding: centimetres in standard depth near 1. One step of the depth format on either side covers the
// surface's true distance; a rounding term covers the distance that shading computes.
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
  counters_ = device_buffer(device_, counter_count * sizeof(cl_uint));
  fill_buffer(device_, "light culling: counters", counters_, 0, counter_count * sizeof(cl_uint));
  slices_ = device_buffer(device_, 0);
}

LightCuller::~LightCuller() = default;
LightCuller::LightCuller(LightCuller&&) noexcept = default;

void LightCuller::require_view(const char* call) const {
  if (params_.tiles_x == 0) throw input_error("light culler: set_view has to come before {}", call);
}

void LightCuller::require_bounds(const TileBounds& bounds, const char* call) const {
  const size_t bytes = bounds_bytes(params_, planes_of(bounds.mode)), given = bytes_of(bounds.values);
  if (given < bytes) {
    throw input_error("light culler: {} was given bounds of {} bytes; those of this view have {}", call, given, bytes);
  }
}

void LightCuller::set_lights(std::span<const CullLight> lights) {
  if (lights.size() >= most_lights) {
    throw machine_error("light culling: {} lights are more than kernels can count; {} are the most", lights.size(),
                        most_lights - 1);
  }
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
  uploaded_origin_.reset();
  if (!host_lights_.empty()) {
    const std::vector<float> values = light_arrays(host_lights_, origin, eye_reach, light_stride_);
    const size_t bytes = values.size() * sizeof(float);
    write_buffer(device_, "light culling: lights", lights_->at_least(device_, bytes), values.data(), bytes);
  }
  uploaded_origin_ = origin;
}

// Uploads the positions relative to the eye if no fixed origin is accurate enough.
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
  const Room kept = room();
  const bool was_orthographic = params_.orthographic;
  params_ = cull_params(oblique_ ? oblique_->view : view, options_.tile);
  set_room(kept);
  params_.inset = options_.pixel_centres && options_.samples == 1 ? 0.5f : 0.0f;
  params_.depth_step = oblique_ ? oblique_->depth_step : depth_step(options_.depth_format, params_.standard_depth);
  eye_ = view.eye;
  const auto upload = [&](cl::Buffer& buffer, const std::vector<cl_float2>& ranges) {
    if (ranges.size() == 1) return;
    buffer = device_buffer(device_, ranges.size() * sizeof ranges[0]);
    write_buffer(device_, "light culling: slices", buffer, ranges.data(), ranges.size() * sizeof ranges[0]);
  };
  upload(slices_, ranges_between(view, view.slice_edges, slice_keys(view), params_));
  upload(z_bins_, ranges_between(view, view.z_bin_edges, z_bin_keys(view), params_));
  z_bin_count_ = uint(view.z_bin_edges.size() + 1);
  const glm::uvec2 tiles(params_.tiles_x, params_.tiles_y);
  if (tiles != bounds_tiles_ || was_orthographic != bool(params_.orthographic)) {
    bounds_tiles_ = tiles;
    opaque_ = blend_ = cl::Buffer();
  }
}

// Slots outside the view stay empty; those inside get `near` and `far`.
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
  write_buffer(device_, "light culling: bounds", buffer, values.data(), values.size() * sizeof(float));
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
  const glm::dvec3 eye = eye_ - uploaded_origin_.value_or(eye_);
  const TwoFloats x = two_floats(eye.x), y = two_floats(eye.y), z = two_floats(eye.z);
  params_.eye_x = x.value, params_.eye_y = y.value, params_.eye_z = z.value;
  params_.eye_rest_x = x.rest, params_.eye_rest_y = y.rest, params_.eye_rest_z = z.rest;
  if (uploaded_ && std::memcmp(&*uploaded_, &params_, sizeof params_) == 0) return;
  uploaded_.reset();
  enqueue_bytes(device_, "light culling: parameters", params_buffer_, &params_, sizeof params_);
  uploaded_ = params_;
}

// Where kernels find the view's values in the depth buffer.
void LightCuller::read_layout(const DepthInput& depth) {
  if (!depth.values()) throw input_error("depth_bounds: there is no buffer of depth values");
  if (depth.x < 0) throw input_error("depth_bounds: x is {}", depth.x);
  if (depth.y < 0) throw input_error("depth_bounds: y is {}", depth.y);
  const uint64_t width = uint64_t(depth.x) + params_.width, samples = uint64_t(options_.samples);
  const uint64_t row = depth.row_pixels ? uint64_t(std::max(depth.row_pixels, 0)) : uint64_t(params_.width);
  if (row < width) {
    throw input_error("depth_bounds: row_pixels is {}, less than the {} that x and the view's width need", depth.row_pixels,
                      width);
  }
  const uint64_t values = ((uint64_t(depth.y) + params_.height - 1) * row + width) * samples;
  const size_t given = bytes_of(depth.values);
  if (given / sizeof(float) < values) {
    throw input_error("depth_bounds: the depth values are a buffer of {} bytes, fewer than the {} of {} rows of {} pixels with "
                      "{} samples", given, values * sizeof(float), depth.y + params_.height, row, samples);
  }
  const uint64_t first = (uint64_t(depth.y) * row + uint64_t(depth.x)) * samples;
  if (first > 0xffffffffu || row * samples > 0xffffffffu) {
    throw input_error("depth_bounds: y is {} and row_pixels {}: the view begins past 2^32 values", depth.y, row);
  }
  params_.depth_row = uint(row * samples), params_.depth_first = uint(first);
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
  require_view("depth_bounds");
  if (options_.depth_bounds == DepthBoundsMode::none) {
    const float near = params_.orthographic ? -far_away : 0.0f;
    if (!opaque_()) opaque_ = empty_bounds(2, near, far_away);
    invalid_tiles_counter_ = 0;
    return {{opaque_, DepthBoundsMode::minmax}, {options_.blend ? opaque_ : cl::Buffer(), DepthBoundsMode::minmax}};
  }
  read_layout(depth);
  const bool lanes = options_.shape == KernelShape::lanes;
  if (!opaque_()) opaque_ = empty_bounds(planes_of(options_.depth_bounds), far_away, -far_away);
  if (!blend_()) blend_ = options_.blend ? empty_bounds(2, far_away, -far_away) : device_buffer(device_, 0);
  // The kernel depends on the view's depth direction: it is rebuilt when that changes.
  if (!bounds_kernel_() || bounds_kernel_standard_ != bool(params_.standard_depth)) {
    bounds_kernel_standard_ = params_.standard_depth;
    std::string defines =
        fmt::format("-DTILE={} -DSAMPLES={} -DDEPTH_MODE={}{}{}", options_.tile, options_.samples, int(options_.depth_bounds),
                    params_.standard_depth ? " -DSTANDARD_DEPTH" : "", options_.blend ? " -DBLEND" : "");
    depth_group_ = usual_depth_group;
    while (depth_group_ > device_.info().max_group_items) depth_group_ /= 2;
    if (!lanes && depth_group_ != usual_depth_group) defines += fmt::format(" -DGROUP={}", depth_group_);
    bounds_kernel_ = programs_.kernel(lanes ? "depth_bounds_lanes" : "depth_bounds_group", defines);
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
  const uint counter = invalid_tiles_counter_ == invalid_tiles_counters[0] ? invalid_tiles_counters[1] : invalid_tiles_counters[0];
  const uint other = invalid_tiles_counters[0] + invalid_tiles_counters[1] - counter;
  launch(device_, "depth_bounds", bounds_kernel_, cl::NDRange((tiles_x + tiles - 1) / tiles * group, tiles_y),
         cl::NDRange(group, 1), values_in, opaque_, blend_, counters_, cl_uint(counter), cl_uint(other), params_buffer_);
  invalid_tiles_counter_ = counter;
  return {{opaque_, options_.depth_bounds}, {options_.blend ? blend_ : cl::Buffer(), DepthBoundsMode::minmax}};
}

TileBounds LightCuller::bounds_of(std::span<const DepthInterval> intervals) {
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
    values[bounds_index(params_, 2, 0, tx, ty)] = some ? std::clamp(intervals[i].near, -far_away, far_away) : far_away;
    values[bounds_index(params_, 2, 1, tx, ty)] = some ? std::clamp(intervals[i].far, -far_away, far_away) : -far_away;
  }
  write_buffer(device_, "light culling: bounds", buffer, values.data(), values.size() * sizeof(float));
  return {buffer, DepthBoundsMode::minmax};
}

std::vector<DepthInterval> LightCuller::read_bounds(const TileBounds& bounds) {
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

CullInputs LightCuller::read_inputs(const TileBounds& bounds) {
  require_view("read_inputs");
  require_bounds(bounds, "read_inputs");
  follow_eye();
  upload_params();
  CullInputs in{params_, bounds.mode, {}, {}, {}};
  const auto read = [&](const cl::Buffer& buffer, auto& values, size_t count) {
    values.resize(count);
    read_buffer(device_, "light culling: inputs", buffer, values.data(), count * sizeof values[0]);
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
  // Depth bounds alone need no cull kernels: they are built at the first cull.
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
  require_view("cull");
  require_bounds(bounds, "cull");
  LightGrid grid;
  grid.cells_x = int(params_.tiles_x), grid.cells_y = int(params_.tiles_y), grid.slices = int(params_.slices);
  grid.index_bits = options_.index_bits == 32 || light_count_ > 65536 ? 32 : 16;
  const size_t cell_count = size_t(grid.cells_x) * grid.cells_y * grid.slices;
  grid.cell_bytes = cell_count * sizeof(cl_uint2);
  if (cell_count > most_entries || grid.cell_bytes > device_.info().max_allocation_bytes) {
    throw machine_error("light culling: {} x {} x {} cells need more memory than {} allows; use larger tiles or fewer slices",
                        grid.cells_x, grid.cells_y, grid.slices, device_.info().name);
  }
  cl::Buffer cells = storage.cells(grid.cell_bytes);
  if (light_count_ == 0) {
    fill_buffer(device_, "light culling: cells", cells, 0, grid.cell_bytes);
    storage.indices(0);
    if (options_.lists == GridLists::masks) storage.masks(0);
    if (z_bin_count_ > 1) storage.z_bins(0);
    finish_queue(device_, "light culling: cells");
  } else {
    follow_eye();
    const Room before = room();
    try {
      cull_into(grid, bounds, storage, cells);
    } catch (...) {
      set_room(before);
      pipelines_[int(bounds.mode)].reset();  // frees its buffers
      throw;
    }
    if (options_.lists == GridLists::masks) make_masks(grid, storage);
  }
  return grid;
}

void LightCuller::set_room(const Room& room) {
  params_.pool_blocks = room.pool_blocks, params_.staging_units = room.staging_units;
  params_.index_capacity = room.index_capacity;
}

// The last grid's sizes, or an estimate.
LightCuller::Room LightCuller::first_room(size_t index_bytes) const {
  const size_t tiles = size_t(params_.tiles_x) * params_.tiles_y;
  const size_t most_indices = std::min(most_entries, device_.info().max_allocation_bytes / index_bytes);
  return {std::max(params_.pool_blocks, 2048 + light_stride_ / 4), std::max(params_.staging_units, uint(tiles * 4)),
          uint(std::min(most_indices, std::max<size_t>(params_.index_capacity, tiles * 64)))};
}

// The whole chain is enqueued with the last call's sizes, with one wait at its end. If something did not fit,
// nothing was written out of bounds; the chain runs again with a quarter more than was needed, since lights
// and views move, or with exactly that if memory does not suffice for more.
void LightCuller::cull_into(LightGrid& grid, const TileBounds& bounds, GridStorage& storage, const cl::Buffer& cells) {
  const size_t index_bytes = grid.index_bits / 8, largest = device_.info().max_allocation_bytes;
  const char* advice = !row_of(options_.cull_test).planes ? "cull tests sphere and aabb count each light in every tile of the view: use planes, "
                                        "planes_aabb or exact, or fewer lights"
                                      : "use fewer or smaller lights";
  Room needed{1, 1, 0};  // lower bounds so far
  set_room(first_room(index_bytes));
  for (;;) {
    cl_uint counters[counter_count];
    try {
      run_kernels(grid, bounds, storage, cells, counters);
    } catch (const Error&) {
      if (room() == needed) throw;
      pipelines_[int(bounds.mode)].reset();
      set_room(needed);
      continue;
    }
    const uint64_t total = counters[4] | uint64_t(counters[5]) << 32;
    const auto grow = [&](uint64_t wanted, uint64_t unit_bytes, const char* what, uint Room::*size) {
      const uint64_t most = std::min<uint64_t>(most_entries, largest / unit_bytes);
      if (wanted > most) {
        throw machine_error("light culling: {} {} need more memory than {} allows; {}", wanted, what, device_.info().name, advice);
      }
      needed.*size = uint(wanted);
      Room more = room();
      more.*size = uint(std::min(most, wanted + wanted / 4));
      set_room(more);
    };
    if (counters[0] > params_.pool_blocks) {
      grow(counters[0], 16 * pipeline(bounds.mode).candidate_bytes(), "blocks of 16 candidate lights", &Room::pool_blocks);
    } else if (counters[1] > params_.staging_units) {
      grow(counters[1], 64, "units of 16 list entries", &Room::staging_units);
    } else if (total > params_.index_capacity) {
      grow(total, index_bytes, "light indices", &Room::index_capacity);
    } else if (counters[3]) {  // the need exceeded 2^32
      throw machine_error("light culling: candidates and lists need more memory than {} can be asked for; {}",
                          device_.info().name, advice);
    } else {
      grid.index_count = total, grid.index_bytes = total * index_bytes;
      return;
    }
  }
}

void LightCuller::run_kernels(LightGrid& grid, const TileBounds& bounds, GridStorage& storage, const cl::Buffer& cells,
                              uint32_t (&counters)[counter_count]) {
  const cl::Buffer indices = storage.indices(params_.index_capacity * size_t(grid.index_bits / 8));
  CullPipeline& kernels = pipeline(bounds.mode);
  upload_params();
  if (z_bin_count_ > 1) enqueue_z_bins(grid, storage);
  kernels.prepare(params_);
  kernels.enqueue({params_, params_buffer_, lights_->get(), bounds.values, slices_, counters_, cells, indices});
  read_buffer(device_, "light culling", counters_, counters, sizeof counters);
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
  finish_queue(device_, "lists_to_masks");
}

uint32_t LightCuller::invalid_depth_tiles() {
  cl_uint count = 0;
  if (invalid_tiles_counter_ == 0) return count;
  read_buffer(device_, "light culling: counters", counters_, &count, sizeof count, invalid_tiles_counter_ * sizeof count);
  return count;
}

size_t LightCuller::memory_bytes() const {
  size_t bytes = sizeof(CullParams) + world_arrays * size_t(light_stride_) * sizeof(float) + bounds_bytes_ * (options_.blend ? 2 : 1);
  if (straight_depth_) bytes += straight_depth_->bytes();
  for (const auto& pipeline : pipelines_) bytes += pipeline ? pipeline->memory_bytes() : 0;
  return bytes;
}

}  // namespace lightgrid
