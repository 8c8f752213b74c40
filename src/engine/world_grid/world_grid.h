// Light lists in cells of the world, on the device: built once for a scene's lights, read by any number of
// views (docs/techniques/world_grid.md).
#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>

#include "cl/buffers.h"
#include "cl/launch.h"
#include "cl/program_cache.h"
#include "world_grid/world_blocks.h"

namespace lightgrid {

// The arrays that readers of the lists take (shared/world_grid.h), and a second pair of cells and indices,
// from which update() copies what did not change.
enum class WorldArray { buckets, keys, cells, indices, old_cells, old_indices };

// Memory of these arrays: OpenCL's alone here. A renderer whose OpenGL reads them gives its own.
class WorldGridStorage {
 public:
  explicit WorldGridStorage(ClDevice& device) : device_(device) {}
  virtual ~WorldGridStorage() = default;
  // At least `bytes`, kept where it is large enough: growing loses the contents. Throws Error(machine) if it
  // cannot be that large.
  virtual cl::Buffer& at_least(WorldArray array, size_t bytes);
  virtual cl::Buffer& buffer(WorldArray array) { return buffers_[size_t(array)].get(); }
  virtual size_t bytes(WorldArray array) const { return buffers_[size_t(array)].bytes(); }
  virtual size_t max_bytes(WorldArray array) const;
  virtual void swap_lists();  // cells and indices change places with the old ones

 protected:
  ClDevice& device_;

 private:
  std::array<GrowingBuffer, 6> buffers_;
};

// The finished lists on the host, for the oracle and for tests.
struct HostWorldGrid {
  WorldGridParams params{};
  std::vector<uint32_t> buckets, indices;
  std::vector<glm::uvec2> keys, cells;
  bool operator==(const HostWorldGrid& other) const;

  // The cell of a position of world_position, as (first, count) in `indices`, as shading finds it.
  glm::uvec2 range_at(const glm::vec3& position) const;
  std::span<const uint32_t> everywhere() const;
};

class WorldGrid {
 public:
  // cell: edge of the cells over the lights' median radius (the setting world-cell); none: chosen.
  WorldGrid(ClDevice& device, ProgramCache& kernels, std::unique_ptr<WorldGridStorage> storage,
            WorldGridShape shape, std::optional<double> cell, int index_bits);
  virtual ~WorldGrid() = default;

  // Returns whether the lists are those of these lights (lights_version: the caller's number of them) and
  // right for the view. Stores the view: a build of the same lights is right for it too, and so is the first
  // one of the next lights.
  bool serves(const WorldEye& eye, int lights_version);

  // Builds them. The same bytes in both kernel shapes and with any number of threads. bounds: of the scene's
  // surfaces; lists outside are right too, but cells there are not small. Throws Error(machine) that names
  // the bytes if memory does not suffice; the grid then serves no view.
  void build(std::span<const CullLight> lights, const WorldBox& bounds, const WorldEye& eye,
             int lights_version);

  // In place of build() where few lights moved since the lists were right: lists of cells that no such light
  // leaves or enters are copied. moved: numbers of those lights, ascending; now: each of them. Returns false,
  // and changes nothing, where a build is due: with `hashed`, on a GPU, where many have moved in all, or one
  // that is in every list. The bytes are those of a build that lays the cells out as the last one did.
  bool update(std::span<const uint32_t> moved, std::span<const CullLight> now, int lights_version);

  const WorldLayout& layout() const { return layout_; }
  const cl::Buffer& params() const { return params_.buffer(); }
  cl::Buffer& buckets() { return storage_->buffer(WorldArray::buckets); }
  cl::Buffer& keys() { return storage_->buffer(WorldArray::keys); }
  cl::Buffer& cells() { return storage_->buffer(WorldArray::cells); }
  cl::Buffer& indices() { return storage_->buffer(WorldArray::indices); }

  size_t list_bytes() const { return list_bytes_; }  // in use
  size_t memory_bytes() const;                       // all buffers, with those that only building needs
  size_t blocks() const { return blocks_; }
  size_t entries() const { return entries_; }  // entries of the cells' lists
  int builds() const { return builds_; }
  int updates() const { return updates_; }
  int lights_version() const { return lights_version_; }  // version of its lists; below 0: none

  HostWorldGrid read();  // waits

 protected:
  // In use, of buckets, keys, cells and indices.
  const std::array<size_t, 4>& sizes() const { return sizes_; }

 private:
  size_t chunk_of(size_t count, size_t least) const;
  size_t bucket_count() const;
  // Launches world_NAME of kernels/world_grid/.
  void run(const char* name, size_t items, const ClArguments& arguments) {
    const std::string label = std::string("world_") + name;
    const size_t group = device_.info().cpu ? 1 : 64;
    kernel_of(label).launch(device_, label, cl::NDRange((items + group - 1) / group * group),
                            cl::NDRange(group), arguments);
  }
  NamedKernel& kernel_of(const std::string& label);
  uint64_t max_count(size_t bytes_each) const;
  void check_count(const char* what, uint64_t count, size_t bytes_each) const;
  uint64_t scan(size_t count, bool read);
  cl::Buffer counted(uint64_t most, uint64_t room);
  void count_blocks();
  void sort_pairs();
  void find_blocks();
  void inherit();
  void write_lists();
  void size_indices(uint64_t entries);
  void finish_lists(int lights_version);
  bool may_update(std::span<const uint32_t> moved, std::span<const WorldLight> now) const;
  void upload_moves();
  void update_lists();

  ClDevice& device_;
  ProgramCache& kernels_;
  std::map<std::string, NamedKernel> named_;  // by label, built at first use
  const std::unique_ptr<WorldGridStorage> storage_;
  const WorldGridShape shape_;
  const std::optional<double> cell_;
  const int index_bits_;

  WorldLayout layout_;
  WorldBlockLights block_lights_;
  WorldMoves moved_;  // moves of the last update
  std::vector<uint32_t>
      block_pairs_;       // number of lights per block of the grid; empty: no update since the build
  bool counted_ = false;  // count_blocks made the last build
  size_t moves_ = 0;      // lights that moved since then
  UploadedBuffer params_, lights_, cones_, levels_, first_pairs_;
  GrowingBuffer pairs_[2], totals_, total_, counted_sum_, block_first_, members_, full_first_, full_members_,
      masks_;
  GrowingBuffer moved_lights_, moved_balls_, moved_cones_, edits_, edit_first_, changes_, old_blocks_;
  size_t pair_count_ = 0, listed_count_ = 0, blocks_ = 0, entries_ = 0, list_bytes_ = 0;
  // pair_count_: pairs of a block and a light; listed_count_: with those that hashed blocks inherit.
  std::array<size_t, 4> sizes_{};
  int builds_ = 0, updates_ = 0, lights_version_ = -1;
  WorldReach asked_;  // by serves() since the lights changed
};

}  // namespace lightgrid
