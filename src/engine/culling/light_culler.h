// Depth bounds and lights to a light grid. Needs OpenCL only; docs/library.md shows its use.
//
//   LightCuller culler(device, programs, options);
//   culler.set_lights(lights);                                  // when they change
//   culler.set_view(view);                                      // each frame
//   LightGrid grid = culler.cull(culler.depth_bounds(depth).opaque, storage);
//
// The method is tiled light culling (Olsson, Assarsson, "Tiled Shading", JGT 2011; Harada, McKee, Yang,
// "Forward+", Eurographics 2012), in clusters if the view has slices (Olsson, Billeter, Assarsson, "Clustered
// Deferred and Forward Shading", HPG 2012), coarse to fine. A list may hold a light too many, never one too
// few, for surfaces 10^-15 to 10^15 m from the eye and lights anywhere: docs/hard_cases.md#the-domain has the
// limits and what happens past them.
//
// All errors are of type Error (base/error.h): input if an argument is wrong or set_view was not called yet,
// machine if the device or its memory does not suffice. Calls enqueue on the device's one queue; cull, and
// calls that return host values, wait for it. Enqueued work never reads the culler's own memory: the culler
// may be changed, moved or destroyed before the queue has finished. Objects of one device are for one thread
// at a time.
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

// A point or spot light: it reaches a sphere, or the part of the sphere in a cone. World space, metres.
struct CullLight {
  glm::dvec3 position{0};  // finite
  // Zero contribution past it. Infinite: no range; 0: the point alone; negative or NaN: listed nowhere.
  double radius_m = std::numeric_limits<double>::infinity();
  glm::dvec3 direction{0, 0, -1};  // the spot's axis; shorter than 10^-15, past 10^15 or NaN: no cone
  // Cosine of a spot's outer half-angle; below 0 (no cone, or one past 90 degrees) the sphere decides.
  double cos_outer = -1;
  uint32_t mask = 0xffffffffu;  // read where tiles have masks (TileBounds::masks)
  bool operator==(const CullLight&) const = default;
};

// A depth buffer of this view in OpenCL memory: 32-bit floats, row 0 at the bottom, with `samples` values
// side by side for each pixel. A value is z / w of clip_from_view, 0 to 1; the far end of that (0 in reversed
// depth, 1 in standard) means no surface. The view may be a part of a larger image.
struct DepthInput {
  cl::Buffer values;   // in the culler's context; (y + height - 1) * row_pixels + x + width pixels or more
  int row_pixels = 0;  // pixels from row to row, x + width or more; 0: the view's width
  int x = 0, y = 0;    // the view's lower left pixel in the image, 0 or more
};

// The values, next to the surfaces, on which bounds depend.
struct BoundsView {
  int width = 0, height = 0, tile = 0;  // pixels: the image, a tile's side
  // As CullView's.
  glm::dmat4 clip_from_view{1};
  glm::dmat3 view_from_world{1};
  glm::dvec3 eye{0};
  bool operator==(const BoundsView&) const = default;
};

// Intervals of distances, one or two a tile, on the device. Their layout is private to the kernels: use
// LightCuller::read_bounds. The culler owns the buffer that depth_bounds returns and overwrites it in the
// next depth_bounds. Bounds serve their own view, with any lights, slices and z-bins, as often as is wanted;
// with another view they are Error(input).
struct TileBounds {
  cl::Buffer values;                               // floats
  DepthBoundsMode mode = DepthBoundsMode::minmax;  // decides how many a tile
  std::shared_ptr<const BoundsView> view;          // whose surfaces `values` are of now
  // The masks of the surfaces in each tile, a word a tile in the order of `values`: a light that has none of
  // them is not listed there. Null, as the culler gives it: every light may be. The caller sets and keeps it.
  cl::Buffer masks{};
};

// The bounds that a depth buffer gives.
struct DepthBounds {
  TileBounds opaque;  // bounds of the surfaces in the depth buffer
  TileBounds blend;   // from the near plane to the farthest visible blended surface; null unless
                      // CullerOptions::blend
};

// The surfaces of a tile lie between.
struct DepthInterval {
  float near = 0, far = 0;  // metres along the view axis; near > far: no surface
  bool operator==(const DepthInterval&) const = default;
};

// Memory of a light grid, for one culler at a time. ClGridStorage uses OpenCL buffers of its own; a renderer
// may use memory shared with its graphics API. Sizes are bytes; a call may request more than the grid needs.
class GridStorage {
 public:
  virtual ~GridStorage() = default;
  // A buffer of at least `bytes` in the culler's context; growing it may lose its contents.
  virtual cl::Buffer& cells(size_t bytes) = 0;
  virtual cl::Buffer& indices(size_t bytes) = 0;
  virtual cl::Buffer& masks(size_t bytes) = 0;   // called only with GridLists::masks
  virtual cl::Buffer& z_bins(size_t bytes) = 0;  // called only if the view has z-bins
};

// Buffers that grow and never shrink.
class ClGridStorage : public GridStorage {
 public:
  explicit ClGridStorage(ClDevice& device);  // outlives it
  ~ClGridStorage() override;
  // As GridStorage's. Throw Error(machine) where the device has no such memory.
  cl::Buffer& cells(size_t bytes) override;
  cl::Buffer& indices(size_t bytes) override;
  cl::Buffer& masks(size_t bytes) override;
  cl::Buffer& z_bins(size_t bytes) override;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// The finished grid in its storage. Cells: uint2(first, count) into the indices, x fastest, then y from the
// bottom, then slice from the near plane; cell_of_pixel (shared/light_grid.h) finds a pixel's first one.
// Indices: into set_lights' lights, each cell's sorted and without repetition. Masks, with GridLists::masks:
// mask_words 32-bit words a cell, in the cells' order, in which light i is bit i % 32 of word i / 32; they
// hold the same sets as the lists. Z-bins, if the view has any: a word a light. shared/slices.h tests it
// against a pixel's z-bin (z_bin_of_key); shading skips a listed light whose z-bins do not include the
// pixel's. Same bytes on every device, in every kernel shape, for any number of threads.
struct LightGrid {
  int cells_x = 0, cells_y = 0, slices = 1;  // cells_x * cells_y * slices cells
  uint64_t index_count = 0;                  // total of all lists, below 2^32
  int index_bits = 16;                       // 16 or 32 each
  size_t cell_bytes = 0, index_bytes = 0;    // in use; the storage's buffers may be larger
  size_t mask_words = 0, mask_bytes = 0;     // 0 without masks
  size_t z_bin_bytes = 0;                    // 0 without z-bins
};

// A grid on the host, in the same order; indices are widened to 32 bits.
struct HostGrid {
  int cells_x = 0, cells_y = 0, slices = 1;  // cells_x * cells_y * slices cells
  std::vector<glm::uvec2> cells;             // first, count
  std::vector<uint32_t> indices;             // indices of lights, all lists one after the other
  std::vector<uint32_t> masks;               // empty without masks
  std::vector<uint32_t> z_bins;              // a word a light; empty without z-bins
  bool operator==(const HostGrid&) const = default;
};
// Waits.
HostGrid read_grid(ClDevice& device, const LightGrid& grid, GridStorage& storage);

// The format of the depth values before they became floats: bounds are widened by one step of it. A surface
// so far away that the format rounds its depth to the far end counts as background.
enum class DepthFormat { d32f, d24, d16 };

// shared/cull_settings.h describes the choices and their sources.
struct CullerOptions {
  CullTest cull_test = default_cull_test;  // test of a light against a cell: a name of shared/cull_tests.h
  DepthBoundsMode depth_bounds = DepthBoundsMode::minmax;  // the depths that a tile keeps
  KernelShape shape = KernelShape::automatic;    // lanes on a CPU, group elsewhere; the grid is the same
  int tile = 16;                                 // pixels a side: 8, 16, 32 or 64
  DepthFormat depth_format = DepthFormat::d32f;  // format of the graphics API's depth buffer
  int samples = 1;  // depth values a pixel: 1, 2, 4 or 8; more than one makes cells span whole pixels
  GridLists lists = GridLists::lists;  // masks: bitmasks as well
  bool blend = false;                  // depth bounds and a grid for blended surfaces
  int index_bits = 0;                  // 16 or 32; 0: 16 for up to 65,536 lights. More lights always take 32
  bool pixel_centres = true;  // cells span the centres of their pixels, as shading does; false: whole pixels
  bool portable = false;      // no builtins that only some CPUs have
  int group_size = 0;         // work-items that cull a block of 4 x 4 tiles in the group shape: 64, 128,
                              // 256, 512 or 1024, as far as the device allows; 0: 256
};

// All input of the culling kernels, with the layout of the device's memory: for checks that compute the grid
// otherwise.
struct CullInputs {
  CullParams params{};                             // the kernels' view
  DepthBoundsMode mode = DepthBoundsMode::minmax;  // mode of `bounds`
  std::vector<float> lights, bounds;               // kernels/culling/light_arrays.h, depth_bounds.h
  std::vector<glm::vec2> slices;                   // near and far of each, metres; a single slice is infinite
};

// Culls the lights of one scene for one view at a time.
class LightCuller {
 public:
  // Device and cache outlive it. Kernels are built at first use or taken from the cache. Throws Error(input)
  // for a value that CullerOptions does not list.
  LightCuller(ClDevice& device, ProgramCache& programs, const CullerOptions& options);
  ~LightCuller();
  LightCuller(LightCuller&&) noexcept;

  // The lights, in the order of their indices: uploaded once, for any number of views. Waits. Throws
  // Error(machine) for 2^30 lights or more.
  void set_lights(std::span<const CullLight> lights);
  // Throws Error(input) as check_view does. Call before the functions below.
  void set_view(const CullView& view);

  // The distances of the surfaces in each of the view's tiles; the last tiles may be cut. `depth` is not read
  // with DepthBoundsMode::none. Throws Error(input) if the buffer does not cover the view.
  DepthBounds depth_bounds(const DepthInput& depth);
  // Bounds from the given intervals, one a tile, x fastest, then y from the bottom: at most tiles_x * tiles_y
  // of params(); missing tiles are empty, and more are Error(input). The intervals are not widened.
  TileBounds bounds_of(std::span<const DepthInterval> intervals);
  // One interval a tile, in that order; the two halves of a tile are merged. Waits.
  std::vector<DepthInterval> read_bounds(const TileBounds& bounds);

  // The grid of the lights, the view and its bounds, in `storage`. If memory sized by the last
  // grid does not suffice, it grows and the work is repeated. It grows to a quarter more than is needed, or
  // to the exact size if the device or `storage` throws Error. More than 2^32 - 1 indices or insufficient
  // memory is Error(machine), after which the culler is unchanged; nothing is ever left out.
  LightGrid cull(const TileBounds& bounds, GridStorage& storage);

  // The input of cull(bounds). Waits.
  CullInputs read_inputs(const TileBounds& bounds);

  // Tiles of the last depth_bounds with an invalid depth value: NaN, infinite, negative or past 1. Such tiles
  // span every distance. Waits.
  uint32_t invalid_depth_tiles();

  size_t memory_bytes() const;       // bytes of all buffers except the grid's
  KernelShape shape() const;         // lanes or group: never automatic
  const CullParams& params() const;  // tiles_x, tiles_y and the rest of the kernels' view

 private:
  class State;
  std::unique_ptr<State> state_;
};

}  // namespace lightgrid
