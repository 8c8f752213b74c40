// Several views of one scene: each draws what a view of a scene of its own does, and the geometry is on the
// device once.
#include "raster/raster_scene.h"

#include <gmock/gmock.h>

#include "base/error.h"
#include "raster/many_triangles.h"
#include "support/error_of.h"

namespace lightgrid {
namespace {

using testing::HasSubstr;

class RasterScenes : public testing::TestWithParam<KernelShape> {
 protected:
  RasterScenes() { geometry.set_meshes(meshes_of(left)); }
  RasterView view_of(const TriangleScene& seen) {
    RasterView view(geometry, raster_programs(), options);
    view.set_instances(seen.instances);
    view.set_camera(seen.camera);
    return view;
  }

  const RasterOptions options{.shape = GetParam()};
  // Two eyes; the right one sees fewer instances and has another size.
  const TriangleScene left = many_triangles(2000, 161, 120, 5), right = [this] {
    TriangleScene scene = left;
    scene.camera = plain_view(70, 133);
    scene.camera.eye.x = 0.2;
    scene.instances.pop_back();
    return scene;
  }();
  RasterScene geometry{raster_device()};
};

TEST_P(RasterScenes, TwoViewsDrawTheBytesOfTwoScenes) {
  RasterView left_view = view_of(left), right_view = view_of(right);
  const Drawn left_alone = drawn(left, options), right_alone = drawn(right, options);
  EXPECT_GT(left_alone.covered(), 1000u);
  EXPECT_GT(right_alone.covered(), 1000u);
  for (int frame = 0; frame < 2; ++frame) {
    const Drawn of_left = drawn_by(left_view, left), of_right = drawn_by(right_view, right);
    EXPECT_TRUE(of_left.same_image(left_alone));
    EXPECT_TRUE(of_right.same_image(right_alone));
  }
}

TEST_P(RasterScenes, GeometryIsOnTheDeviceOnce) {
  const size_t bytes = geometry.memory_bytes();
  EXPECT_GT(bytes, geometry.geometry_bytes());
  RasterView first = view_of(left), second = view_of(right);
  first.draw();
  second.draw();
  EXPECT_EQ(first.buffers().indices(), second.buffers().indices());
  EXPECT_EQ(geometry.memory_bytes(), bytes);
  // A view's own memory is for what it draws, whatever else the scene has.
  TriangleScene nothing;
  nothing.camera = left.camera;
  const RasterScene empty(raster_device());
  RasterView of_empty(empty, raster_programs(), options), of_full = view_of(nothing);
  of_empty.set_instances({});
  of_empty.set_camera(left.camera);
  of_empty.draw();
  of_full.draw();
  EXPECT_EQ(of_full.memory_bytes(), of_empty.memory_bytes());
}

TEST_P(RasterScenes, ViewsNeedTheirInstancesAgainAfterOtherMeshes) {
  RasterView view = view_of(left);
  const Drawn before = drawn_by(view, left);
  geometry.set_meshes(meshes_of(left));
  EXPECT_THAT(error_of([&] { view.draw(); }), HasSubstr("set_instances has to come again"));
  view.set_instances(left.instances);
  EXPECT_TRUE(drawn_by(view, left).same_image(before));
}

TEST_P(RasterScenes, DrawingOrderIsTheMeshsAndChangesNoImage) {
  const RasterOptions ordered{.shape = GetParam(), .drawing_order = true};
  RasterView lists(geometry, raster_programs(), ordered);
  EXPECT_THAT(error_of([&] { lists.set_instances(left.instances); }),
              HasSubstr("mesh 0 has no drawing_order"));
  std::vector<RasterMesh> meshes = meshes_of(left);
  for (RasterMesh& mesh : meshes) mesh.drawing_order = true;
  geometry.set_meshes(meshes);
  RasterView view = view_of(left);
  EXPECT_TRUE(drawn_by(view, left).same_image(drawn(left, options)));
  lists.set_instances(left.instances);
  lists.set_camera(left.camera);
  EXPECT_GT(lists.list().tiles_x, 0u);
  EXPECT_EQ(lists.counts().records, view.counts().records);
}

INSTANTIATE_TEST_SUITE_P(Shapes, RasterScenes, testing::Values(KernelShape::lanes, KernelShape::group),
                         [](const auto& info) {
                           return info.param == KernelShape::lanes ? "Lanes" : "Group";
                         });

}  // namespace
}  // namespace lightgrid
