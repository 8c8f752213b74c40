// State of a LightCuller from call to call, and its steps. Public functions are those of LightCuller.
#pragma once

#include <optional>

#include "cl/buffers.h"
#include "cl/launch.h"
#include "culling/cull_pipeline.h"
#include "culling/light_culler.h"
#include "culling/view_depth.h"
#include "shared/light_grid.h"

namespace lightgrid {

inline constexpr size_t counter_count = 8;
// Counters of tiles with an invalid depth. depth_bounds counts in one and clears the other, in turn: cheaper
// than a fill.
inline constexpr uint invalid_tiles_counters[2] = {2, 6};

// The number of values that depth bounds have a tile (kernels/culling/depth_bounds.h).
inline int planes_of(DepthBoundsMode mode) {
  if (mode == DepthBoundsMode::halfz || mode == DepthBoundsMode::halfz_modified) return 4;
  return mode == DepthBoundsMode::mask32 ? 3 : 2;
}

// Index of a tile's value in plane `plane`: kernels/culling/depth_bounds.h.
inline size_t bounds_index(const CullParams& p, int planes, int plane, uint tx, uint ty) {
  const size_t bin = size_t(ty / BIN_TILES) * p.bins_x + tx / BIN_TILES;
  return (bin * planes + plane) * BIN_SIZE + slot_of_tile(tx % BIN_TILES, ty % BIN_TILES);
}

class LightCuller::State {
 public:
  State(ClDevice& device, ProgramCache& programs, const CullerOptions& options);

  void set_lights(std::span<const CullLight> lights);
  void set_view(const CullView& view);
  CullInputs read_inputs(const TileBounds& bounds);
  size_t memory_bytes() const;
  KernelShape shape() const { return options_.shape; }
  const CullParams& params() const { return params_; }

  // depth_bounds.cpp
  DepthBounds depth_bounds(const DepthInput& depth);
  TileBounds bounds_of(std::span<const DepthInterval> intervals);
  std::vector<DepthInterval> read_bounds(const TileBounds& bounds);
  uint32_t invalid_depth_tiles();

  // cull_lights.cpp
  LightGrid cull(const TileBounds& bounds, GridStorage& storage);

 private:
  // Sizes of the buffers between kernels, and of the indices; units as in CullParams.
  struct Room {
    uint pool_batches = 0, staging_units = 0, index_capacity = 0;
    bool operator==(const Room&) const = default;
  };
  Room room() const { return {params_.pool_batches, params_.staging_units, params_.index_capacity}; }
  void set_room(const Room& room);
  Room first_room(size_t index_bytes) const;

  void require_view(const char* call) const;
  void require_bounds(const TileBounds& bounds, const char* call) const;
  void read_layout(const DepthInput& depth);
  std::unique_ptr<CullPipeline>& made_pipeline(const TileBounds& bounds) {
    return pipelines_[bounds.masks() != nullptr][int(bounds.mode)];
  }
  CullPipeline& pipeline(const TileBounds& bounds);
  void upload_masks();
  void cull_into(LightGrid& grid, const TileBounds& bounds, GridStorage& storage, const cl::Buffer& cells);
  void run_kernels(LightGrid& grid, const TileBounds& bounds, GridStorage& storage, const cl::Buffer& cells,
                   uint32_t (&counters)[counter_count]);
  void make_masks(LightGrid& grid, GridStorage& storage);
  void enqueue_z_bins(LightGrid& grid, GridStorage& storage);
  cl::Buffer empty_bounds(int planes, float near, float far);
  DepthBounds own_bounds(DepthBoundsMode mode, const cl::Buffer& blend);
  void choose_regions();
  void upload_params();
  void upload_lights(const glm::dvec3& origin, double eye_reach);
  void follow_eye();
  cl::Buffer straight_depth(const DepthInput& depth, uint first, uint row);

  ClDevice& device_;
  ProgramCache& programs_;
  CullerOptions options_;
  bool cones_ = false;
  std::vector<CullLight> host_lights_;         // to upload again when the origin follows the eye
  std::optional<glm::dvec3> fixed_origin_;     // choose_origin's, world
  std::optional<glm::dvec3> uploaded_origin_;  // as on the device; empty: not uploaded yet
  double cone_slack_m_ = 0;
  CullParams params_{};
  uint light_count_ = 0, light_stride_ = 0;
  std::optional<CullParams> uploaded_;   // contents of params_upload_ when the queue is done
  std::optional<StraightView> oblique_;  // if the view's near plane is oblique
  GrowingBuffer straight_depth_;
  NamedKernel straighten_kernel_, bounds_kernel_, z_bins_kernel_,
      masks_kernels_[2];  // masks: of 16-bit and of 32-bit lists
  bool bounds_kernel_standard_ = false;
  cl::Buffer slices_, z_bins_, opaque_, blend_, counters_;
  uint z_bin_count_ = 1, depth_group_ = 0;
  uint invalid_tiles_counter_ = 0;  // index in counters_ that the last depth_bounds counts in; 0: none yet
  size_t bounds_bytes_ = 0;
  glm::uvec2 bounds_tiles_{0};
  BoundsView view_;                          // set_view's
  std::shared_ptr<BoundsView> bounds_view_;  // view of opaque_ and blend_
  GrowingBuffer lights_;
  UploadedBuffer params_upload_;
  GrowingBuffer light_masks_;
  bool masks_uploaded_ = false;
  std::unique_ptr<CullPipeline> pipelines_[2][5];  // with masks; by DepthBoundsMode
};

}  // namespace lightgrid
