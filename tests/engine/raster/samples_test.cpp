// Several samples a pixel, each against the coverage oracle.
#include <limits>
#include <map>

#include "culling/light_culler.h"
#include "raster/random_triangles.h"

namespace lightgrid {
namespace {

class RasterSamples : public testing::TestWithParam<KernelShape> {
 protected:
  // An image of 4 samples a pixel.
  Drawn image_of(const TriangleScene& scene) const { return drawn(scene, {.shape = GetParam()}); }
};

TEST_P(RasterSamples, EachShowsWhatCoversItsPlaceInThePixel) {
  size_t covered = 0, edges = 0;
  for (int kind = 0; kind < 6; ++kind) {
    SCOPED_TRACE(kind);
    RandomNumbers random(uint32_t(40 + kind));
    TriangleScene scene = scene_of(plain_view(130, 71));
    scene.camera.grid.samples = 4;
    scene.instances[0].two_sided = kind % 2;
    for (int i = 0; i < 150; ++i) add_random_triangle(random, kind, scene);
    const Drawn image = image_of(scene);
    ASSERT_EQ(image.triangles.size(), size_t(4 * 130 * 71));
    for (int s = 0; s < 4; ++s) {
      SCOPED_TRACE(s);
      const Drawn one = sample_of(image, s);
      ASSERT_EQ(count_wrong(one, oracle_of(one, scene, standard_locations[s])), 0);
      covered += one.covered();
    }
    for (size_t i = 0; i < image.triangles.size(); i += 4)
      edges += image.triangles[i] != image.triangles[i + 1] || image.triangles[i] != image.triangles[i + 3];
  }
  EXPECT_GT(covered, 100000u) << "little was drawn";
  EXPECT_GT(edges, 3000u) << "samples of a pixel show the same everywhere";
}

// As Vulkan 1.3 and Direct3D 11 list them: 1/16 pixel, y down.
const std::map<int, std::vector<glm::ivec2>>& listed_locations() {
  static const std::map<int, std::vector<glm::ivec2>> all = {
      {2, {{4, 4}, {-4, -4}}},
      {4, {{-2, -6}, {6, -2}, {-6, 2}, {2, 6}}},
      {8, {{1, -3}, {-1, 3}, {5, 1}, {-3, -5}, {-5, 5}, {-7, -1}, {3, 7}, {7, -7}}}};
  return all;
}

// Only one sample of a pixel meets the triangle, which is smaller than the distance between samples.
TEST_P(RasterSamples, ATinyTriangleCoversTheSampleThatItHolds) {
  for (const auto& [samples, locations] : listed_locations()) {
    for (int s = 0; s < samples; ++s) {
      TriangleScene scene = scene_of(plain_view(16, 16));
      scene.camera.grid.samples = samples;
      const glm::ivec2 place = locations[size_t(s)];
      const double x = 5.5 + place.x / 16.0, y = 9.5 - place.y / 16.0;
      add_triangle(scene.meshes[0], at(scene.camera, x - 0.1, y - 0.1, 1),
                   at(scene.camera, x + 0.1, y - 0.1, 1), at(scene.camera, x, y + 0.1, 1));
      const Drawn image = image_of(scene);
      std::vector<size_t> shown;
      for (size_t i = 0; i < image.triangles.size(); ++i) {
        if (image.triangles[i] != no_triangle) shown.push_back(i);
      }
      EXPECT_EQ(shown, std::vector<size_t>{size_t(samples * (9 * 16 + 5) + s)}) << samples;
    }
  }
}

// The image is what depth bounds of as many samples read.
TEST_P(RasterSamples, AreTheCullersDepths) {
  RandomNumbers random(9);
  TriangleScene scene = scene_of(plain_view(120, 72));
  scene.camera.grid.samples = 4;
  scene.instances[0].two_sided = true;
  for (int i = 0; i < 200; ++i) add_random_triangle(random, 1, scene);
  Rasterizer rasterizer(raster_device(), raster_programs(), {.shape = GetParam()});
  set_scene(rasterizer, scene);
  const Visibility image = rasterizer.draw();
  const std::vector<float> depths = read_all<float>(image.depth, size_t(4 * 120 * 72));
  LightCuller culler(raster_device(), raster_programs(), {.tile = 8, .samples = 4});
  const RasterCamera& view = scene.camera;
  culler.set_view(
      {view.grid.width, view.grid.height, view.clip_from_view, view.view_from_world, view.eye, {}, {}});
  const std::vector<DepthInterval> bounds = culler.read_bounds(culler.depth_bounds({image.depth}).opaque);
  int with_surface = 0;
  for (int tile = 0; tile < 15 * 9; ++tile) {
    double near = std::numeric_limits<double>::infinity(), far = 0;
    for (int y = tile / 15 * 8; y < tile / 15 * 8 + 8; ++y) {
      for (int i = 4 * (y * 120 + tile % 15 * 8); i < 4 * (y * 120 + tile % 15 * 8 + 8); ++i) {
        if (depths[size_t(i)] == 0) continue;
        near = std::min(near, 0.1 / depths[size_t(i)]);
        far = std::max(far, 0.1 / depths[size_t(i)]);
      }
    }
    const DepthInterval& found = bounds[size_t(tile)];
    if (far == 0) {
      EXPECT_GT(found.near, found.far) << "tile " << tile;
      continue;
    }
    ++with_surface;
    EXPECT_LE(found.near, near);
    EXPECT_NEAR(found.near, near, 1e-5 * near);
    EXPECT_GE(found.far, far);
    EXPECT_NEAR(found.far, far, 1e-5 * far);
  }
  EXPECT_GT(with_surface, 20);
}

TEST(RasterSampleCounts, OthersAreRefused) {
  Rasterizer rasterizer(raster_device(), raster_programs());
  RasterCamera view = plain_view(8, 8);
  view.grid.samples = 3;
  EXPECT_THROW(rasterizer.set_camera(view), Error);
}

INSTANTIATE_TEST_SUITE_P(Shapes, RasterSamples, testing::Values(KernelShape::lanes, KernelShape::group),
                         [](const auto& info) {
                           return info.param == KernelShape::lanes ? "Lanes" : "Group";
                         });

}  // namespace
}  // namespace lightgrid
