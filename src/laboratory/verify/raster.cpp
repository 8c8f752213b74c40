// Hard cases of rasterising. Each image is compared with the coverage oracle pixel by pixel, in both kernel
// shapes.
#include <limits>

#include "verify/raster_check.h"

namespace lightgrid::lab::verify {
namespace {

void shared_edges(Check& c) { covers_once(c, raster_scene(150, 140), 23, false, Random(11)); }
void on_pixel_centres(Check& c) { covers_once(c, raster_scene(150, 140), 23, true, Random(11)); }

void fan_at_a_centre(Check& c, double radius) { fan(c, raster_scene(131, 127), 65.5, 60.5, radius); }
void fan_of_slivers(Check& c) { fan_at_a_centre(c, 300); }

void behind_the_eye(Check& c) { around_the_eye(c, raster_scene(90, 70, true), 200, 5, false, Random(17)); }
void at_w_zero(Check& c) { around_the_eye(c, raster_scene(90, 70, true), 200, 1, true, Random(17)); }

void huge_and_tiny(Check& c) {
  huge_and_tiny_triangles(c, raster_scene(100, 80, true), 300, Random(19));
  for (const double radius : {1e4, 1e6}) fan_at_a_centre(c, radius);
}

void not_finite(Check& c) {
  constexpr float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  constexpr float most = std::numeric_limits<float>::max();
  RasterInput input = raster_scene(50, 40, true);
  for (const float strange : {inf, -inf, nan, most, -most, 1e-40f}) {
    for (int i = 0; i < 9; ++i) {
      glm::vec3 corners[3] = {raster_position(input, 5, 4, 3), raster_position(input, 45, 8, 4),
                              raster_position(input, 20, 35, 5)};
      corners[i / 3][i % 3] = strange;
      add_raster_triangle(input, corners[0], corners[1], corners[2]);
    }
  }
  raster(c, input);
}

void equal_depths(Check& c) { equal_depths_of_copies(c, raster_scene(150, 80), Random(23)); }

void mirrored_and_two_sided(Check& c) {
  RasterInput input = raster_scene(120, 90);
  Random random(29);
  const auto corner = [&] {
    const float x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
    return glm::vec3(x, y, z);
  };
  for (int i = 0; i < 60; ++i) add_raster_triangle(input, corner);
  input.instances.clear();
  for (int i = 0; i < 8; ++i) {
    RasterInstance instance{.two_sided = i % 4 == 3};
    for (int axis = 0; axis < 3; ++axis) instance.world_from_object[axis][axis] = i >> axis & 1 ? -0.7 : 1.3;
    instance.world_from_object[3] = glm::dvec4(i % 3 - 1, i % 2 - 0.5, -2.5 - i * 0.3, 1);
    input.instances.push_back(instance);
  }
  raster(c, input);
}

void of_a_size(Check& c, int width, int height, int count) {
  triangles_of_a_size(c, raster_scene(width, height, true), count, Random(31));
}

void awkward_sizes(Check& c) {
  for (const auto& [width, height] : {std::pair{1, 1}, {17, 9}, {1, 200}, {65, 63}})
    of_a_size(c, width, height, 100);
  of_a_size(c, 1279, 721, 12);
}

// Far more triangles than any first guess of room holds, after a frame of few.
void more_than_expected(Check& c) {
  of_a_size(c, 300, 200, 3);
  RasterInput input = raster_scene(300, 200);
  Random random(37);
  for (int i = 0; i < 20000; ++i) {
    const float x = random.uniform(0, 300), y = random.uniform(0, 200), d = random.uniform(1, 3);
    add_raster_triangle(input, raster_position(input, x, y, d), raster_position(input, x + 4, y, d),
                        raster_position(input, x, y + 5, d));
  }
  raster(c, input);
}

}  // namespace

std::vector<CaseRun> raster_cases() {
  return CASES(shared_edges, on_pixel_centres, fan_of_slivers, behind_the_eye, at_w_zero, huge_and_tiny,
               not_finite, equal_depths, mirrored_and_two_sided, awkward_sizes, more_than_expected);
}

}  // namespace lightgrid::lab::verify
