// Buffers that grow, and the way of a grid back to the host.
#include <fmt/format.h>

#include <algorithm>

#include "cl/error.h"
#include "cl/transfer.h"
#include "culling/cull_pipeline.h"
#include "culling/light_culler.h"

namespace lightgrid {

cl::Buffer device_buffer(ClDevice& device, size_t bytes) {
  try {
    return {device.context(), CL_MEM_READ_WRITE, std::max<size_t>(bytes, 64)};
  } catch (const cl::Error& error) {
    throw cl_machine_error(error, fmt::format("light culling: {} bytes", bytes));
  }
}

// The old buffer goes first, so that both need not fit at once.
static void grow(ClDevice& device, size_t bytes, cl::Buffer& buffer, size_t& size) {
  if (bytes <= size && buffer()) return;
  buffer = cl::Buffer(), size = 0;
  buffer = device_buffer(device, bytes), size = bytes;
}

cl::Buffer& GrowingBuffer::at_least(ClDevice& device, size_t bytes) {
  grow(device, bytes, buffer_, bytes_);
  return buffer_;
}

cl::Buffer& ClGridStorage::grown(cl::Buffer& buffer, size_t& size, size_t bytes) {
  grow(device_, bytes, buffer, size);
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
