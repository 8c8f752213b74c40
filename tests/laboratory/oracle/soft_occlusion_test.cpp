#include "support/soft_occlusion.h"

#include <gtest/gtest.h>

#include <numbers>

#include "oracle/shadow_scenes.h"

namespace lightgrid::lab {
namespace {

// Under a light 2 m up, a card 1 m up whose edge is at x = edge_m hides what is below it: of the disc the
// part past twice that. The point is on the ground, away from its edges.
double share_past(double edge_m, double radius_m, int side) {
  const float x = float(edge_m), far = 10;
  const Scene scene = scene_of({ground_mesh(), mesh_of({{x, 1, -far}, {far, 1, -far}, {far, 1, far}}),
                                mesh_of({{x, 1, -far}, {far, 1, far}, {x, 1, far}})});
  const Occlusion occlusion(scene);
  Random random(7);
  Receiver receiver = receiver_at({0, 0, 0});
  return hidden_share(occlusion, light_at({0, 2, 0}), receiver, radius_m, side, random).share;
}

TEST(SoftOcclusion, IsTheAreaOfTheDiscPastAnEdge) {
  constexpr double radius_m = 0.4;
  for (const double edge_m : {-0.25, -0.15, 0.0, 0.05, 0.1, 0.19, 0.25}) {
    const double t = std::clamp(2 * edge_m / radius_m, -1.0, 1.0);
    const double area = (std::acos(t) - t * std::sqrt(1 - t * t)) / std::numbers::pi;
    EXPECT_NEAR(share_past(edge_m, radius_m, 64), area, 0.003) << edge_m;
    EXPECT_NEAR(share_past(edge_m, radius_m, 32), area, 0.008) << edge_m;
  }
}

// A light in the ground's plane is hidden by the ground itself where it is below.
TEST(SoftOcclusion, TheReceiversOwnPlaneHidesHalfOfALightInIt) {
  const Scene scene = scene_of({ground_mesh()});
  const Occlusion occlusion(scene);
  Random random(8);
  EXPECT_NEAR(hidden_share(occlusion, light_at({-3, 0, -4}), receiver_at({2, 0, 1}), 0.5, 32, random).share,
              0.5, 0.02);
  EXPECT_EQ(hidden_share(occlusion, light_at({-3, 1, -4}), receiver_at({2, 0, 1}), 0.5, 16, random).share, 0);
  EXPECT_EQ(hidden_share(occlusion, light_at({-3, -1, -4}), receiver_at({2, 0, 1}), 0.5, 16, random).share,
            1);
}

}  // namespace
}  // namespace lightgrid::lab
