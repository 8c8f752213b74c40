// The finished lists of a world grid for the host, and what they take.
#include "base/error.h"
#include "cl/transfer.h"
#include "world_grid/run.h"

namespace lightgrid {

// The device has a limit for one buffer, and entries are counted in 32 bits.
uint64_t most_world_count(ClDevice& device, size_t bytes_each) {
  return std::min<uint64_t>(std::numeric_limits<uint32_t>::max() - 1,
                            device.info().max_allocation_bytes / bytes_each);
}

void check_world_count(ClDevice& device, const char* what, uint64_t count, size_t bytes_each) {
  const uint64_t most = device.info().max_allocation_bytes;
  if (count <= most_world_count(device, bytes_each)) return;
  throw machine_error(
      "world grid: {} {} take {} bytes, more than the {} that this device gives to one buffer; use larger "
      "cells (world-cell), "
      "smaller ranges or fewer lights",
      count, what, count * bytes_each, most);
}

bool HostWorldGrid::operator==(const HostWorldGrid& other) const {
  return std::equal(reinterpret_cast<const char*>(&params), reinterpret_cast<const char*>(&params + 1),
                    reinterpret_cast<const char*>(&other.params)) &&
         buckets == other.buckets && keys == other.keys && cells == other.cells && indices == other.indices;
}

glm::uvec2 HostWorldGrid::range_at(const glm::vec3& p) const {
  return world_range(uint(world_coordinate(p.x, params.least_x, params.most_x)),
                     uint(world_coordinate(p.y, params.least_y, params.most_y)),
                     uint(world_coordinate(p.z, params.least_z, params.most_z)), params,
                     {buckets.data(), keys.data(), cells.data()});
}

std::span<const uint32_t> HostWorldGrid::everywhere() const {
  return std::span(indices).subspan(params.everywhere_first, params.everywhere_count);
}

size_t WorldGrid::memory_bytes() const {
  size_t bytes = 0;
  for (const WorldArray array : {WorldArray::buckets, WorldArray::keys, WorldArray::cells,
                                 WorldArray::indices, WorldArray::old_cells, WorldArray::old_indices})
    bytes += storage_->bytes(array);
  for (const UploadedBuffer* uploaded : {&params_, &lights_, &cones_, &levels_, &first_pairs_})
    bytes += uploaded->bytes();
  for (const GrowingBuffer* buffer :
       {&pairs_[0], &pairs_[1], &totals_, &total_, &counted_sum_, &block_first_, &members_, &full_first_,
        &full_members_, &masks_, &moved_lights_, &moved_balls_, &moved_cones_, &edits_, &edit_first_,
        &changes_, &old_blocks_}) {
    bytes += buffer->bytes();
  }
  return bytes;
}

HostWorldGrid WorldGrid::read() {
  HostWorldGrid host;
  host.params = layout_.params;
  constexpr const char* what = "reading the world grid";
  host.buckets.resize(sizes_[0] / 4), host.keys.resize(sizes_[1] / 8), host.cells.resize(sizes_[2] / 8);
  read_buffer(device_, what, buckets(), host.buckets.data(), sizes_[0]);
  read_buffer(device_, what, keys(), host.keys.data(), sizes_[1]);
  read_buffer(device_, what, cells(), host.cells.data(), sizes_[2]);
  if (index_bits_ == 32) {
    host.indices.resize(sizes_[3] / 4);
    read_buffer(device_, what, indices(), host.indices.data(), sizes_[3]);
  } else {
    std::vector<uint16_t> narrow(sizes_[3] / 2);
    read_buffer(device_, what, indices(), narrow.data(), sizes_[3]);
    host.indices.assign(narrow.begin(), narrow.end());
  }
  return host;
}

}  // namespace lightgrid
