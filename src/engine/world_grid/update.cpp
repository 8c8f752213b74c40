// Lists after some lights moved, from those before. The host finds the blocks that each of these lights
// leaves, enters or stays in; a kernel tests them against the cells there and writes the lists anew.
#include <algorithm>

#include "cl/transfer.h"
#include "world_grid/world_grid.h"

namespace lightgrid {
namespace {

// An update tests a light before and after, and copies what did not change: of more lights a build is as
// fast.
constexpr size_t lights_a_move = 16;

std::vector<uint32_t> pairs_of_blocks(const WorldBlockLights& blocks) {
  std::vector<uint32_t> pairs;
  for (size_t block = 0; block + 1 < blocks.buckets.size(); ++block) {
    const uint32_t stored = blocks.buckets[block];
    pairs.push_back(stored < blocks.buckets[block + 1] ? blocks.first[stored + 1] - blocks.first[stored] : 0);
  }
  return pairs;
}

}  // namespace

bool WorldGrid::may_update(std::span<const uint32_t> moved, std::span<const WorldLight> now) const {
  const size_t lights = layout_.lights.size();
  if (!counted_ || lights_version_ < 0 || moved.size() * lights_a_move > lights) return false;
  // After as many moves as lights, other cells may suit them.
  if (moves_ + moved.size() > lights) return false;
  return std::ranges::none_of(now, &WorldLight::everywhere) && std::ranges::none_of(moved, [&](uint32_t i) {
           return std::ranges::binary_search(layout_.everywhere, i);
         });
}

bool WorldGrid::update(std::span<const uint32_t> moved, std::span<const CullLight> now, int lights_version) {
  const bool cones = !layout_.cones.empty();
  std::vector<WorldLight> lights;
  for (const CullLight& light : now) {
    if (!cones && !layout_.columns && light.cos_outer >= 0) return false;
    lights.push_back(world_light(light, layout_, cones));
  }
  if (!may_update(moved, lights)) return false;
  lights_version_ = -1;
  const WaitOnFailure wait(device_);
  if (block_pairs_.empty()) block_pairs_ = pairs_of_blocks(block_lights_);
  moved_.moved.assign(moved.begin(), moved.end());
  move_world_lights(lights, block_lights_.buckets, layout_, block_pairs_, moved_);
  std::swap(block_lights_.buckets, moved_.buckets);
  update_lists();
  finish_lists(lights_version);
  asked_ = {};
  ++updates_;
  moves_ += moved.size();
  return true;
}

void WorldGrid::upload_moves() {
  constexpr const char* what = "uploading lights that moved";
  const auto put = [&](GrowingBuffer& to, const auto& from) {
    const size_t bytes = from.size() * sizeof from[0];
    enqueue_write(device_, what, to.at_least(device_, std::max<size_t>(bytes, 16)), from.data(), bytes);
  };
  put(moved_lights_, moved_.moved);
  put(moved_balls_, moved_.balls);
  put(moved_cones_, moved_.cones);
  put(edits_, moved_.edits);
  put(edit_first_, moved_.edit_first);
  put(old_blocks_, moved_.old_blocks);
  enqueue_write(device_, what, storage_->at_least(WorldArray::keys, sizes_[1]), moved_.keys.data(),
                sizes_[1]);
  write_buffer(device_, what, buckets(), block_lights_.buckets.data(), sizes_[0]);
  changes_.at_least(device_, std::max<size_t>(moved_.edits.size(), 1) * 16);
}

void WorldGrid::update_lists() {
  blocks_ = moved_.keys.size();
  sizes_[1] = blocks_ * 8;
  sizes_[2] = blocks_ * WORLD_BLOCK_CELLS * 8;
  check_count("cells", blocks_ * WORLD_BLOCK_CELLS, 8);
  upload_moves();
  storage_->swap_lists();
  storage_->at_least(WorldArray::cells, sizes_[2]);
  const size_t chunk = chunk_of(blocks_, 4), chunks = (blocks_ + chunk - 1) / chunk;
  totals_.at_least(device_, std::max<size_t>(chunks, 1) * 4);
  const auto step = [&](cl_uint write, const cl::Buffer& indices) {
    if (blocks_ == 0) return;
    run("update", chunks,
        {{"moved", moved_lights_.get()},
         {"balls", moved_balls_.get()},
         {"cones", moved_cones_.get()},
         {"edit_first", edit_first_.get()},
         {"edits", edits_.get()},
         {"changes", changes_.get()},
         {"keys", keys()},
         {"old_blocks", old_blocks_.get()},
         {"old_cells", storage_->buffer(WorldArray::old_cells)},
         {"old_indices", storage_->buffer(WorldArray::old_indices)},
         {"totals", totals_.get()},
         {"cells", cells()},
         {"indices", indices},
         {"block_count", cl_uint(blocks_)},
         {"chunk", cl_uint(chunk)},
         {"write", write},
         {"world", params()}});
  };
  step(0, {});
  size_indices(blocks_ > 0 ? scan(chunks, true) : 0);
  step(1, indices());
}

}  // namespace lightgrid
