// Buffers that grow, and the way of a grid back to the host.
#include <fmt/format.h>

#include <algorithm>

#include "cl/error.h"
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

cl::Buffer& GrowingBuffer::at_least(ClDevice& device, size_t bytes) {
  if (bytes > bytes_ || !buffer_()) buffer_ = device_buffer(device, bytes), bytes_ = bytes;
  return buffer_;
}

cl::Buffer& ClGridStorage::grown(cl::Buffer& buffer, size_t& size, size_t bytes) {
  if (bytes > size || !buffer()) buffer = device_buffer(device_, bytes), size = bytes;
  return buffer;
}

HostGrid read_grid(ClDevice& device, const LightGrid& grid, GridStorage& storage) {
  HostGrid host{grid.cells_x, grid.cells_y, grid.slices, {}, {}, {}, {}};
  host.z_bins.resize(grid.z_bin_bytes / sizeof(cl_uint));
  if (grid.z_bin_bytes) device.queue().enqueueReadBuffer(storage.z_bins(grid.z_bin_bytes), CL_TRUE, 0, grid.z_bin_bytes, host.z_bins.data());
  host.masks.resize(grid.mask_bytes / sizeof(cl_uint));
  if (grid.mask_bytes) device.queue().enqueueReadBuffer(storage.masks(grid.mask_bytes), CL_TRUE, 0, grid.mask_bytes, host.masks.data());
  host.cells.resize(grid.cell_bytes / sizeof(glm::uvec2));
  host.indices.resize(grid.index_count);
  device.queue().enqueueReadBuffer(storage.cells(grid.cell_bytes), CL_TRUE, 0, grid.cell_bytes, host.cells.data());
  if (grid.index_count == 0) return host;
  if (grid.index_bits == 32) {
    device.queue().enqueueReadBuffer(storage.indices(grid.index_bytes), CL_TRUE, 0, grid.index_bytes, host.indices.data());
    return host;
  }
  std::vector<uint16_t> narrow(grid.index_count);
  device.queue().enqueueReadBuffer(storage.indices(grid.index_bytes), CL_TRUE, 0, grid.index_bytes, narrow.data());
  std::copy(narrow.begin(), narrow.end(), host.indices.begin());
  return host;
}

}  // namespace lightgrid
