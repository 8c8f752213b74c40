// Instances that move, or are left out, between two frames of one rasteriser.
#include <algorithm>

#include "raster/many_triangles.h"

namespace lightgrid {
namespace {

TEST(Rasterizer, InstancesThatMoveKeepTheirNumbers) {
  TriangleScene scene = many_triangles(300, 120, 100, 5);
  Rasterizer rasterizer(raster_device(), raster_programs());
  set_scene(rasterizer, scene);
  drawn_by(rasterizer, scene);
  for (RasterInstance& i : scene.instances) i.world_from_object[3].x += 0.25;
  rasterizer.set_instances(scene.instances);
  EXPECT_TRUE(drawn_by(rasterizer, scene).same_image(drawn(scene)));
  scene.instances[0].two_sided = true;
  rasterizer.set_instances(scene.instances);
  EXPECT_TRUE(drawn_by(rasterizer, scene).same_image(drawn(scene)));
}

// Instances that are not drawn, in each shape: the others' pixels as if they were not
// there, under the same numbers.
class InstancesNotDrawn : public testing::TestWithParam<KernelShape> {
 protected:
  InstancesNotDrawn() { set_scene(rasterizer, scene); }

  // Draws instances 0 and 2, and moves the numbers of a scene that has them alone to where theirs are.
  void expect_instance_1_left_out() {
    TriangleScene others = scene;
    const uint32_t first = uint32_t(scene.meshes[0].indices.size() / 3),
                   left_out = uint32_t(scene.meshes[1].indices.size() / 3);
    others.instances.erase(others.instances.begin() + 1);
    Drawn expected = drawn(others, options);
    for (uint32_t& triangle : expected.triangles) {
      if (triangle != no_triangle && triangle >= first) triangle += left_out;
    }
    const Drawn image = drawn_by(rasterizer, scene);
    EXPECT_TRUE(image.same_image(expected));
    EXPECT_EQ(image.counts.triangles, expected.counts.triangles);
    EXPECT_EQ(image.counts.clusters, expected.counts.clusters);
    EXPECT_EQ(image.counts.records, expected.counts.records);
  }

  TriangleScene scene = many_triangles(900, 121, 99, 6);
  const RasterOptions options{.shape = GetParam()};
  Rasterizer rasterizer{raster_device(), raster_programs(), options};
};

TEST_P(InstancesNotDrawn, LeaveTheOthersAsTheyAre) {
  const Drawn all = drawn_by(rasterizer, scene);
  scene.instances[1].drawn = false;
  rasterizer.set_instances(scene.instances);
  expect_instance_1_left_out();
  // An instance that moves while it is left out is later drawn at its new place.
  scene.instances[1].world_from_object[3].x = 1;
  rasterizer.set_instances(scene.instances);
  expect_instance_1_left_out();
  scene.instances[1].drawn = true;
  scene.instances[1].world_from_object[3].x = 0;
  rasterizer.set_instances(scene.instances);
  EXPECT_TRUE(drawn_by(rasterizer, scene).same_image(all));
}

TEST_P(InstancesNotDrawn, ByANumberAlone) {
  const Drawn all = drawn_by(rasterizer, scene);
  rasterizer.set_drawn(1, false);
  scene.instances[1].drawn = false;
  expect_instance_1_left_out();
  rasterizer.set_drawn(1, true);
  EXPECT_TRUE(drawn_by(rasterizer, scene).same_image(all));
  EXPECT_THROW(rasterizer.set_drawn(scene.instances.size(), true), Error);
}

TEST_P(InstancesNotDrawn, FromTheFirstFrame) {
  for (RasterInstance& i : scene.instances) i.drawn = false;
  const Drawn nothing = drawn(scene, options);
  EXPECT_EQ(nothing.covered(), 0u);
  EXPECT_EQ(nothing.counts.triangles, 0u);
  EXPECT_EQ(nothing.counts.clusters, 0u);
}

INSTANTIATE_TEST_SUITE_P(Shapes, InstancesNotDrawn, testing::Values(KernelShape::lanes, KernelShape::group),
                         [](const auto& info) {
                           return info.param == KernelShape::lanes ? "Lanes" : "Group";
                         });

TEST(Rasterizer, CallsMeanwhileOnceAFrame) {
  const TriangleScene scene = many_triangles(30000, 300, 200, 2);
  Rasterizer rasterizer(raster_device(), raster_programs());
  set_scene(rasterizer, scene);
  int calls = 0;
  rasterizer.draw([&] { ++calls; });
  EXPECT_GE(rasterizer.counts().redone, 1);
  EXPECT_EQ(calls, 1);
}

}  // namespace
}  // namespace lightgrid
