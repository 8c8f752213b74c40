// The part of LightCuller that turns lights and bounds into a grid.
#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "cl/launch.h"
#include "cl/transfer.h"
#include "culling/culler_state.h"
#include "shared/cull_tests.h"

namespace lightgrid {

static constexpr uint mask_group = 64, z_bin_group = 64;
static constexpr size_t max_entries = 0xffffffffu;

CullPipeline& LightCuller::State::pipeline(const TileBounds& bounds) {
  PipelineOptions options;
  // Depth bounds alone need no cull kernels: they are built at the first cull.
  options.portable = options_.portable;
  options.slices = params_.slices > 1;
  options.group_size = options_.group_size;
  options.cones = cones_;
  options.masks = bounds.masks() != nullptr;
  options.index_bytes = options_.index_bits == 32 || light_count_ > 65536 ? 4 : 2;
  options.light_defines = fmt::format("-DCULL_TEST={}{}", int(options_.cull_test), cones_ ? " -DSPOTS" : "");
  options.cell_defines =
      fmt::format("{} -DDEPTH_MODE={}{}{}", options.light_defines, int(bounds.mode),
                  options.slices ? " -DSLICES" : "", options.masks ? " -DSURFACE_MASKS" : "");
  std::unique_ptr<CullPipeline>& made = made_pipeline(bounds);
  if (!made || made->options != options) {
    made = options_.shape == KernelShape::lanes ? make_cull_cpu_pipeline(device_, programs_, options)
                                                : make_cull_gpu_pipeline(device_, programs_, options);
  }
  return *made;
}

LightGrid LightCuller::State::cull(const TileBounds& bounds, GridStorage& storage) {
  require_view("cull");
  require_bounds(bounds, "cull");
  LightGrid grid;
  grid.cells_x = int(params_.tiles_x);
  grid.cells_y = int(params_.tiles_y);
  grid.slices = int(params_.slices);
  grid.index_bits = options_.index_bits == 32 || light_count_ > 65536 ? 32 : 16;
  const size_t cell_count = size_t(grid.cells_x) * grid.cells_y * grid.slices;
  grid.cell_bytes = cell_count * sizeof(cl_uint2);
  if (cell_count > max_entries || grid.cell_bytes > device_.info().max_allocation_bytes) {
    throw machine_error(
        "light culling: {} x {} x {} cells need more memory than {} allows; use larger tiles or fewer slices",
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
    if (bounds.masks()) upload_masks();
    const Room before = room();
    try {
      cull_into(grid, bounds, storage, cells);
    } catch (...) {
      set_room(before);
      made_pipeline(bounds).reset();  // frees its buffers
      throw;
    }
    if (options_.lists == GridLists::masks) make_masks(grid, storage);
  }
  return grid;
}

void LightCuller::State::upload_masks() {
  if (masks_uploaded_) return;
  std::vector<cl_uint> masks;
  for (const CullLight& light : host_lights_) masks.push_back(light.mask);
  const size_t bytes = masks.size() * sizeof masks[0];
  write_buffer(device_, "light culling: masks", light_masks_.at_least(device_, bytes), masks.data(), bytes);
  masks_uploaded_ = true;
}

void LightCuller::State::set_room(const Room& room) {
  params_.pool_batches = room.pool_batches;
  params_.staging_units = room.staging_units;
  params_.index_capacity = room.index_capacity;
}

// The last grid's sizes, or an estimate.
LightCuller::State::Room LightCuller::State::first_room(size_t index_bytes) const {
  const size_t tiles = size_t(params_.tiles_x) * params_.tiles_y;
  const size_t max_indices = std::min(max_entries, device_.info().max_allocation_bytes / index_bytes);
  return {std::max(params_.pool_batches, 2048 + light_stride_ / 4),
          std::max(params_.staging_units, uint(tiles * 4)),
          uint(std::min(max_indices, std::max<size_t>(params_.index_capacity, tiles * 64)))};
}

// The whole chain is enqueued with the last call's sizes, with one wait at its end. If something did not fit,
// nothing was written out of bounds; the chain runs again with a quarter more than was needed, since lights
// and views move, or with exactly that if memory does not suffice for more.
void LightCuller::State::cull_into(LightGrid& grid, const TileBounds& bounds, GridStorage& storage,
                                   const cl::Buffer& cells) {
  const size_t index_bytes = grid.index_bits / 8, largest = device_.info().max_allocation_bytes;
  const char* advice =
      !row_of(options_.cull_test).planes
          ? "cull tests sphere and aabb count each light in every tile of the view: use planes, "
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
      made_pipeline(bounds).reset();
      set_room(needed);
      continue;
    }
    const uint64_t total = counters[4] | uint64_t(counters[5]) << 32;
    const auto grow = [&](uint64_t wanted, uint64_t unit_bytes, const char* what, uint Room::*size) {
      const uint64_t most = std::min<uint64_t>(max_entries, largest / unit_bytes);
      if (wanted > most) {
        throw machine_error("light culling: {} {} need more memory than {} allows; {}", wanted, what,
                            device_.info().name, advice);
      }
      needed.*size = uint(wanted);
      Room more = room();
      more.*size = uint(std::min(most, wanted + wanted / 4));
      set_room(more);
    };
    if (counters[0] > params_.pool_batches) {
      grow(counters[0], 16 * pipeline(bounds).candidate_bytes(), "batches of 16 candidate lights",
           &Room::pool_batches);
    } else if (counters[1] > params_.staging_units) {
      grow(counters[1], 64, "units of 16 list entries", &Room::staging_units);
    } else if (total > params_.index_capacity) {
      grow(total, index_bytes, "light indices", &Room::index_capacity);
    } else if (counters[3]) {  // the need exceeded 2^32
      throw machine_error("light culling: candidates and lists need more memory than {} can allocate; {}",
                          device_.info().name, advice);
    } else {
      grid.index_count = total;
      grid.index_bytes = total * index_bytes;
      return;
    }
  }
}

void LightCuller::State::run_kernels(LightGrid& grid, const TileBounds& bounds, GridStorage& storage,
                                     const cl::Buffer& cells, uint32_t (&counters)[counter_count]) {
  const cl::Buffer indices = storage.indices(params_.index_capacity * size_t(grid.index_bits / 8));
  CullPipeline& kernels = pipeline(bounds);
  upload_params();
  if (z_bin_count_ > 1) enqueue_z_bins(grid, storage);
  kernels.prepare(params_);
  kernels.enqueue({params_, params_upload_.buffer(), lights_.get(), light_masks_.get(), bounds.values,
                   bounds.masks, slices_, counters_, cells, indices});
  read_buffer(device_, "light culling", counters_, counters, sizeof counters);
}

void LightCuller::State::enqueue_z_bins(LightGrid& grid, GridStorage& storage) {
  grid.z_bin_bytes = light_count_ * sizeof(cl_uint);
  if (!z_bins_kernel_) z_bins_kernel_ = NamedKernel(programs_, "culling/light_z_bins", "");
  z_bins_kernel_.launch(device_, "light_z_bins",
                        cl::NDRange((light_count_ + z_bin_group - 1) / z_bin_group * z_bin_group),
                        cl::NDRange(z_bin_group),
                        {{"lights", lights_.get()},
                         {"bins", z_bins_},
                         {"bin_count", cl_uint(z_bin_count_)},
                         {"light_bins", storage.z_bins(grid.z_bin_bytes)},
                         {"p", params_upload_.buffer()}});
}

void LightCuller::State::make_masks(LightGrid& grid, GridStorage& storage) {
  const size_t cells = grid.cell_bytes / sizeof(cl_uint2), largest = device_.info().max_allocation_bytes;
  grid.mask_words = (light_count_ + 31) / 32;
  grid.mask_bytes = cells * grid.mask_words * sizeof(cl_uint);
  if (grid.mask_bytes > largest) {
    throw machine_error(
        "light culling: masks of {} cells for {} lights need {} bytes, more than {} allows; use lists, "
        "larger tiles or fewer slices",
        cells, light_count_, grid.mask_bytes, device_.info().name);
  }
  NamedKernel& kernel = masks_kernels_[grid.index_bits == 32];
  if (!kernel)
    kernel = NamedKernel(programs_, "culling/lists_to_masks", grid.index_bits == 32 ? "-DINDEX_32" : "");
  kernel.launch(device_, "lists_to_masks", cl::NDRange((cells + mask_group - 1) / mask_group * mask_group),
                cl::NDRange(mask_group),
                {{"cells", storage.cells(grid.cell_bytes)},
                 {"indices", storage.indices(grid.index_bytes)},
                 {"cell_count", cl_uint(cells)},
                 {"words", cl_uint(grid.mask_words)},
                 {"masks", storage.masks(grid.mask_bytes)}});
  finish_queue(device_, "lists_to_masks");
}

}  // namespace lightgrid
