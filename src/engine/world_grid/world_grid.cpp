// Building: each block's lights, then each block's lists. A CPU counts the lights in blocks if there are few;
// otherwise pairs of blocks and lights in the order of the lights are sorted stably by block. Each step
// counts in chunks, adds the counts up and writes, so that nothing is dropped and no place depends on the
// order of threads.
#include "world_grid/world_grid.h"

#include <algorithm>
#include <limits>

#include "base/error.h"
#include "cl/transfer.h"

namespace lightgrid {
namespace {

constexpr size_t members_past_end = 4 * (world_batch - 1);  // bytes that world_lists may read

}  // namespace

cl::Buffer& WorldGridStorage::at_least(WorldArray array, size_t bytes) {
  return buffers_[size_t(array)].at_least(device_, bytes);
}

size_t WorldGridStorage::max_bytes(WorldArray) const { return std::numeric_limits<size_t>::max(); }

void WorldGridStorage::swap_lists() {
  std::swap(buffers_[size_t(WorldArray::cells)], buffers_[size_t(WorldArray::old_cells)]);
  std::swap(buffers_[size_t(WorldArray::indices)], buffers_[size_t(WorldArray::old_indices)]);
}

WorldGrid::WorldGrid(ClDevice& device, ProgramCache& kernels, std::unique_ptr<WorldGridStorage> storage,
                     WorldGridShape shape, std::optional<double> cell, int index_bits)
    : device_(device),
      kernels_(kernels),
      storage_(std::move(storage)),
      shape_(shape),
      cell_(cell),
      index_bits_(index_bits) {}

bool WorldGrid::serves(const WorldEye& eye, int lights_version) {
  if (lights_version_ < 0) return false;
  const WorldReach needed = reach_of(eye, layout_.middle);
  asked_ = larger(asked_, needed);
  return lights_version_ == lights_version && layout_.reach.holds(needed);
}

NamedKernel& WorldGrid::kernel_of(const std::string& label) {
  NamedKernel& kernel = named_[label];
  if (kernel) return kernel;
  std::string defines;
  if (label == "world_lists" || label == "world_update") {
    if (shape_ == WorldGridShape::columns) defines += " -DCOLUMNS";
    if (index_bits_ == 32) defines += " -DINDEX_32";
  }
  return kernel = NamedKernel(kernels_, "world_grid/" + label, defines);
}

// The device has a limit for one buffer, and entries are counted in 32 bits.
uint64_t WorldGrid::max_count(size_t bytes_each) const {
  return std::min<uint64_t>(std::numeric_limits<uint32_t>::max() - 1,
                            device_.info().max_allocation_bytes / bytes_each);
}

// Throws Error(machine) if the device gives no buffer that large, or if there are more than 32 bits count.
void WorldGrid::check_count(const char* what, uint64_t count, size_t bytes_each) const {
  const uint64_t most = device_.info().max_allocation_bytes;
  if (count <= max_count(bytes_each)) return;
  throw machine_error(
      "world grid: {} {} take {} bytes, more than the {} that this device gives to one buffer; use larger "
      "cells (world-cell), smaller ranges or fewer lights",
      count, what, count * bytes_each, most);
}

// Some chunks for each thread on a CPU, and thousands of them elsewhere. At least 1, also of nothing.
size_t WorldGrid::chunk_of(size_t count, size_t least) const {
  const bool cpu = device_.info().cpu;
  const size_t items = cpu ? 32 : 8192;
  return std::max({(count + items - 1) / items, cpu ? least : least / 16, size_t(1)});
}

// Turns totals_ into sums of all before each. Returns the sum of all, if it is read.
uint64_t WorldGrid::scan(size_t count, bool read) {
  const size_t group = device_.info().cpu ? 1 : 256;
  kernel_of("world_scan")
      .launch(device_, "world_scan", cl::NDRange(group), cl::NDRange(group),
              {{"values", totals_.get()}, {"count", cl_uint(count)}, {"total", total_.at_least(device_, 8)}});
  uint64_t total = 0;
  if (read) read_buffer(device_, "reading the world grid's size", total_.get(), &total, sizeof total);
  return total;
}

// For kernels that count at most `most`: a sum at which they stop, once there is no room for it; null: there
// is.
cl::Buffer WorldGrid::counted(uint64_t most, uint64_t room) {
  if (most <= room) return {};
  fill_buffer(device_, "clearing a count", counted_sum_.at_least(device_, 4), 0, 4);
  return counted_sum_.get();
}

size_t WorldGrid::bucket_count() const {
  const WorldGridParams& p = layout_.params;
  return p.bucket_bits > 0 ? size_t(1) << p.bucket_bits
                           : size_t(p.blocks_x) * p.blocks_y * std::max(p.cells_z >> p.shift_z, 1u);
}

// In place of sort_pairs and find_blocks.
void WorldGrid::count_blocks() {
  check_count("pairs of blocks and lights", layout_.pairs, 8);
  pair_count_ = size_t(layout_.pairs);
  count_world_blocks(layout_, block_lights_);
  blocks_ = block_lights_.keys.size();
  sizes_[0] = block_lights_.buckets.size() * 4;
  sizes_[1] = blocks_ * 8;
  constexpr const char* what = "uploading blocks of lights";
  const auto put = [&](const cl::Buffer& to, const auto& from) {
    enqueue_write(device_, what, to, from.data(), from.size() * sizeof from[0]);
  };
  put(storage_->at_least(WorldArray::buckets, sizes_[0]), block_lights_.buckets);
  put(storage_->at_least(WorldArray::keys, sizes_[1]), block_lights_.keys);
  put(block_first_.at_least(device_, (blocks_ + 1) * 4), block_lights_.first);
  write_buffer(device_, what, members_.at_least(device_, pair_count_ * 4 + members_past_end),
               block_lights_.members.data(), block_lights_.members.size() * 4);
}

// From lights to pairs_[0], sorted by bucket.
void WorldGrid::sort_pairs() {
  check_count("pairs of blocks and lights", layout_.pairs, 16);
  pair_count_ = size_t(layout_.pairs);
  if (pair_count_ == 0) return;
  for (GrowingBuffer& buffer : pairs_) buffer.at_least(device_, pair_count_ * 16);
  const size_t lights = layout_.lights.size(), lights_chunk = chunk_of(lights, 64);
  run("blocks", (lights + lights_chunk - 1) / lights_chunk,
      {{"lights", lights_.buffer()},
       {"levels", layout_.levels.empty() ? cl::Buffer() : levels_.buffer()},
       {"first_pairs", first_pairs_.buffer()},
       {"pairs", pairs_[0].get()},
       {"light_count", cl_uint(lights)},
       {"chunk", cl_uint(lights_chunk)},
       {"world", params()}});
  const size_t chunk = chunk_of(pair_count_, 2048), chunks = (pair_count_ + chunk - 1) / chunk;
  const int max_bits = device_.info().cpu ? 11 : 8;
  const int passes = (layout_.bucket_bits + max_bits - 1) / max_bits,
            bits = (layout_.bucket_bits + passes - 1) / passes;
  const cl_uint digits = 1u << bits;
  totals_.at_least(device_, digits * chunks * 4);
  for (int pass = 0; pass < passes; ++pass) {
    const auto step = [&](cl_uint write) {
      run("sort", chunks,
          {{"from", pairs_[0].get()},
           {"to", pairs_[1].get()},
           {"totals", totals_.get()},
           {"count", cl_uint(pair_count_)},
           {"chunk", cl_uint(chunk)},
           {"chunks", cl_uint(chunks)},
           {"shift", cl_uint(pass * bits)},
           {"digits", digits},
           {"write", write}});
    };
    step(0);
    scan(digits * chunks, false);
    step(1);
    std::swap(pairs_[0], pairs_[1]);
  }
  if (layout_.params.bucket_bits > 0) {
    run("split", chunks,
        {{"pairs", pairs_[0].get()},
         {"scratch", pairs_[1].get()},
         {"count", cl_uint(pair_count_)},
         {"chunk", cl_uint(chunk)}});
  }
}

// From sorted pairs to blocks, and the buckets that lead to them.
void WorldGrid::find_blocks() {
  const size_t buckets = bucket_count();
  sizes_[0] = (buckets + 1) * 4;
  storage_->at_least(WorldArray::buckets, sizes_[0]);
  blocks_ = 0;
  if (pair_count_ == 0) {
    fill_buffer(device_, "clearing the world grid", this->buckets(), 0, sizes_[0]);
    storage_->at_least(WorldArray::keys, 0);
    sizes_[1] = 0;
    return;
  }
  const size_t chunk = chunk_of(pair_count_, 1024), chunks = (pair_count_ + chunk - 1) / chunk;
  const auto step = [&](cl_uint write, const cl::Buffer& first, const cl::Buffer& keys,
                        const cl::Buffer& members) {
    run("entries", chunks,
        {{"pairs", pairs_[0].get()},
         {"totals", totals_.get()},
         {"block_first", first},
         {"keys", keys},
         {"members", members},
         {"buckets", this->buckets()},
         {"bucket_count", cl_uint(buckets)},
         {"count", cl_uint(pair_count_)},
         {"chunk", cl_uint(chunk)},
         {"write", write}});
  };
  totals_.at_least(device_, chunks * 4);
  step(0, {}, {}, {});
  blocks_ = size_t(scan(chunks, true));
  sizes_[1] = blocks_ * 8;
  step(1, block_first_.at_least(device_, (blocks_ + 1) * 4), storage_->at_least(WorldArray::keys, sizes_[1]),
       members_.at_least(device_, pair_count_ * 4 + members_past_end));
}

// Makes full_members_ for hashed grids with several levels.
void WorldGrid::inherit() {
  const size_t chunk = chunk_of(blocks_, 16), chunks = (blocks_ + chunk - 1) / chunk;
  totals_.at_least(device_, chunks * 4);
  const uint64_t room = max_count(8);
  const cl::Buffer stop = counted(uint64_t(blocks_) * layout_.lights.size(), room);
  const auto step = [&](cl_uint write, const cl::Buffer& first, const cl::Buffer& members) {
    run("inherit", chunks,
        {{"lights", lights_.buffer()},
         {"block_first", block_first_.get()},
         {"members", members_.get()},
         {"keys", keys()},
         {"buckets", buckets()},
         {"totals", totals_.get()},
         {"full_first", first},
         {"full_members", members},
         {"counted", stop},
         {"most", cl_uint(room / 64)},
         {"block_count", cl_uint(blocks_)},
         {"chunk", cl_uint(chunk)},
         {"write", write},
         {"world", params()}});
  };
  step(0, {}, {});
  const uint64_t members = scan(chunks, true);
  check_count("pairs of blocks and lights or more", members, 8);
  step(1, full_first_.at_least(device_, (blocks_ + 1) * 4),
       full_members_.at_least(device_, size_t(members) * 4 + members_past_end));
  listed_count_ = size_t(members);
}

void WorldGrid::write_lists() {
  listed_count_ = pair_count_;
  const bool inherited = blocks_ > 0 && std::popcount(layout_.params.levels) > 1;
  if (inherited) inherit();
  sizes_[2] = blocks_ * WORLD_BLOCK_CELLS * 8;
  check_count("cells", blocks_ * WORLD_BLOCK_CELLS, 8);
  storage_->at_least(WorldArray::cells, sizes_[2]);
  const size_t chunk = chunk_of(blocks_, 4), chunks = (blocks_ + chunk - 1) / chunk;
  const uint64_t room = max_count(size_t(index_bits_) / 8);
  const cl::Buffer stop = counted(uint64_t(listed_count_) * WORLD_BLOCK_CELLS, room);
  const auto step = [&](cl_uint write, const cl::Buffer& indices) {
    if (blocks_ == 0) return;
    run("lists", chunks,
        {{"lights", lights_.buffer()},
         {"cones", layout_.cones.empty() ? cl::Buffer() : cones_.buffer()},
         {"block_first", (inherited ? full_first_ : block_first_).get()},
         {"members", (inherited ? full_members_ : members_).get()},
         {"keys", keys()},
         {"masks", masks_.get()},
         {"totals", totals_.get()},
         {"cells", cells()},
         {"indices", indices},
         {"counted", stop},
         {"most", cl_uint(room / 64)},
         {"block_count", cl_uint(blocks_)},
         {"chunk", cl_uint(chunk)},
         {"write", write},
         {"entry_count", cl_uint(entries_)},
         {"world", params()}});
  };
  // Each block's begin at its number plus that of whole batches before it.
  const size_t batches = blocks_ + listed_count_ / world_batch;
  check_count("batches of lights", batches, WORLD_BLOCK_CELLS * 2);
  masks_.at_least(device_, batches * WORLD_BLOCK_CELLS * 2);
  totals_.at_least(device_, std::max<size_t>(chunks, 1) * 4);
  step(0, {});
  const uint64_t entries = blocks_ > 0 ? scan(chunks, true) : 0;
  size_indices(entries);
  step(1, indices());
}

void WorldGrid::size_indices(uint64_t entries) {
  const size_t index_bytes = size_t(index_bits_) / 8, everywhere = layout_.everywhere.size();
  check_count("list entries or more", entries + everywhere, index_bytes);
  entries_ = size_t(entries);
  sizes_[3] = (entries_ + everywhere) * index_bytes;
  const bool too_small = storage_->bytes(WorldArray::indices) < sizes_[3];
  // More than needed, for lights that move, where that fits.
  const size_t most = std::min(storage_->max_bytes(WorldArray::indices), device_.info().max_allocation_bytes);
  const size_t roomy = sizes_[3] + sizes_[3] / 4;
  storage_->at_least(WorldArray::indices, too_small && builds_ > 0 && roomy <= most ? roomy : sizes_[3]);
}

void WorldGrid::finish_lists(int lights_version) {
  constexpr const char* what = "uploading lights of every list";
  const size_t everywhere = layout_.everywhere.size();
  if (index_bits_ == 16) {
    const std::vector<uint16_t> narrow(layout_.everywhere.begin(), layout_.everywhere.end());
    write_buffer(device_, what, indices(), narrow.data(), everywhere * 2, entries_ * 2);
  } else {
    write_buffer(device_, what, indices(), layout_.everywhere.data(), everywhere * 4, entries_ * 4);
  }
  layout_.params.everywhere_first = uint(entries_);
  // Waits for all commands before it.
  params_.put(device_, "uploading the world grid", std::vector<WorldGridParams>{layout_.params});
  list_bytes_ = sizes_[0] + sizes_[1] + sizes_[2] + sizes_[3];
  lights_version_ = lights_version;
}

void WorldGrid::build(std::span<const CullLight> lights, const WorldBox& bounds, const WorldEye& eye,
                      int lights_version) {
  // Two views that share the lists, one far away and one wide, would else need a build after the other's.
  const WorldReach at_least = lights_version_ == lights_version ? layout_.reach : asked_;
  if (lights_version_ != lights_version) asked_ = {};
  lights_version_ = -1;
  const WaitOnFailure wait(device_);
  lay_out_world(lights, bounds, shape_, cell_, eye, layout_, at_least);
  constexpr const char* what = "uploading lights";
  params_.put(device_, what, std::vector<WorldGridParams>{layout_.params});
  // Copied while the host counts blocks.
  lights_.enqueue(device_, what, layout_.lights);
  cones_.enqueue(device_, what, layout_.cones);
  levels_.enqueue(device_, what, layout_.levels);
  pair_count_ = 0;
  moves_ = 0;
  block_pairs_.clear();
  counted_ = device_.info().cpu && has_few_blocks(layout_);
  if (counted_) {
    count_blocks();
  } else {
    first_pairs_.enqueue(device_, what, layout_.first_pairs);
    if (!lights.empty()) sort_pairs();
    find_blocks();
  }
  write_lists();
  finish_lists(lights_version);
  ++builds_;
}

bool HostWorldGrid::operator==(const HostWorldGrid& other) const {
  return std::equal(reinterpret_cast<const char*>(&params), reinterpret_cast<const char*>(&params + 1),
                    reinterpret_cast<const char*>(&other.params)) &&
         buckets == other.buckets && keys == other.keys && cells == other.cells && indices == other.indices;
}

glm::uvec2 HostWorldGrid::range_at(const glm::vec3& p) const {
  return world_range(uint(world_coordinate(p.x, params.min_x, params.max_x)),
                     uint(world_coordinate(p.y, params.min_y, params.max_y)),
                     uint(world_coordinate(p.z, params.min_z, params.max_z)), params,
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
  host.buckets.resize(sizes_[0] / 4);
  host.keys.resize(sizes_[1] / 8);
  host.cells.resize(sizes_[2] / 8);
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
