// The cull tests: as numbers for kernels, as a table for the host. Settings, culling, checks and inspection loop
// over the table. docs/overview.md#how-to-add says what a new row needs.
#pragma once

#include "shared/cull_settings.h"

#if !defined(__OPENCL_VERSION__)
namespace lightgrid {
enum class CullTest : int { sphere, planes, aabb, planes_aabb, exact };
static_assert(default_cull_test == CullTest::planes_aabb);

// The parts of a test of a light's sphere, besides the cell's interval of distances. All must hold.
struct CullTestRow {
  CullTest test;     // its place in the table
  const char* name;  // the setting cull-test
  bool sphere;       // the sphere around the cell's box
  bool planes;       // the cell's side planes
  bool box;          // the cell's box in view space
  bool distance;     // the distance to the cell itself
};

// In the order of CullTest.
inline constexpr CullTestRow cull_tests[] = {
    {CullTest::sphere, "sphere", true, false, false, false},
    {CullTest::planes, "planes", false, true, false, false},
    {CullTest::aabb, "aabb", false, false, true, false},
    {CullTest::planes_aabb, "planes+aabb", false, true, true, false},
    {CullTest::exact, "exact", false, true, true, true},
};

// The row of a test.
constexpr const CullTestRow& row_of(CullTest test) { return cull_tests[int(test)]; }

// Returns whether row_of finds each.
constexpr bool cull_tests_are_in_order() {
  int test = 0;
  for (const CullTestRow& row : cull_tests) {
    if (int(row.test) != test++) return false;
  }
  return true;
}
static_assert(cull_tests_are_in_order());

}  // namespace lightgrid
#else
// clang-format off
#define CULL_SPHERE 0       // the sphere around the cell's box
#define CULL_PLANES 1       // four side planes against the sphere's tangent rectangle on screen, and the
                            // distances
#define CULL_AABB 2         // the cell's view-space box (Arvo 1990)
#define CULL_PLANES_AABB 3  // both
#define CULL_EXACT 4        // both, then the distance to the cell itself
// clang-format on
#endif
