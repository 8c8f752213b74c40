// The choices of light culling: as numbers for kernels, as tables for the host.
#pragma once

#include "shared/language.h"

#if !defined(__OPENCL_VERSION__)
namespace lightgrid {
// A row of cull_tests, whose table and names are shared/cull_tests.h: few files read it, so that a new test
// rebuilds only those.
enum class CullTest : int;
inline constexpr CullTest default_cull_test{3};
enum class DepthBoundsMode { none, minmax, halfz, halfz_modified, mask32 };
enum class KernelShape { automatic, lanes, group };
enum class SliceSpacing { exponential, linear };
enum class GridLists { lists, masks };

// The table of depth-bounds modes: settings, culling, checks and inspection loop over it.
struct DepthBoundsRow {
  DepthBoundsMode mode;  // its place in the table
  const char* name;      // the setting depth-bounds
};

// In the order of DepthBoundsMode.
inline constexpr DepthBoundsRow depth_bounds_modes[] = {
    {DepthBoundsMode::none, "none"},     {DepthBoundsMode::minmax, "minmax"},
    {DepthBoundsMode::halfz, "halfz"},   {DepthBoundsMode::halfz_modified, "halfz-modified"},
    {DepthBoundsMode::mask32, "mask32"},
};

// The row of a mode.
constexpr const DepthBoundsRow& row_of(DepthBoundsMode mode) { return depth_bounds_modes[int(mode)]; }

// Returns whether row_of finds each.
constexpr bool rows_are_in_order() {
  int mode = 0;
  for (const DepthBoundsRow& row : depth_bounds_modes) {
    if (int(row.mode) != mode++) return false;
  }
  return true;
}
static_assert(rows_are_in_order());
// How world_grid cuts the world into cells (docs/techniques/world_grid.md): columns over its ground, cubes of
// one size, or cubes of sizes that suit each light.
enum class WorldGridShape { columns, cubes, hashed };

}  // namespace lightgrid
#else
// clang-format off
#define DEPTH_NONE 0
#define DEPTH_MINMAX 1          // least and greatest distance: Harada, McKee, Yang, "Forward+" (2012)
#define DEPTH_HALFZ 2           // that interval cut at its middle: Thomas, "Tiled-Based Compute
                                // Rendering" (GDC 2015)
#define DEPTH_HALFZ_MODIFIED 3  // both halves shrunk to the depths in them (the same)
#define DEPTH_MASK32 4          // the interval in 32 slots, a bit for each occupied one: Harada, "A 2.5D
                                // Culling for Forward+" (SIGGRAPH Asia 2012)
// clang-format on
#endif

#if defined(__OPENCL_VERSION__)
// Floats per tile of the depth bounds.
#if DEPTH_MODE == DEPTH_HALFZ || DEPTH_MODE == DEPTH_HALFZ_MODIFIED
#define BOUND_PLANES 4  // near, far of the nearer half; near, far of the farther
#elif DEPTH_MODE == DEPTH_MASK32
#define BOUND_PLANES 3  // near, far, mask
#else
#define BOUND_PLANES 2  // near, far
#endif
#endif
