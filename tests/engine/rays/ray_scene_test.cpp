// Changes of a scene: a refitted tree answers as a new one does. And inputs that it refuses.
#include "rays/ray_scene.h"

#include <gmock/gmock.h>

#include "base/error.h"
#include "cl/buffers.h"
#include "cl/transfer.h"
#include "rays/ray_scenes.h"
#include "support/error_of.h"

namespace lightgrid {
namespace {

using testing::HasSubstr;

glm::dmat4 somewhere(RandomNumbers& random) {
  glm::dmat4 m(1);
  for (int k = 0; k < 3; ++k) m[k] = glm::dvec4(random.in_cube(1.5), 0);
  m[3] = glm::dvec4(random.in_cube(2), 1);
  return m;
}

// 40 instances of 3 meshes of which some move, turn and grow in every step.
class RaysRefit : public testing::TestWithParam<KernelShape> {
 protected:
  std::vector<RayMesh> spans() const {
    std::vector<RayMesh> made;
    for (const Placed& m : meshes) made.push_back({m.positions, m.indices});
    return made;
  }
  std::vector<uint32_t> fresh() const {
    RayScene scene(rays_device(), rays_programs(), options);
    scene.set_meshes(spans());
    scene.set_instances(instances);
    return scene.occlusion(queries.points, queries.lights, queries.packets);
  }
  std::vector<uint32_t> kept() { return scene.occlusion(queries.points, queries.lights, queries.packets); }

  RandomNumbers random{9};
  const RayOptions options{.shape = GetParam(), .origin = glm::dvec3(0)};
  std::vector<Placed> meshes{placed(hard_soups()[0].triangles), placed(hard_soups()[1].triangles),
                             placed({hard_soups()[2].triangles[0]})};
  std::vector<RayInstance> instances = [this] {
    std::vector<RayInstance> made(40);
    for (int i = 0; i < 40; ++i) made[i] = {i % 3, somewhere(random), -1, i % 5 != 4};
    return made;
  }();
  const Queries queries = queries_of(hard_soups()[0].triangles, 16, 16, 12);
  RayScene scene{rays_device(), rays_programs(), options};
};

TEST_P(RaysRefit, AnswersAsATreeBuiltAnew) {
  scene.set_meshes(spans());
  scene.set_instances(instances);
  std::vector<uint32_t> before = kept();
  EXPECT_EQ(before, fresh());
  for (int step = 0; step < 6; ++step) {
    SCOPED_TRACE(step);
    const int movers = step == 3 ? 40 : step == 4 ? 0 : 1 + 3 * step;
    for (int i = 0; i < movers; ++i) instances[(i * 7 + step) % 40].world_from_object = somewhere(random);
    scene.set_instances(instances);
    const std::vector<uint32_t> now = kept();
    EXPECT_EQ(now, fresh());
    EXPECT_EQ(now == before, movers == 0) << "nothing that moves is seen";
    before = now;
  }
  EXPECT_EQ(scene.builds(), 1);
}

TEST_P(RaysRefit, MeshesMayDeform) {
  scene.set_meshes(spans());
  scene.set_instances(instances);
  const std::vector<uint32_t> before = kept();
  for (glm::vec3& p : meshes[1].positions) p = p * 0.7f + glm::vec3(random.in_cube(0.1));
  scene.set_meshes(spans());
  EXPECT_THAT(error_of([&] { kept(); }), HasSubstr("set_instances"));
  instances[0].world_from_object = somewhere(random);
  scene.set_instances(instances);
  EXPECT_EQ(kept(), fresh());
  EXPECT_NE(kept(), before);
  EXPECT_EQ(scene.builds(), 1);
}

TEST_P(RaysRefit, OtherTrianglesAreBuiltAnew) {
  scene.set_meshes(spans());
  scene.set_instances(instances);
  instances[3].casts = !instances[3].casts;
  scene.set_instances(instances);
  EXPECT_EQ(scene.builds(), 2);
  EXPECT_EQ(kept(), fresh());
  instances.pop_back();
  scene.set_instances(instances);
  EXPECT_EQ(scene.builds(), 3);
  meshes[0].indices.resize(30);
  scene.set_meshes(spans());
  scene.set_instances(instances);
  EXPECT_EQ(scene.builds(), 4);
  EXPECT_EQ(kept(), fresh());
  EXPECT_EQ(scene.first_triangle(1), 10u);
}

INSTANTIATE_TEST_SUITE_P(Shapes, RaysRefit, testing::Values(KernelShape::lanes, KernelShape::group),
                         [](const auto& info) {
                           return info.param == KernelShape::lanes ? "Lanes" : "Group";
                         });

// The same soup at the world's origin and 2^17 m away: the same bits.
TEST(RaysScene, AMovedSceneHasTheSameBits) {
  const Soup soup = hard_soups()[0];
  Placed near = placed(soup.triangles), far = near;
  for (glm::vec3& p : near.positions) p = glm::floor(p * 256.0f) / 256.0f;
  far.positions = near.positions;
  far.instances[0].world_from_object[3] = {131072, -131072, 262144, 1};
  const Queries q = queries_of(soup.triangles, 16, 16, 2);
  RayScene a = scene_of(near, {.origin = glm::dvec3(0)}),
           b = scene_of(far, {.origin = glm::dvec3(131072, -131072, 262144)});
  EXPECT_EQ(a.occlusion(q.points, q.lights, q.packets), b.occlusion(q.points, q.lights, q.packets));
}

TEST(RaysScene, CornersThatAreNotFiniteHideNothingAndAreCounted) {
  const Soup soup = hard_soups()[0];
  Placed good = placed(soup.triangles), bad = good;
  bad.positions[4].y = NAN;
  bad.positions[900 % bad.positions.size()].x = INFINITY;
  RayScene with = scene_of(bad, {.origin = glm::dvec3(0)});
  EXPECT_EQ(with.invalid_triangles(), 2u);
  EXPECT_EQ(with.triangles(), uint32_t(soup.triangles.size()));
  std::vector<Corners> left = soup.triangles;
  left[1] = left[900 % bad.positions.size() / 3] = Corners{};
  const Queries q = queries_of(left, 8, 16, 2);
  EXPECT_EQ(with.occlusion(q.points, q.lights, q.packets),
            scene_of(placed(left), {.origin = glm::dvec3(0)}).occlusion(q.points, q.lights, q.packets));
}

// Reads triangles by their numbers, and asks for the shadow of each one's first corner moved by 0.5 m.
constexpr const char* own_kernel = R"(
kernel void own_kernel(RAYS_ARGUMENTS, double x, double y, double z, global float* corners, global int* hidden) {
  const RayScene scene = RAYS_SCENE;
  const uint i = (uint)get_global_id(0);
  float c[9];
  rays_triangle(&scene, i, c);
  for (int k = 0; k < 9; ++k) corners[9 * i + k] = c[k];
  const RaySource light = {x, y, z, 1};
  int last_blocker = -1;
  hidden[i] = rays_hidden(&scene, light, real3(c[0], c[1] - 0.5f, c[2]), 1e-3f, 1, (int)i, &last_blocker);
})";

TEST(RaysScene, IsReadByKernelsOfOthers) {
  const Placed p = placed(hard_soups()[0].triangles);
  RayScene scene = scene_of(p, {.origin = glm::dvec3(1, 2, 3)});
  const std::vector<Corners> expected = p.relative({1, 2, 3});
  const size_t count = expected.size();
  cl::Kernel kernel =
      rays_programs().kernel_of_source("own_kernel", RayScene::kernel_text() + own_kernel, scene.defines());
  const cl::Buffer corners = device_buffer(rays_device(), count * 36),
                   hidden = device_buffer(rays_device(), count * 4);
  const glm::dvec3 light(0.3, 0.7, -4);
  const ClArguments arguments =
      scene.arguments() +
      ClArguments{{"x", light.x}, {"y", light.y}, {"z", light.z}, {"corners", corners}, {"hidden", hidden}};
  for (size_t i = 0; i < arguments.size(); ++i)
    kernel.setArg(cl_uint(i), arguments[i].bytes, arguments[i].value);
  launch(rays_device(), "own_kernel", kernel, cl::NDRange(count), cl::NullRange);
  std::vector<Corners> read(count);
  std::vector<int> bits(count);
  read_buffer(rays_device(), "corners", corners, read.data(), count * 36);
  read_buffer(rays_device(), "hidden", hidden, bits.data(), count * 4);
  EXPECT_EQ(read, expected);
  Queries q{.lights = {{light, 1}}};
  for (size_t i = 0; i < count; ++i)
    q.points.push_back({expected[i][0] - glm::vec3(0, 0.5f, 0), 1e-3f, int(i)});
  for (uint32_t block = 0; 16 * block < count; ++block) q.packets.push_back({block, 0});
  const std::vector<uint32_t> packed = scene.occlusion(q.points, q.lights, q.packets);
  for (size_t i = 0; i < count; ++i) EXPECT_EQ(bits[i], int(packed[i / 16] >> i % 16 & 1)) << i;
}

TEST(RaysScene, NothingHidesNothing) {
  RayScene scene(rays_device(), rays_programs());
  scene.set_instances({});
  const RayPoint point;
  const RayLight light(1, 2, 3, 1);
  const RayPacket packet;
  EXPECT_EQ(scene.occlusion({&point, 1}, {&light, 1}, {&packet, 1}), std::vector<uint32_t>{0});
  EXPECT_TRUE(scene.occlusion({}, {}, {}).empty());
}

TEST(RaysScene, WrongArgumentsAreRefused) {
  RayScene scene(rays_device(), rays_programs());
  EXPECT_THAT(error_of([&] { scene.occlusion({}, {}, {}); }), HasSubstr("set_instances"));
  EXPECT_THAT(error_of([&] { scene.arguments(); }), HasSubstr("set_instances"));
  const glm::vec3 positions[3] = {};
  const uint32_t indices[] = {0, 1, 2, 3};
  const RayMesh past{positions, {indices + 1, 3}}, part{positions, indices}, good{positions, {indices, 3}};
  EXPECT_THAT(error_of([&] { scene.set_meshes({&past, 1}); }), HasSubstr("mesh 0: index 3 is past its 3"));
  EXPECT_THAT(error_of([&] {
                scene.set_meshes({&part, 1});
              }),
              HasSubstr("mesh 0: 4 indices are no triangles"));
  scene.set_meshes({&good, 1});
  RayInstance instance{.mesh = 1};
  EXPECT_THAT(error_of([&] {
                scene.set_instances({&instance, 1});
              }),
              HasSubstr("instance 0 has mesh 1 of 1"));
  instance.mesh = 0;
  instance.world_from_object[2][3] = 0.5;
  EXPECT_THAT(error_of([&] { scene.set_instances({&instance, 1}); }), HasSubstr("finite and affine"));
  instance.world_from_object[2][3] = 0;
  scene.set_instances({&instance, 1});
  const RayPoint point;
  const RayLight light(1, 2, 3, 1);
  for (const RayPacket packet : {RayPacket{1, 0}, RayPacket{0, 1}})
    EXPECT_THAT(error_of([&] {
                  scene.occlusion({&point, 1}, {&light, 1}, {&packet, 1});
                }),
                HasSubstr("packet 0"));
  EXPECT_THAT(error_of([&] { RayScene(rays_device(), rays_programs(), {.origin = glm::dvec3(0, NAN, 0)}); }),
              HasSubstr("origin"));
}

}  // namespace
}  // namespace lightgrid
