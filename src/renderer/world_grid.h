// Light lists in cells of the world, on the device: built once for a scene's lights, read by any number of
// views (docs/techniques/world_grid.md). GpuScene::world_grid shares them.
#pragma once

#include <optional>

#include "cl/growing_buffer.h"
#include "cl/uploaded_buffer.h"
#include "renderer/renderer.h"
#include "renderer/world_moves.h"

namespace lightgrid {

// Lists of the same key and lights are the same.
struct WorldGridKey {
  WorldGridShape shape;
  std::optional<double> cell;  // the setting world-cell; none: auto
  int index_bits;
  LightRanges ranges;
  bool for_gl = true;  // else OpenCL alone reads them
  bool operator==(const WorldGridKey&) const = default;
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
  // for_gl: OpenGL may read the lists too, whose memory is then that of the renderer's bridge.
  WorldGrid(Renderer& renderer, WorldGridShape shape, std::optional<double> cell, int index_bits,
            bool for_gl = true);

  // Whether the lists are those of these lights (GpuScene::lights_version) and right for the view. Notes the
  // view: a build of the same lights is right for it too, and so is the first one of the next lights.
  bool serves(const View& view, int lights_version);

  // Builds them. The same bytes in both kernel shapes and with any number of threads. bounds: of the scene's
  // surfaces; lists outside are right too, but cells there are not small. Throws Error(machine) that names
  // the bytes if memory does not suffice; the grid then serves no view.
  void build(std::span<const CullLight> lights, const WorldBox& bounds, const View& view, int lights_version);

  // In place of build() where few lights moved since the lists were right: lists of cells that no such light
  // leaves or enters are copied. moved: numbers of those lights, ascending; now: each of them. Returns false,
  // and changes nothing, where a build is due: with `hashed`, on a GPU, where many have moved in all, or one
  // that is in every list. The bytes are those of a build that lays the cells out as the last one did.
  bool update(std::span<const uint32_t> moved, std::span<const CullLight> now, int lights_version);

  // Makes them visible to OpenGL, once a build. Only with for_gl.
  void hand_to_gl();

  const WorldLayout& layout() const { return layout_; }
  const cl::Buffer& params() const { return params_.buffer(); }
  cl::Buffer& buckets() { return buckets_.buffer->cl_buffer(); }
  cl::Buffer& keys() { return keys_.buffer->cl_buffer(); }
  cl::Buffer& cells() { return cells_.buffer->cl_buffer(); }
  cl::Buffer& indices() { return indices_.buffer->cl_buffer(); }

  // Buffer textures and the uniform block of the params, after hand_to_gl.
  GLuint bucket_texture() const { return buckets_.texture.name(); }
  GLuint key_texture() const { return keys_.texture.name(); }
  GLuint cell_texture() const { return cells_.texture.name(); }
  GLuint index_texture() const { return indices_.texture.name(); }
  GLuint block() const { return block_.name(); }

  size_t list_bytes() const { return list_bytes_; }  // in use
  size_t memory_bytes() const;                       // of everything, with what only building needs
  size_t blocks() const { return blocks_; }
  size_t entries() const { return entries_; }  // of the cells' lists
  int builds() const { return builds_; }
  int updates() const { return updates_; }
  int lights_version() const { return lights_version_; }  // of its lists; below 0: none

  HostWorldGrid read();  // waits

 private:
  struct Shared {
    std::optional<SharedBuffer> buffer;
    GlTexture texture;
  };
  size_t most_texture_bytes(GLenum format) const;
  cl::Buffer& grown(Shared& shared, size_t bytes, GLenum format);
  size_t chunk_of(size_t count, size_t least) const;
  size_t bucket_count() const;
  void run(const char* kernel, size_t items, const auto&... arguments);
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

  Renderer& renderer_;
  const WorldGridShape shape_;
  const std::optional<double> cell_;
  const int index_bits_;
  const bool for_gl_;

  WorldLayout layout_;
  WorldBlockLights block_lights_;
  WorldMoves moved_;  // of the last update
  std::vector<uint32_t>
      block_pairs_;       // of each block of the grid its number of lights; empty: no update since the build
  bool counted_ = false;  // count_blocks made the last build
  size_t moves_ = 0;      // lights that moved since then
  UploadedBuffer params_, lights_, cones_, levels_, first_pairs_;
  GrowingBuffer pairs_[2], totals_, total_, counted_sum_, block_first_, members_, full_first_, full_members_,
      masks_;
  GrowingBuffer moved_lights_, moved_balls_, moved_cones_, edits_, edit_first_, changes_, old_blocks_;
  Shared buckets_, keys_, cells_, indices_, old_cells_, old_indices_;
  GlBuffer block_;
  size_t pair_count_ = 0, listed_count_ = 0, blocks_ = 0, entries_ = 0, list_bytes_ = 0;
  // pair_count_: pairs of a block and a light; listed_count_: with those that hashed blocks inherit.
  size_t sizes_[4] = {};  // in use: of buckets, keys, cells, indices
  int builds_ = 0, updates_ = 0, lights_version_ = -1;
  bool in_gl_ = false;
  WorldReach asked_;  // by serves() since the lights changed
};

}  // namespace lightgrid
