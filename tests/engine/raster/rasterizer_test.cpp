// The rasteriser's promises besides coverage: order, room, errors.
#include "raster/raster_view.h"

#include <gmock/gmock.h>

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>

#include "base/error.h"
#include "cl/buffers.h"
#include "cl/launch.h"
#include "raster/many_triangles.h"
#include "shared/raster_params.h"
#include "shared/surface_records.h"

namespace lightgrid {
namespace {

using testing::HasSubstr;

// A rectangle of pixels at distance w, as two triangles.
TriangleScene::MeshData rectangle(const RasterCamera& view, double x0, double y0, double x1, double y1,
                                  double w) {
  return {{at(view, x0, y0, w), at(view, x1, y0, w), at(view, x1, y1, w), at(view, x0, y1, w)},
          {0, 1, 2, 0, 2, 3}};
}

TEST(Rasterizer, DrawsNothingWhereThereIsNothing) {
  TriangleScene scene;
  scene.camera = plain_view(17, 9);
  Rasterizer rasterizer(raster_device(), raster_programs());
  rasterizer.set_camera(scene.camera);
  Drawn nothing = drawn_by(rasterizer, scene);
  EXPECT_THAT(nothing.triangles, testing::Each(no_triangle));
  EXPECT_THAT(nothing.depths, testing::Each(0.0f));
  scene.meshes.push_back({});
  scene.instances.push_back({});
  nothing = drawn(scene);
  EXPECT_THAT(nothing.triangles, testing::Each(no_triangle));
}

TEST(Rasterizer, NumbersTrianglesInDrawingOrderAndSaysWhatTheyBelongTo) {
  TriangleScene scene;
  scene.camera = plain_view(40, 20);
  scene.meshes = {rectangle(scene.camera, 0, 0, 10, 20, 2), rectangle(scene.camera, 10, 0, 20, 20, 3)};
  glm::dmat4 right(1);
  right[3].x = at(scene.camera, 40, 0, 2).x - at(scene.camera, 20, 0, 2).x;
  scene.instances = {{.mesh = 1},
                     {.mesh = 0, .alpha_material = 7},
                     {.mesh = 0, .world_from_object = right, .two_sided = true}};
  Rasterizer rasterizer(raster_device(), raster_programs());
  set_scene(rasterizer, scene);
  const Drawn image = drawn_by(rasterizer, scene);
  const auto number = [&](int x, int y) { return image.triangles[size_t(y) * 40 + x]; };
  EXPECT_EQ(number(15, 2), 0u);
  EXPECT_EQ(number(15, 18), 1u);
  EXPECT_EQ(number(5, 2), 2u);
  EXPECT_EQ(number(5, 18), 3u);
  EXPECT_EQ(number(25, 2), 4u);
  EXPECT_EQ(number(25, 18), 5u);
  EXPECT_EQ(number(35, 10), no_triangle);
  EXPECT_FLOAT_EQ(image.depths[5], 0.1f / 2);
  EXPECT_FLOAT_EQ(image.depths[15], 0.1f / 3);
  EXPECT_EQ(image.depths[35], 0);

  EXPECT_EQ(read_all<uint32_t>(rasterizer.buffers().triangle_instance, 6),
            (std::vector<uint32_t>{0, 0, 1, 1, 2, 2}));
  const std::vector<uint32_t> indices = read_all<uint32_t>(rasterizer.buffers().indices, 12);
  for (uint32_t triangle = 0; triangle < 6; ++triangle) {
    const RasterInstanceRecord& instance = image.instances[triangle / 2];
    EXPECT_EQ(instance.first_triangle, triangle / 2 * 2);
    EXPECT_EQ(instance.triangle_count, 2u);
    EXPECT_EQ(instance.first_vertex, triangle < 2 ? 4u : 0u);
    for (uint32_t k = 0; k < 3; ++k) {
      const uint32_t index = indices[instance.first_index + 3 * (triangle - instance.first_triangle) + k];
      EXPECT_EQ(index, scene.meshes[triangle < 2].indices[3 * (triangle % 2) + k]);
      const glm::vec4 clip = image.clip[instance.first_clip_vertex + index];
      EXPECT_EQ(clip.w, triangle < 2 ? 3.0f : 2.0f);
      EXPECT_EQ(clip.z, 0.1f);
    }
  }
  EXPECT_EQ(image.instances[1].alpha_material, 7);
  EXPECT_EQ(image.instances[2].flags, RASTER_TWO_SIDED);
}

// Tests that must pass in each shape.
class RasterizerShapes : public testing::TestWithParam<KernelShape> {
 protected:
  RasterOptions options() const { return {.shape = GetParam()}; }
};

TEST_P(RasterizerShapes, OfEqualDepthsTheHighestNumberIsShown) {
  // The same triangles over and over, in clusters of different distance, so that a later one is drawn first.
  RandomNumbers random(4);
  TriangleScene scene;
  scene.camera = plain_view(150, 80);
  TriangleScene::MeshData one;
  for (int i = 0; i < 40; ++i) {
    const auto corner = [&] {
      return at(scene.camera, random.between(-20, 170), random.between(-20, 100), random.between(1, 4));
    };
    const glm::vec3 a = corner(), b = corner(), c = corner();
    add_triangle(one, a, b, c);
  }
  TriangleScene::MeshData nearer = one;
  add_triangle(nearer, at(scene.camera, -50, -50, 0.2), at(scene.camera, -49, -50, 0.2),
               at(scene.camera, -50, -49, 0.2));
  scene.meshes = {one, nearer};
  scene.instances = {{.mesh = 0}};
  const Drawn alone = drawn(scene, options());
  EXPECT_GT(alone.covered(), 3000u);
  scene.instances = {{.mesh = 0}, {.mesh = 1}, {.mesh = 0}};
  Drawn last = alone;
  for (uint32_t& triangle : last.triangles) triangle += triangle == no_triangle ? 0 : 81;
  EXPECT_TRUE(drawn(scene, options()).same_image(last));
}

TEST_P(RasterizerShapes, RoomThatIsShortGrowsAndNothingIsLost) {
  const TriangleScene few = many_triangles(10, 300, 200, 1), many = many_triangles(30000, 300, 200, 2);
  Rasterizer rasterizer(raster_device(), raster_programs(), options());
  set_scene(rasterizer, few);
  EXPECT_EQ(drawn_by(rasterizer, few).counts.redone, 0);
  set_scene(rasterizer, many);
  const Drawn grown = drawn_by(rasterizer, many), again = drawn_by(rasterizer, many);
  EXPECT_GE(grown.counts.redone, 2) << "for records and for lists";
  EXPECT_EQ(again.counts.redone, 0);
  EXPECT_TRUE(again.same_image(grown));
  EXPECT_EQ(count_wrong(grown, oracle_of(grown, many)), 0);
  EXPECT_GT(grown.counts.records, 16u * 256);
  set_scene(rasterizer, few);
  EXPECT_TRUE(drawn_by(rasterizer, few).same_image(drawn(few, options())));
}

std::string refusal(ErrorKind kind, auto&& call) {
  try {
    call();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), kind);
    return error.what();
  }
  return "no error";
}

TEST_P(RasterizerShapes, ListsAreRefusedWithoutDrawingOrder) {
  const TriangleScene scene = many_triangles(30, 70, 50, 3);
  Rasterizer rasterizer(raster_device(), raster_programs(), options());
  EXPECT_THAT(refusal(ErrorKind::input, [&] { rasterizer.list(); }), HasSubstr("drawing_order"));
  set_scene(rasterizer, scene);
  EXPECT_THAT(refusal(ErrorKind::input, [&] { rasterizer.list(); }), HasSubstr("drawing_order"));
  EXPECT_TRUE(drawn_by(rasterizer, scene).same_image(drawn(scene, options())));
}

// Kernels would read where there is nothing.
TEST_P(RasterizerShapes, MasksThatDoNotServeTheSceneAreRefused) {
  TriangleScene scene = many_triangles(30, 70, 50, 3);
  scene.instances[2].alpha_material = 4;
  Rasterizer rasterizer(raster_device(), raster_programs(), options());
  set_scene(rasterizer, scene);
  size_t vertices = 0;
  for (const TriangleScene::MeshData& mesh : scene.meshes) vertices += mesh.positions.size();
  const auto buffer = [](size_t bytes) { return device_buffer(raster_device(), bytes); };
  const RasterMasks enough{buffer(vertices * sizeof(SurfaceVertex)), buffer(5 * sizeof(SurfaceMaterial)),
                           buffer(4096)};
  RasterMasks masks = enough;
  masks.materials = cl::Buffer();
  EXPECT_THAT(refusal(ErrorKind::input, [&] { rasterizer.set_masks(masks); }), HasSubstr("materials"));
  masks = enough;
  masks.vertices = cl::Buffer();
  EXPECT_THAT(refusal(ErrorKind::input, [&] { rasterizer.set_masks(masks); }), HasSubstr("vertices"));
  masks = enough;
  masks.materials = buffer(4 * sizeof(SurfaceMaterial));
  rasterizer.set_masks(masks);
  EXPECT_THAT(refusal(ErrorKind::input, [&] { rasterizer.draw(); }), HasSubstr("alpha_material is 4"));
  masks = enough;
  masks.vertices = buffer((vertices - 1) * sizeof(SurfaceVertex));
  rasterizer.set_masks(masks);
  EXPECT_THAT(refusal(ErrorKind::input, [&] { rasterizer.draw(); }), HasSubstr("vertices"));
  rasterizer.set_masks({});
  EXPECT_TRUE(drawn_by(rasterizer, scene).same_image(drawn(scene, options())));
}

INSTANTIATE_TEST_SUITE_P(Shapes, RasterizerShapes, testing::Values(KernelShape::lanes, KernelShape::group),
                         [](const auto& info) {
                           return info.param == KernelShape::lanes ? "Lanes" : "Group";
                         });

// The widest and the highest view; 16,384 x 16,384 takes 2 GB and was tried by hand.
TEST(Rasterizer, LargestViews) {
  for (const auto& [width, height] : {std::pair{16384, 70}, std::pair{70, 16384}}) {
    TriangleScene scene;
    scene.camera = plain_view(width, height);
    scene.meshes.resize(1);
    scene.instances.resize(1);
    const RasterCamera& view = scene.camera;
    add_triangle(scene.meshes[0], at(view, -3e6, -2e6, 5), at(view, 2.1e6, -1e6, 4), at(view, 1e4, 9e6, 3));
    add_triangle(scene.meshes[0], at(view, 0, 0, 2), at(view, width, height - 0.5, 2),
                 at(view, width - 1, height, 2));
    add_triangle(scene.meshes[0], at(view, width - 3.75, 0.25, 1), at(view, width, 0, 1),
                 at(view, width, 3.5, 1));
    const Drawn image = drawn(scene);
    EXPECT_EQ(image.covered(), image.triangles.size());
    EXPECT_EQ(count_wrong(image, oracle_of(image, scene)), 0);
    for (const uint32_t triangle : {0u, 1u, 2u})
      EXPECT_GT(std::count(image.triangles.begin(), image.triangles.end(), triangle), 4);
  }
}

TEST(Rasterizer, RefusesWhatItCannotDraw) {
  Rasterizer rasterizer(raster_device(), raster_programs());
  const auto message = [](auto&& call) { return refusal(ErrorKind::input, call); };
  EXPECT_THAT(message([&] { rasterizer.draw(); }), HasSubstr("set_camera has to come before"));
  const std::vector<glm::vec3> positions(3);
  const std::vector<uint32_t> two = {0, 1}, past = {0, 1, 3};
  EXPECT_THAT(message([&] {
                rasterizer.set_meshes(std::vector<RasterMesh>{{positions, two}});
              }),
              HasSubstr("mesh 0: 2 indices"));
  EXPECT_THAT(message([&] {
                rasterizer.set_meshes(std::vector<RasterMesh>{{}, {positions, past}});
              }),
              HasSubstr("mesh 1: index 3"));
  EXPECT_THAT(message([&] { rasterizer.set_instances(std::vector<RasterInstance>(1)); }),
              HasSubstr("instance 0: there is no mesh 0"));
  const std::vector<uint32_t> one = {0, 1, 2};
  rasterizer.set_meshes(std::vector<RasterMesh>{{positions, one}});
  std::vector<RasterInstance> instances(1);
  instances[0].world_from_object[1][2] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(message([&] { rasterizer.set_instances(instances); }),
              HasSubstr("instance 0: its matrix holds nan"));
  instances[0].world_from_object = glm::dmat4(1);
  instances[0].world_from_object[1][3] = 1;
  EXPECT_THAT(message([&] { rasterizer.set_instances(instances); }), HasSubstr("not affine"));

  const auto refused = [&](auto&& change) {
    RasterCamera view = plain_view(10, 10);
    change(view);
    return message([&] { rasterizer.set_camera(view); });
  };
  EXPECT_THAT(refused([](RasterCamera& v) { v.grid.width = 0; }), HasSubstr("0 pixels"));
  EXPECT_THAT(refused([](RasterCamera& v) { v.grid.height = 16385; }), HasSubstr("16385 pixels"));
  EXPECT_THAT(refused([](RasterCamera& v) { v.eye.y = HUGE_VAL; }), HasSubstr("eye"));
  EXPECT_THAT(refused([](RasterCamera& v) { v.clip_from_view[0][0] = NAN; }),
              HasSubstr("clip_from_view holds nan"));
  EXPECT_THAT(refused([](RasterCamera& v) { v.view_from_world[0][0] = 2; }), HasSubstr("rigid"));
  EXPECT_THAT(refused([](RasterCamera& v) { v.clip_from_view[0][0] = -1; }), HasSubstr("mirrors"));
  EXPECT_THAT(refused([](RasterCamera& v) { v.clip_from_view[3][2] = -0.1; }), HasSubstr("reversed"));
  EXPECT_THAT(refused([](RasterCamera& v) { v.clip_from_view[0][3] = 0.1; }), HasSubstr("along -z"));
  EXPECT_EQ(refused([](RasterCamera&) {}), "no error");
}

// The process may take only this much more memory while it lives.
class MemoryLimit {
 public:
  explicit MemoryLimit(size_t bytes) {
    size_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    getrlimit(RLIMIT_AS, &before_);
    rlimit limit = before_;
    limit.rlim_cur = pages * size_t(getpagesize()) + bytes;
    setrlimit(RLIMIT_AS, &limit);
  }
  ~MemoryLimit() { setrlimit(RLIMIT_AS, &before_); }

 private:
  rlimit before_{};
};

// 2^32 triangles and indices in all, of one mesh of a million.
TEST(Rasterizer, RefusesMoreThanItCanNumberBeforeItTakesMemory) {
  const std::vector<glm::vec3> positions(3);
  std::vector<uint32_t> indices(3'000'000, 0);
  for (size_t i = 1; i < indices.size(); i += 3) {
    indices[i] = 1;
    indices[i + 1] = 2;
  }
  const RasterMesh mesh{positions, indices};
  Rasterizer rasterizer(raster_device(), raster_programs());
  rasterizer.set_meshes({&mesh, 1});
  const std::vector<RasterInstance> instances(4295);
  const std::vector<RasterMesh> meshes(1432, mesh);
  const MemoryLimit limit(size_t(1) << 30);
  EXPECT_THAT(refusal(ErrorKind::machine, [&] { rasterizer.set_instances(instances); }),
              HasSubstr("2^31 triangles"));
  EXPECT_THAT(refusal(ErrorKind::machine, [&] { rasterizer.set_meshes(meshes); }), HasSubstr("2^32 indices"));
}

}  // namespace
}  // namespace lightgrid
