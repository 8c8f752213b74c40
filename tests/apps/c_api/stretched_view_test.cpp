// A view matrix that is not exactly a rotation, through the C interface: no light is lost.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "c_api/lightgrid.h"
#include "c_api/owned.h"

namespace lightgrid::app {
namespace {

constexpr int size = 64, pixel = 31;
constexpr double focal = 100, near_m = 0.001, radius_m = 0x1p-10;
constexpr float depth = 0.1f;

lightgrid_projection stretched_projection(double stretch) {
  lightgrid_projection p{};
  p.width = p.height = size;
  p.clip_from_view[0] = p.clip_from_view[5] = focal;
  p.clip_from_view[11] = -1;
  p.clip_from_view[14] = near_m;
  for (const int diagonal : {0, 5, 10}) p.view_from_world[diagonal] = 1 + stretch;
  p.view_from_world[15] = 1;
  return p;
}

// The first light reaches the pixel by about 2^-32 m. The others, 2^20 m away, are where positions are
// measured from, so that the first light's position rounds by half a unit in the last place.
std::vector<lightgrid_light> lights_at(double stretch) {
  const double distance = near_m / double(depth), side = ((pixel + 0.5) * 2 / size - 1) / focal * distance;
  const double z = -std::floor((distance + radius_m) / (1 + stretch) * 0x1p32 - 1) * 0x1p-32;
  std::vector<lightgrid_light> lights(128);
  for (lightgrid_light& light : lights) {
    lightgrid_default_light(&light);
    light.position[0] = light.position[1] = side / (1 + stretch);
    light.position[2] = z + 0x1p20 + 0.1875;
    light.radius_m = 1;
  }
  lights[0].position[2] = z;
  lights[0].radius_m = float(radius_m);
  return lights;
}

TEST(StretchedProjections, LoseNoLight) {
  const OwnedDevice device = open_device("none");
  std::vector<float> depths(size * size, depth);
  const lightgrid_image image{depths.data(), size, size, LIGHTGRID_R_F32, size * sizeof(float)};
  for (const char* test : {"sphere", "planes", "aabb", "planes+aabb", "exact"}) {
    for (const double stretch : {0.0, 2.4e-6, 3.5e-6, 4.9e-6}) {
      const lightgrid_projection projection = stretched_projection(stretch);
      const std::vector<lightgrid_light> lights = lights_at(stretch);
      lightgrid_lists* culled = nullptr;
      must(lightgrid_cull(device.get(), &projection, &image, lights.data(), lights.size(), nullptr,
                          Words{(std::string("cull-test=") + test).c_str()}, &culled));
      const OwnedLists owned(culled);
      lightgrid_grid grid;
      must(lightgrid_lists_get(culled, &grid));
      const uint32_t* cell = grid.cells + 2 * (pixel / grid.tile * grid.cells_x + pixel / grid.tile);
      EXPECT_EQ(std::count(grid.indices + cell[0], grid.indices + cell[0] + cell[1], 0u), 1)
          << test << ", " << stretch;
    }
  }
}

// A larger stretch is refused by name.
TEST(StretchedProjections, AreRefusedPastTheirBound) {
  const OwnedDevice device = open_device("none");
  std::vector<float> depths(size * size, depth);
  const lightgrid_image image{depths.data(), size, size, LIGHTGRID_R_F32, size * sizeof(float)};
  const lightgrid_projection projection = stretched_projection(5.1e-6);
  const std::vector<lightgrid_light> lights = lights_at(0);
  lightgrid_lists* culled = nullptr;
  EXPECT_NE(lightgrid_cull(device.get(), &projection, &image, lights.data(), lights.size(), nullptr, nullptr,
                           &culled),
            LIGHTGRID_OK);
  EXPECT_THAT(lightgrid_error_message(), testing::HasSubstr("view_from_world is not rigid"));
}

}  // namespace
}  // namespace lightgrid::app
