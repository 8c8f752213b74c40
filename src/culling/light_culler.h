// Depth bounds and lights to a light grid. Needs OpenCL only.
#pragma once

#include <span>

#include "cl/device.h"
#include "cl/launch.h"
#include "cl/program_cache.h"
#include "plan/settings.h"
#include "scene/view_lights.h"
#include "shared/view_params.h"

namespace lightgrid {

// Where a light grid is kept. The default keeps it in OpenCL buffers; a renderer gives memory that OpenGL sees too.
class GridStorage {
 public:
  virtual ~GridStorage() = default;
  // A buffer of at least `bytes`; what it held may be lost when it grows.
  virtual cl::Buffer& cells(size_t bytes) = 0;
  virtual cl::Buffer& indices(size_t bytes) = 0;
};

class ClGridStorage : public GridStorage {
 public:
  explicit ClGridStorage(ClDevice& device) : device_(device) {}
  cl::Buffer& cells(size_t bytes) override { return grown(cells_, cells_bytes_, bytes); }
  cl::Buffer& indices(size_t bytes) override { return grown(indices_, indices_bytes_, bytes); }

 private:
  cl::Buffer& grown(cl::Buffer& buffer, size_t& size, size_t bytes);
  ClDevice& device_;
  cl::Buffer cells_, indices_;
  size_t cells_bytes_ = 0, indices_bytes_ = 0;
};

// Per tile, the least and greatest distance (metres along the view axis) of what it shows: float2, on the device.
struct DepthBounds {
  cl::Buffer opaque;
  cl::Buffer blend;  // from the near plane to where a blended surface can be seen; null unless asked for
};

// The finished grid in its storage: cells (uint2 first, count; x fastest, then y from the bottom) and sorted index
// lists. Same bytes on every device, in every kernel shape, for any number of threads.
struct LightGrid {
  int cells_x = 0, cells_y = 0;
  uint64_t index_count = 0;
  int index_bits = 16;
  size_t cell_bytes = 0, index_bytes = 0;
};

struct CullerOptions {
  CullTest cull_test = CullTest::planes_aabb;
  DepthBoundsMode depth_bounds = DepthBoundsMode::minmax;
  KernelShape shape = KernelShape::automatic;
  int tile = 16;
  bool spots = false;       // some light has a cone
  bool blend = false;       // blended surfaces need intervals of their own
  int index_bits = 16;      // 32 where there are more than 65,536 lights
};

class LightCuller {
 public:
  LightCuller(ClDevice& device, ProgramCache& programs, const CullerOptions& options);

  // The point and spot lights, in the order their indices mean. Positions are rounded to float here, once.
  void set_lights(std::span<const ViewLight> lights);
  void set_view(const ViewParams& view);

  // depth: width x height floats, reversed, row 0 at the bottom (shared/view_params.h).
  DepthBounds depth_bounds(cl::Buffer& depth);

  // Coarse to fine: lights to bins, bins to tiles; at each step count, scan, fill. Memory grows to what the counts
  // say; more than 2^32 - 1 indices or more than the device has is Error(machine).
  LightGrid cull(cl::Buffer& intervals, GridStorage& storage);

  size_t memory_bytes() const;  // of all buffers but the grid's own
  KernelShape shape() const { return options_.shape; }

 private:
  void build_cull_kernels();  // at the first cull: who asks for depth bounds alone builds nothing else
  void make_first_guess();    // of how much room candidates and indices take; the counts correct it
  void run_bins(cl::Buffer& intervals, bool count);
  void run_tiles(cl::Buffer& intervals, cl::Buffer& cells, cl::Buffer& indices, uint capacity, bool count);
  void scan(cl::Buffer& cells, uint count, int slot);

  ClDevice& device_;
  ProgramCache& programs_;
  CullerOptions options_;
  ViewParams view_{};
  uint light_stride_ = 0, candidate_stride_ = 0;
  size_t index_capacity_ = 0;
  cl::Kernel bounds_, bins_count_, bins_fill_, tiles_count_, tiles_fill_, scan_;
  cl::Buffer view_buffer_, spheres_, cones_, opaque_, blend_, bins_, candidates_, totals_;
  size_t bounds_bytes_ = 0, bins_bytes_ = 0;
};

// The view in the numbers of kernels and shaders. Tile counts are rounded up to cover the image.
ViewParams view_params(const View& view, int tile, int lights, int directional, glm::vec3 ambient);

}  // namespace lightgrid
