#include "culling/light_culler.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/error.h"
#include "cl/transfer.h"
#include "culling/culler_state.h"
#include "culling/light_arrays.h"
#include "culling/view_depth.h"
#include "shared/cull_tests.h"

namespace lightgrid {
namespace {

constexpr uint lane_count = 16;
constexpr uint max_regions = 64, max_region_bins = 16;
constexpr size_t max_lights =
    size_t(1) << 30;  // kernels count lights, and a bin's pairs of lights and tiles, in 32 bits

void check_option(const char* name, int value, std::initializer_list<int> allowed) {
  if (std::ranges::find(allowed, value) != allowed.end()) return;
  throw input_error("culler options: {} is {}, not one of {}", name, value, fmt::join(allowed, ", "));
}

void check_row(const char* name, int value, int rows) {
  if (value < 0 || value >= rows)
    throw input_error("culler options: {} is {}, not from 0 to {}", name, value, rows - 1);
}

// Throws Error(input) that names the option, its value and the allowed values.
void check_options(const CullerOptions& o) {
  check_row("cull_test", int(o.cull_test), int(std::size(cull_tests)));
  check_row("depth_bounds", int(o.depth_bounds), int(std::size(depth_bounds_modes)));
  check_option("shape", int(o.shape), {0, 1, 2});
  check_option("tile", o.tile, {8, 16, 32, 64});
  check_option("depth_format", int(o.depth_format), {0, 1, 2});
  check_option("samples", o.samples, {1, 2, 4, 8});
  check_option("lists", int(o.lists), {0, 1});
  check_option("index_bits", o.index_bits, {0, 16, 32});
  check_option("group_size", o.group_size, {0, 64, 128, 256, 512, 1024});
}

}  // namespace

LightCuller::State::State(ClDevice& device, ProgramCache& programs, const CullerOptions& options)
    : device_(device), programs_(programs), options_(options) {
  check_options(options);
  if (options_.shape == KernelShape::automatic) {
    options_.shape = device.info().cpu ? KernelShape::lanes : KernelShape::group;
  }
  counters_ = device_buffer(device_, counter_count * sizeof(cl_uint));
  fill_buffer(device_, "light culling: counters", counters_, 0, counter_count * sizeof(cl_uint));
  slices_ = device_buffer(device_, 0);
}

void LightCuller::State::require_view(const char* call) const {
  if (params_.tiles_x == 0) throw input_error("light culler: set_view has to come before {}", call);
}

void LightCuller::State::require_bounds(const TileBounds& bounds, const char* call) const {
  if (!bounds.values() || !bounds.view) throw input_error("light culler: {} was given no bounds", call);
  if (*bounds.view != view_)
    throw input_error("light culler: {} was given bounds of another view; make them after set_view", call);
}

void LightCuller::State::set_lights(std::span<const CullLight> lights) {
  if (lights.size() >= max_lights) {
    throw machine_error("light culling: {} lights are more than kernels can count; {} are the most",
                        lights.size(), max_lights - 1);
  }
  light_count_ = uint(lights.size());
  light_stride_ = (light_count_ + lane_count - 1) / lane_count * lane_count;
  cones_ =
      std::any_of(lights.begin(), lights.end(), [](const CullLight& light) { return light.cos_outer >= 0; });
  host_lights_.assign(lights.begin(), lights.end());
  const LightOrigin origin = choose_origin(lights);
  fixed_origin_ = origin.fixed;
  cone_slack_m_ = origin.cone_slack_m;
  uploaded_origin_.reset();
  masks_uploaded_ = false;
  if (fixed_origin_) upload_lights(*fixed_origin_, farthest_surface);
}

void LightCuller::State::upload_lights(const glm::dvec3& origin, double eye_reach) {
  uploaded_origin_.reset();
  if (!host_lights_.empty()) {
    const std::vector<float> values = light_arrays(host_lights_, origin, eye_reach, light_stride_);
    const size_t bytes = values.size() * sizeof(float);
    write_buffer(device_, "light culling: lights", lights_.at_least(device_, bytes), values.data(), bytes);
  }
  uploaded_origin_ = origin;
}

// Uploads the positions relative to the eye if no fixed origin is accurate enough.
void LightCuller::State::follow_eye() {
  const bool fixed =
      fixed_origin_ && glm::length(view_.eye * 0.5 - *fixed_origin_ * 0.5) < farthest_surface / 2;
  const glm::dvec3 origin = fixed ? *fixed_origin_ : view_.eye;
  params_.cone_slack_m = fixed && cones_ ? rounded_up(cone_slack_m_) : 0.0f;
  if (uploaded_origin_ != origin) upload_lights(origin, fixed ? farthest_surface : 0);
}

void LightCuller::State::set_view(const CullView& view) {
  check_view(view, options_.tile);
  oblique_.reset();
  if (is_oblique(view)) {
    oblique_ = straightened(view, options_.depth_format, options_.samples);
  }
  const Room kept = room();
  const bool was_orthographic = params_.orthographic;
  params_ = cull_params(oblique_ ? oblique_->view : view, options_.tile);
  set_room(kept);
  params_.inset = options_.pixel_centres && options_.samples == 1 ? 0.5f : 0.0f;
  params_.depth_step =
      oblique_ ? oblique_->depth_step : depth_step(options_.depth_format, params_.standard_depth);
  view_ = {view.width, view.height, options_.tile, view.clip_from_view, glm::dmat3(view.view_from_world),
           view.eye};
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
    bounds_view_.reset();
  }
}

void LightCuller::State::choose_regions() {
  params_.region_bins = 4;
  const auto regions = [&](uint bins) { return (bins + params_.region_bins - 1) / params_.region_bins; };
  while (regions(params_.bins_x) * regions(params_.bins_y) > max_regions &&
         params_.region_bins < max_region_bins) {
    params_.region_bins *= 2;
  }
  params_.regions_x = regions(params_.bins_x);
  params_.regions_y = regions(params_.bins_y);
}

void LightCuller::State::upload_params() {
  choose_regions();
  params_.light_count = light_count_;
  params_.light_stride = light_stride_;
  const glm::dvec3 eye = view_.eye - uploaded_origin_.value_or(view_.eye);
  const TwoFloats x = two_floats(eye.x), y = two_floats(eye.y), z = two_floats(eye.z);
  params_.eye_x = x.value;
  params_.eye_y = y.value;
  params_.eye_z = z.value;
  params_.eye_rest_x = x.rest;
  params_.eye_rest_y = y.rest;
  params_.eye_rest_z = z.rest;
  if (uploaded_ && std::memcmp(&*uploaded_, &params_, sizeof params_) == 0) return;
  uploaded_.reset();
  params_upload_.put(device_, "light culling: parameters", std::vector<CullParams>{params_});
  uploaded_ = params_;
}

CullInputs LightCuller::State::read_inputs(const TileBounds& bounds) {
  require_view("read_inputs");
  require_bounds(bounds, "read_inputs");
  follow_eye();
  upload_params();
  CullInputs in{params_, bounds.mode, {}, {}, {}};
  const auto read = [&](const cl::Buffer& buffer, auto& values, size_t count) {
    values.resize(count);
    read_buffer(device_, "light culling: inputs", buffer, values.data(), count * sizeof values[0]);
  };
  if (light_count_) read(lights_.get(), in.lights, world_arrays * size_t(light_stride_));
  read(bounds.values, in.bounds, size_t(params_.bins_x) * params_.bins_y * planes_of(bounds.mode) * BIN_SIZE);
  constexpr float endless = std::numeric_limits<float>::infinity();
  if (params_.slices > 1)
    read(slices_, in.slices, params_.slices);
  else
    in.slices.emplace_back(-endless, endless);
  return in;
}

size_t LightCuller::State::memory_bytes() const {
  size_t bytes = sizeof(CullParams) + world_arrays * size_t(light_stride_) * sizeof(float) +
                 bounds_bytes_ * (options_.blend ? 2 : 1);
  bytes += straight_depth_.bytes() + light_masks_.bytes();
  for (const auto& of_masks : pipelines_) {
    for (const auto& pipeline : of_masks) bytes += pipeline ? pipeline->memory_bytes() : 0;
  }
  return bytes;
}

LightCuller::LightCuller(ClDevice& device, ProgramCache& programs, const CullerOptions& options)
    : state_(std::make_unique<State>(device, programs, options)) {}
LightCuller::~LightCuller() = default;
LightCuller::LightCuller(LightCuller&&) noexcept = default;

void LightCuller::set_lights(std::span<const CullLight> lights) { state_->set_lights(lights); }
void LightCuller::set_view(const CullView& view) { state_->set_view(view); }
DepthBounds LightCuller::depth_bounds(const DepthInput& depth) { return state_->depth_bounds(depth); }
TileBounds LightCuller::bounds_of(std::span<const DepthInterval> intervals) {
  return state_->bounds_of(intervals);
}
std::vector<DepthInterval> LightCuller::read_bounds(const TileBounds& bounds) {
  return state_->read_bounds(bounds);
}
LightGrid LightCuller::cull(const TileBounds& bounds, GridStorage& storage) {
  return state_->cull(bounds, storage);
}
CullInputs LightCuller::read_inputs(const TileBounds& bounds) { return state_->read_inputs(bounds); }
uint32_t LightCuller::invalid_depth_tiles() { return state_->invalid_depth_tiles(); }
size_t LightCuller::memory_bytes() const { return state_->memory_bytes(); }
KernelShape LightCuller::shape() const { return state_->shape(); }
const CullParams& LightCuller::params() const { return state_->params(); }

struct ClGridStorage::State {
  ClDevice& device;
  GrowingBuffer cells{}, indices{}, masks{}, z_bins{};
};

ClGridStorage::ClGridStorage(ClDevice& device) : state_(new State{device}) {}
ClGridStorage::~ClGridStorage() = default;

cl::Buffer& ClGridStorage::cells(size_t bytes) { return state_->cells.at_least(state_->device, bytes); }
cl::Buffer& ClGridStorage::indices(size_t bytes) { return state_->indices.at_least(state_->device, bytes); }
cl::Buffer& ClGridStorage::masks(size_t bytes) { return state_->masks.at_least(state_->device, bytes); }
cl::Buffer& ClGridStorage::z_bins(size_t bytes) { return state_->z_bins.at_least(state_->device, bytes); }

HostGrid read_grid(ClDevice& device, const LightGrid& grid, GridStorage& storage) {
  HostGrid host{grid.cells_x, grid.cells_y, grid.slices, {}, {}, {}, {}};
  const auto read = [&](const cl::Buffer& from, auto& values, size_t bytes) {
    values.resize(bytes / sizeof values[0]);
    read_buffer(device, "reading the light grid", from, values.data(), bytes);
  };
  if (grid.z_bin_bytes) read(storage.z_bins(grid.z_bin_bytes), host.z_bins, grid.z_bin_bytes);
  if (grid.mask_bytes) read(storage.masks(grid.mask_bytes), host.masks, grid.mask_bytes);
  read(storage.cells(grid.cell_bytes), host.cells, grid.cell_bytes);
  if (grid.index_count == 0) return host;
  if (grid.index_bits == 32) {
    read(storage.indices(grid.index_bytes), host.indices, grid.index_bytes);
    return host;
  }
  std::vector<uint16_t> narrow;
  read(storage.indices(grid.index_bytes), narrow, grid.index_bytes);
  host.indices.assign(narrow.begin(), narrow.end());
  return host;
}

}  // namespace lightgrid
