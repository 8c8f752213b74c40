// A sample of a voxel light buffer on cases by hand.
#include "support/light_sums.h"

#include <gtest/gtest.h>

namespace lightgrid::lab {
namespace {

// A light of 10 cd and 8 m, 2 m along x: 10 / 4 (1 - (4 / 65)^2), dimmed by 8 / sqrt 65, where its squared
// reach grows by 1.
TEST(VoxelSample, OfOneLightByHand) {
  ViewLight lamp;
  lamp.position = {2, 0, 0};
  lamp.radiant_intensity = glm::dvec3(10);
  lamp.radius_m = 8;
  const VoxelSample s = voxel_sample({0, 0, 0}, {1, 0.25}, {&lamp, 1});
  const double expected = 2.5 * (1 - 16.0 / 4225) * 8 / std::sqrt(65.0);
  EXPECT_NEAR(s.irradiance.r, expected, 1e-15);
  EXPECT_NEAR(s.weight, expected, 1e-15);
  EXPECT_NEAR(s.directions.x, expected, 1e-15);
  EXPECT_EQ(s.directions.y, 0);
  EXPECT_EQ(s.lights, 1u);
  // At the light itself 1 / d^2 is 1 / 0.25, and there is no direction.
  EXPECT_NEAR(voxel_sample({2, 0, 0}, {1, 0.25}, {&lamp, 1}).weight, 40 * 8 / std::sqrt(65.0), 1e-13);
  EXPECT_EQ(voxel_sample({2, 0, 0}, {1, 0.25}, {&lamp, 1}).directions, glm::dvec3(0));
  EXPECT_EQ(voxel_sample({-6.063, 0, 0}, {1, 0.25}, {&lamp, 1}).lights, 0u) << "past its reach";
}

// A cell of 2 x 2 x 1 m: a quarter of 9 m^2; a ball of 4 m^3 has the radius cbrt(3 / pi).
TEST(VoxelSample, WidensLightsByTheCell) {
  const VoxelCell cell = VoxelCell::of({2, 2, 1}, 4);
  EXPECT_EQ(cell.half_diagonal_squared, 2.25);
  EXPECT_NEAR(cell.core_squared, std::pow(3 / 3.14159265358979323846, 2.0 / 3) / 3, 1e-15);
}

}  // namespace
}  // namespace lightgrid::lab
