// Storage of a grid in OpenCL, and reading a grid back to the host.
#include "cl/growing_buffer.h"
#include "cl/transfer.h"
#include "culling/light_culler.h"

namespace lightgrid {

cl::Buffer& ClGridStorage::grown(cl::Buffer& buffer, size_t& size, size_t bytes) {
  if (bytes <= size && buffer()) return buffer;
  buffer = cl::Buffer(), size = 0;  // freed first, so that both need not fit at once
  buffer = device_buffer(device_, bytes), size = bytes;
  return buffer;
}

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
