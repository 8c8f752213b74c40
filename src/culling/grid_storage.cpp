// Storage of a grid in OpenCL, and reading a grid back to the host.
#include "cl/growing_buffer.h"
#include "cl/transfer.h"
#include "culling/light_culler.h"

namespace lightgrid {

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
