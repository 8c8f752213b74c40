// Shadow rays as others use them: installed, found by CMake, linked into the example of docs/examples, run.
#include <gmock/gmock.h>

#include <algorithm>

#include "support/installed_library.h"
#include "support/temp_folder.h"

// The example's own floor, boxes and lights.
#define main cast_shadows_main
#include "../../docs/examples/cast_shadows/main.cpp"
#undef main

namespace lightgrid {
namespace {

// Returns whether the segment from a point along `way`, to its end at 1, enters one of the boxes: by slabs.
bool boxes_hide(const glm::dvec3& point, const glm::dvec3& way) {
  for (const glm::dmat4& place : {placed(-2, 0.5, 0.4), placed(3.5, -1, 0.8)}) {
    const glm::dmat4 box_from_world = glm::inverse(place);
    const glm::dvec3 from(box_from_world * glm::dvec4(point, 1)), along(box_from_world * glm::dvec4(way, 0));
    double enter = 0, leave = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const double low = axis == 1 ? 0 : -1, high = axis == 1 ? 2 : 1;
      const double a = (low - from[axis]) / along[axis], b = (high - from[axis]) / along[axis];
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    if (enter < leave) return true;
  }
  return false;
}

TEST(RaysLibrary, InstalledIsFoundByCMakeAndCastsShadowsInTheExample) {
  if (!has_tool(LIGHTGRID_CMAKE)) GTEST_SKIP() << "there is no cmake at " << LIGHTGRID_CMAKE;
  const TempFolder temp;
  const std::string example = built_example("cast_shadows", temp.path);
  if (HasFailure()) return;
  std::string expected;
  for (int z = 0; z < height; ++z) {
    for (int x = 0; x < width; ++x) {
      const glm::dvec3 point = on_floor(x, z);
      const bool from_lamp = boxes_hide(point, lamp - point), from_sun = boxes_hide(point, to_sun * 100.0);
      expected += from_lamp && from_sun ? '#' : from_lamp ? 'l' : from_sun ? 's' : '.';
    }
    expected += '\n';
  }
  for (const char letter : {'#', 'l', 's', '.'})
    EXPECT_GT(std::count(expected.begin(), expected.end(), letter), 20) << letter << " in\n" << expected;
  EXPECT_EQ(must_run(example), expected);
}

}  // namespace
}  // namespace lightgrid
