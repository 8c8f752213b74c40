// Depth bounds and lights to a light grid. Needs OpenCL only.
#pragma once

#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "cl/device.h"
#include "cl/program_cache.h"
#include "culling/cull_view.h"
#include "shared/cull_settings.h"

namespace lightgrid {

// World space, metres. A light without end has an infinite radius; a negative or NaN one makes it be listed nowhere.
struct CullLight {
  glm::dvec3 position{0};
  double radius_m = std::numeric_limits<double>::infinity();
  glm::dvec3 direction{0, 0, -1};  // unit; of cones
  double cos_outer = -1;           // cosine of the outer half-angle; below 0 (no cone, or past 90 degrees) the sphere decides
};

// Depth values as clip_from_view makes them (z / w), row 0 at the bottom.
struct DepthInput {
  cl::Buffer values;   // floats
  int row_pixels = 0;  // from row to row; 0: the view's width
  int x = 0, y = 0;    // the view's lower left pixel among them
};

// Intervals of distances, per tile, on the device. How they lie there is the kernels' affair: LightCuller::read_bounds.
struct TileBounds {
  cl::Buffer values;
  DepthBoundsMode mode = DepthBoundsMode::minmax;
};

struct DepthBounds {
  TileBounds opaque;
  TileBounds blend;  // from the near plane to where a blended surface can be seen; null unless asked for
};

struct DepthInterval {
  float near = 0, far = 0;  // metres along the view axis; near > far: no surface
  bool operator==(const DepthInterval&) const = default;
};

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

// The finished grid in its storage: cells (uint2 first, count; x fastest, then y from the bottom, then slice from the
// near plane) and sorted index lists. Same bytes on every device, in every kernel shape, for any number of threads.
struct LightGrid {
  int cells_x = 0, cells_y = 0, slices = 1;
  uint64_t index_count = 0;
  int index_bits = 16;
  size_t cell_bytes = 0, index_bytes = 0;
};

// A grid on the host.
struct HostGrid {
  int cells_x = 0, cells_y = 0, slices = 1;
  std::vector<glm::uvec2> cells;  // first, count
  std::vector<uint32_t> indices;
  bool operator==(const HostGrid&) const = default;
};
HostGrid read_grid(ClDevice& device, const LightGrid& grid, GridStorage& storage);

enum class DepthFormat { d32f, d24, d16 };  // what the depth values were rounded to

struct CullerOptions {
  CullTest cull_test = CullTest::planes_aabb;
  DepthBoundsMode depth_bounds = DepthBoundsMode::minmax;
  KernelShape shape = KernelShape::automatic;
  int tile = 16;               // pixels a side: 8, 16, 32 or 64
  DepthFormat depth_format = DepthFormat::d32f;
  int samples = 1;             // depth values a pixel, side by side; more than one makes cells span whole pixels
  bool blend = false;          // blended surfaces need bounds of their own
  int index_bits = 0;          // 16 or 32; 0: 16 for up to 65,536 lights
  bool pixel_centres = true;   // cells span the centres of their pixels, which is all that is shaded; false: whole pixels
  bool portable = false;       // no builtins of one kind of CPU
};

class CullPipeline;

class LightCuller {
 public:
  LightCuller(ClDevice& device, ProgramCache& programs, const CullerOptions& options);
  ~LightCuller();
  LightCuller(LightCuller&&) noexcept;

  // The lights, in the order their indices mean: uploaded here, once, for any number of views.
  void set_lights(std::span<const CullLight> lights);
  // Throws Error(input) as check_view does.
  void set_view(const CullView& view);

  DepthBounds depth_bounds(const DepthInput& depth);
  // Given intervals, one a tile, x fastest, then y from the bottom.
  TileBounds bounds_of(std::span<const DepthInterval> intervals);
  // One a tile; of two halves, both together.
  std::vector<DepthInterval> read_bounds(const TileBounds& bounds);

  // Coarse to fine; memory is sized by what a first pass counts, grows, and the work is done again where it was short.
  // More than 2^32 - 1 indices or more than the device has is Error(machine).
  LightGrid cull(const TileBounds& bounds, GridStorage& storage);

  // Tiles of the last depth_bounds in which some value was no depth: NaN, infinite, negative or past 1. They span every
  // distance. Waits.
  uint32_t strange_tiles();

  size_t memory_bytes() const;  // of all buffers but the grid's own
  KernelShape shape() const { return options_.shape; }
  const CullParams& params() const { return params_; }

 private:
  CullPipeline& pipeline(DepthBoundsMode mode);
  cl::Buffer empty_bounds(int planes, float near, float far);
  void upload_params();

  ClDevice& device_;
  ProgramCache& programs_;
  CullerOptions options_;
  bool cones_ = false, avx512_ = false;
  glm::dvec3 origin_{0}, eye_{0};  // world: of the uploaded lights, and of the view
  CullParams params_{};
  uint light_count_ = 0, light_stride_ = 0;
  size_t index_capacity_ = 0, params_uploads_ = 0;
  CullParams uploaded_{};
  cl::Kernel bounds_kernel_;
  cl::Buffer params_buffer_, lights_, slices_, opaque_, blend_, counters_;
  size_t bounds_bytes_ = 0;
  glm::uvec2 bounds_tiles_{0};
  std::unique_ptr<CullPipeline> pipelines_[5];  // by DepthBoundsMode
};

}  // namespace lightgrid
