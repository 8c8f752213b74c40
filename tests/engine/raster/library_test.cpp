// The rasteriser as others use it: installed, found by CMake, linked into the example of docs/examples, run.
#include <gmock/gmock.h>

#include <algorithm>
#include <glm/glm.hpp>

#include "support/installed_library.h"
#include "support/temp_folder.h"

// The example's own view and boxes.
#define main draw_boxes_main
#include "../../docs/examples/draw_boxes/main.cpp"
#undef main

namespace lightgrid {
namespace {

// The letter of the first object on a ray through a pixel's centre: boxes by slabs, the floor by height.
char letter_at(int x, int y) {
  const RasterCamera view = make_camera();
  const glm::dmat3 world_from_view = glm::transpose(glm::dmat3(view.view_from_world));
  const glm::dvec3 ray = world_from_view * glm::dvec3(slope_x * ((x + 0.5) * 2 / width - 1),
                                                      slope_y * ((y + 0.5) * 2 / height - 1), -1);
  double nearest = HUGE_VAL;
  char letter = ' ';
  const double to_floor = -view.eye.y / ray.y;
  const glm::dvec3 on_floor = view.eye + ray * to_floor;
  if (to_floor > 0 && std::abs(on_floor.x) < 20 && std::abs(on_floor.z) < 20) {
    nearest = to_floor;
    letter = '.';
  }
  const glm::dmat4 places[] = {placed(-2, 0, 0.4), placed(0.5, -3, 0.8)};
  for (int i = 0; i < 2; ++i) {
    const glm::dmat4 box_from_world = glm::inverse(places[i]);
    const glm::dvec3 from(box_from_world * glm::dvec4(view.eye, 1)),
        along(box_from_world * glm::dvec4(ray, 0));
    double enter = 0, leave = HUGE_VAL;
    for (int axis = 0; axis < 3; ++axis) {
      const double low = axis == 1 ? 0 : -1, high = axis == 1 ? 2 : 1;
      const double a = (low - from[axis]) / along[axis], b = (high - from[axis]) / along[axis];
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    if (enter < leave && enter < nearest) {
      nearest = enter;
      letter = "ab"[i];
    }
  }
  return letter;
}

TEST(RasterLibrary, InstalledIsFoundByCMakeAndDrawsInTheExample) {
  if (!has_tool(LIGHTGRID_CMAKE)) GTEST_SKIP() << "there is no cmake at " << LIGHTGRID_CMAKE;
  const TempFolder temp;
  const std::string example = built_example("draw_boxes", temp.path);
  if (HasFailure()) return;
  std::string expected;
  for (int y = height - 1; y >= 0; --y) {
    for (int x = 0; x < width; ++x) expected += letter_at(x, y);
    expected += '\n';
  }
  EXPECT_GT(std::count(expected.begin(), expected.end(), 'a'), 50);
  EXPECT_GT(std::count(expected.begin(), expected.end(), 'b'), 50);
  EXPECT_EQ(must_run(example), expected);
}

}  // namespace
}  // namespace lightgrid
