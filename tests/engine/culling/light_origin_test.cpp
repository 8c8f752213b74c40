// Lights far from each other and from the eye: no light that reaches a pixel is lost, whatever the distance
// between lights. Decided by the oracle in double.
#include <gmock/gmock.h>

#include <cmath>

#include "culling/culled_grid.h"
#include "culling/light_arrays.h"
#include "oracle/lit_set.h"
#include "scene/random.h"

namespace lightgrid {
using namespace lab;
namespace {

constexpr int size = 48;
constexpr double wall_m = 3;

View room() { return view_of(size, size, 60); }

std::vector<float> wall_depth(double distance) {
  return std::vector<float>(size * size, float(0.1 / distance));
}

glm::dvec3 random_direction(Random& random) {
  glm::dvec3 d;
  do d = glm::dvec3(random.uniform(), random.uniform(), random.uniform()) * 2.0 - 1.0;
  while (glm::length(d) > 1 || glm::length(d) < 0.1);
  return glm::normalize(d);
}

// Narrow spots and small lamps around the wall.
std::vector<ViewLight> lights_at_the_wall(size_t count, uint64_t seed) {
  Random random(seed);
  std::vector<ViewLight> lights;
  for (size_t i = 0; i < count; ++i) {
    const glm::dvec3 at((random.uniform() - 0.5) * 4, (random.uniform() - 0.5) * 4,
                        -wall_m + random.uniform() * 2);
    const glm::dvec3 towards = random_direction(random) - glm::dvec3(0, 0, 1);
    if (i % 2)
      lights.push_back(spot_light(at, towards, 2.5, 0.02 + 0.1 * random.uniform()));
    else
      lights.push_back(point_light(at, 0.05 + random.uniform()));
  }
  return lights;
}

LitPairs pairs(const View& view, const std::vector<float>& depth, const std::vector<ViewLight>& lights,
               KernelShape shape) {
  const CulledGrid grid = cull_depth(view, lights, depth, {.shape = shape});
  ListedLights lists;
  for (const glm::uvec2 cell : grid.cells) {
    lists.first.push_back(cell.x);
    lists.count.push_back(cell.y);
  }
  lists.indices = grid.indices;
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x)
      lists.cell_of_pixel.push_back(uint32_t(y / 16 * grid.grid.cells_x + x / 16));
  }
  return count_pairs(view, depth, lights, lists);
}

struct Loss : testing::TestWithParam<KernelShape> {
  void expect_none_lost(const std::vector<ViewLight>& lights) {
    const LitPairs found = pairs(room(), wall_depth(wall_m), lights, GetParam());
    EXPECT_EQ(found.lost, 0u);
    EXPECT_GT(found.lit, 1000u);
  }
};

TEST_P(Loss, NoneWhereMostLightsAreFarFromTheRoom) {
  for (const double spread : {1e4, 1e5, 1e6, 1e9, 1e12, 1e15}) {
    SCOPED_TRACE(spread);
    std::vector<ViewLight> lights = lights_at_the_wall(1000, 3);
    Random random(4);
    for (int i = 0; i < 1010; ++i) {
      lights.push_back(
          point_light(glm::dvec3(1, 0.7, -0.3) * spread + random_direction(random) * (spread * 0.01), 2));
    }
    expect_none_lost(lights);
  }
}

TEST_P(Loss, NoneWhereLightsAreParkedToSwitchThemOff) {
  for (const double place : {1e16, 1e19, 1e30, double(std::numeric_limits<float>::max()), 1e300,
                             std::numeric_limits<double>::max()}) {
    for (const int parked : {1, 50, 2000}) {
      SCOPED_TRACE(testing::Message() << parked << " lights at " << place);
      std::vector<ViewLight> lights = lights_at_the_wall(400, 5);
      for (int i = 0; i < parked; ++i) lights.push_back(point_light({place, i % 2 ? place : 0, 0}, i % 3));
      expect_none_lost(lights);
    }
  }
}

// A parked light of radius 1 does not affect the wall's tiles.
TEST_P(Loss, AParkedLightIsListedNowhere) {
  for (const double place : {1e16, 1e19, 1e30, double(std::numeric_limits<float>::max())}) {
    const std::vector<ViewLight> lights = {point_light({place, 0, 0}, 1), point_light({0, 0, -place}, 1)};
    EXPECT_EQ(pairs(room(), wall_depth(wall_m), lights, GetParam()).listed, 0u) << place;
  }
}

// Outside the domain: surfaces beyond 1e15 m, and lights there.
TEST_P(Loss, NoneBeyondTheFarthestSurface) {
  for (const double distance : {1e15, 3e15, 1e17, 1e19, 1e25}) {
    SCOPED_TRACE(distance);
    Random random(6);
    std::vector<ViewLight> lights;
    for (int i = 0; i < 300; ++i) {
      const glm::dvec3 at = glm::dvec3((random.uniform() - 0.5), (random.uniform() - 0.5), -1) * distance;
      lights.push_back(point_light(at * (0.5 + random.uniform()), distance * random.uniform()));
    }
    const LitPairs found = pairs(room(), wall_depth(distance), lights, GetParam());
    EXPECT_EQ(found.lost, 0u);
    EXPECT_GT(found.lit, 1000u);
  }
}

// Squares of the distances underflow.
TEST_P(Loss, NoneInTheSmallest) {
  for (const double scale : {1e-12, 1e-15, 1e-18, 1e-20, 1e-24}) {
    SCOPED_TRACE(scale);
    View view = view_of(size, size, 60, 0.1 * scale);
    std::vector<ViewLight> lights = lights_at_the_wall(300, 7);
    for (ViewLight& light : lights) {
      light.position *= scale;
      light.radius_m *= scale;
    }
    const LitPairs found = pairs(view, wall_depth(wall_m), lights, GetParam());
    EXPECT_EQ(found.lost, 0u);
    EXPECT_GT(found.lit, 1000u);
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, Loss, testing::Values(KernelShape::lanes, KernelShape::group),
                         [](const auto& info) {
                           return info.param == KernelShape::lanes ? "lanes" : "group";
                         });

CullLight lamp(const glm::dvec3& position, double radius, double cos_outer = -1) {
  return {position, radius, {0, 0, -1}, cos_outer};
}

// A light 2^20 m from the others, so that its position rounds to 2^-32 m or coarser, reaches one pixel by
// less than that. view_from_world is (1 + stretch) times a rotation, which check_view accepts.
void expect_listed(double stretch, CullTest test, double cos_outer) {
  constexpr double rounding_m = 0x1p-32, radius_m = 0x1p-10, focal = 100, distance = 0.01, near_m = 0.001;
  const float depth = float(near_m / distance);
  const double side = (2 * 31.5 / 64 - 1) / focal * distance;
  const glm::dvec3 surface(side, side, -near_m / double(depth));
  CullView view{64, 64, glm::dmat4(0), glm::scale(glm::dmat4(1), glm::dvec3(1 + stretch))};
  view.clip_from_view[0][0] = view.clip_from_view[1][1] = focal;
  view.clip_from_view[2][3] = -1;
  view.clip_from_view[3][2] = near_m;
  glm::dvec3 at = surface / (1 + stretch);
  at.z = -(std::floor((radius_m - surface.z) / (1 + stretch) / rounding_m) - 1) * rounding_m;
  const double inside_m = radius_m - glm::length(at * (1 + stretch) - surface);
  ASSERT_TRUE(inside_m > 0 && inside_m < 3 * rounding_m) << inside_m;
  std::vector<CullLight> lights(128, lamp(at + glm::dvec3(0, 0, 0x1p20 + 0.1875), 1));
  lights[0] = lamp(at, radius_m, cos_outer);
  lights[0].direction = {0, 0, 1};  // from behind the surface

  LightCuller culler(test_device(), test_programs(), {.cull_test = test});
  culler.set_lights(lights);
  culler.set_view(view);
  ClGridStorage storage(test_device());
  const DepthBounds bounds = culler.depth_bounds({buffer_of(std::vector<float>(64 * 64, depth))});
  const LightGrid grid = culler.cull(bounds.opaque, storage);
  const HostGrid host = read_grid(test_device(), grid, storage);
  const glm::uvec2 cell = host.cells[31 / 16 * size_t(grid.cells_x) + 31 / 16];
  EXPECT_EQ(std::count(host.indices.begin() + cell.x, host.indices.begin() + cell.x + cell.y, 0u), 1);
}

TEST(StretchedViews, LoseNoLight) {
  for (const CullTestRow& row : cull_tests) {
    for (const double stretch : {0.0, 2.4e-6, 3.5e-6, 4.9e-6}) {
      for (const double cos_outer : {-1.0, 0.5}) {  // without a cone, and with one around the pixel
        SCOPED_TRACE(testing::Message() << row.name << ", " << stretch << ", " << cos_outer);
        expect_listed(stretch, row.test, cos_outer);
      }
    }
  }
}

TEST(ChooseOrigin, IsTheMedianLightAsLongAsRoundingIsSmallBesideRadii) {
  EXPECT_EQ(choose_origin(std::vector{lamp({1, 5, 0}, 1), lamp({2, 4, 0}, 1), lamp({9, 6, 1000}, 1)}).fixed,
            glm::dvec3(2, 5, 0));
  std::vector<CullLight> lights(100, lamp({1, 2, 3}, 1));
  lights[0].position.x = 1e7;  // one may be far
  EXPECT_EQ(choose_origin(lights).fixed, glm::dvec3(1, 2, 3));
  for (int i = 1; i < 10; ++i) lights[i].position.x = 1e7;
  EXPECT_EQ(choose_origin(lights).fixed, std::nullopt);
}

TEST(ChooseOrigin, GivesConesTheLargestRoundingOfASpot) {
  const LightOrigin origin =
      choose_origin(std::vector{lamp({0, 0, 0}, 1, 0.5), lamp({0, 0, 0}, 1), lamp({100, 20, 8}, 1, 0.5)});
  ASSERT_TRUE(origin.fixed);
  EXPECT_EQ(origin.cone_slack_m, 128 * 0x1p-24 * (1 + double(MAX_STRETCH)));
}

// Kernels divide the axis by its length in float: where that is 0 or infinite, the sphere has to decide.
TEST(LightArrays, HaveNoConeWithoutADirection) {
  CullLight light = lamp({0, 0, 0}, 1, 0.5);
  for (const double length : {1e-15, 0.1, 3.0, 1e15}) {
    light.direction = {0, 0, length};
    EXPECT_EQ(light_arrays(std::vector{light}, {0, 0, 0}, 0, 1)[7], 0.5f - 1e-6f) << length;
  }
  for (const double length : {0.0, 1e-25, 1e25, double(NAN), double(INFINITY)}) {
    light.direction = {0, 0, length};
    EXPECT_EQ(light_arrays(std::vector{light}, {0, 0, 0}, 0, 1)[7], 2.0f) << length;
  }
}

TEST(ChooseOrigin, LeavesOutParkedLights) {
  EXPECT_EQ(
      choose_origin(std::vector{lamp({1e30, 0, 0}, 1), lamp({3, 4, 5}, 1), lamp({1e19, 0, 0}, 1)}).fixed,
      glm::dvec3(3, 4, 5));
}

}  // namespace
}  // namespace lightgrid
