// The volumes that lidr draws contain every pixel that their lights reach, from any position and with any
// camera.
#include <algorithm>
#include <cstdlib>

#include "oracle/position.h"
#include "passes/light_index/lidr_settings.h"
#include "passes/light_volumes/light_volumes.h"
#include "plan/settings/kernels.h"
#include "plan/settings/model.h"
#include "plan/settings/surfaces.h"
#include "scene/random.h"
#include "techniques/lidr_scenes.h"

namespace lightgrid {
using namespace lab;
namespace {

// No pixel is in more than 16 of the volumes of 18 lights.
TEST(Lidr, LightsAboutTheEyeTheNearPlaneAndEverything) {
  const Scene scene = awkward_lights();
  Camera ends = look_at({0, 0, 0}, {0, 0, -1});
  ends.far_m = 4.5;
  Camera orthographic = ends;
  orthographic.orthographic = true;
  orthographic.half_width_m = orthographic.half_height_m = 2;
  orthographic.near_m = -3;
  for (const View& view : {small_view(127, 73), make_view(ends, 127, 73), make_view(orthographic, 127, 73)}) {
    const Image forward = render(scene, view, "forward");
    for (const LidrVolumes volumes : {LidrVolumes::stencil, LidrVolumes::front_faces}) {
      for (const VolumeMeshes meshes :
           {VolumeMeshes::automatic, VolumeMeshes::icosahedron, VolumeMeshes::box}) {
        SCOPED_TRACE(fmt::format("near {} volumes {} mesh {}", view.near_m, int(volumes), int(meshes)));
        Settings settings = lidr_settings(LidrPacking::bitshift, 16, 255, volumes);
        settings.set(setting::volume_mesh, meshes);
        expect_within_limit(scene, view, settings, 16, forward);
      }
    }
  }
}

TEST(Lidr, WithEveryEffectsCodeAndWithBlinnPhong) {
  const View view = small_view(64, 48);
  for (const Scene& scene : {awkward_lights(), small_scene(false).scene}) {
    Settings settings;
    settings.set(setting::everything_on, true);
    expect_within_limit(scene, view, settings, 16, render(scene, view, "forward"));
    settings = {{setting::brdf, Brdf::blinn}};
    expect_within_limit(scene, view, settings, 16, render(scene, view, "forward", settings));
  }
}

TEST(Lidr, ImagesOfAnySize) {
  const Scene scene = awkward_lights();
  for (const glm::ivec2 size : {glm::ivec2(1, 1), glm::ivec2(17, 9), glm::ivec2(1279, 721)}) {
    SCOPED_TRACE(size.x);
    const View view = small_view(size.x, size.y);
    expect_within_limit(scene, view, lidr_settings(LidrPacking::bitshift, 16), 16,
                        render(scene, view, "forward"));
  }
}

// Fifteen lights, within a pixel's capacity.
Scene random_scene(Random& random) {
  SmallScene s = small_scene(false);
  for (int i = 0; i < 15; ++i) {
    const double radius = std::exp(random.uniform(-5, 5));
    const glm::dvec3 toward =
        glm::normalize(glm::dvec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)));
    // Near the wall, at its distance from one of its points, or around the eye.
    const glm::dvec3 on_wall(random.uniform(-2, 2), random.uniform(-2, 2), -4);
    const double away =
        random.uniform() < 0.5 ? radius * (1 - std::exp(random.uniform(-14, 0))) : radius * random.uniform();
    const glm::dvec3 place = (random.uniform() < 0.2 ? glm::dvec3(0) : on_wall) + toward * away;
    if (random.uniform() < 0.5) {
      add_point(s.scene, "lamp", place, {1, 1, 1}, 1, float(radius));
    } else {
      const double outer = std::exp(random.uniform(-3, 5));
      add_spot(s.scene, "torch", place, place - toward, {1, 1, 1}, 1, float(radius), 0,
               std::min(outer, 179.0));
    }
  }
  return s.scene;
}

View random_view(Random& random) {
  Camera camera = look_at({random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-3.9f, 2)},
                          {random.uniform(-1, 1), random.uniform(-1, 1), -4});
  camera.near_m = std::exp(random.uniform(-7, -2));
  camera.fov_y_rad = random.uniform(0.02f, 2.6f);
  if (random.uniform() < 0.3) camera.far_m = random.uniform(3, 8);
  if (random.uniform() < 0.2) {
    camera.orthographic = true;
    camera.half_width_m = camera.half_height_m = random.uniform(0.1f, 3);
    camera.near_m = -random.uniform(0, 5);
    camera.far_m = 10;
  }
  return make_view(camera, int(random.uniform(8, 160)), int(random.uniform(8, 100)));
}

// At a pixel with a free slot, no light that reaches it is missing: on scenes whose volumes lie around
// surfaces in every way.
TEST(Lidr, LosesNothingWhereThereIsRoom) {
  for (const char* name : {"hall", "spheres", "terrain", "street"}) {
    SCOPED_TRACE(name);
    const Scene scene = find_builtin_scene(name)->make();
    const Pairs p = pairs_of(scene, default_view(scene, 160, 90), {});
    size_t with_room = 0;
    for (size_t i = 0; i < p.pairs.lost_of_pixel.size(); ++i) {
      if (p.pairs.listed_of_pixel[i] == p.max_listed) continue;
      ++with_room;
      ASSERT_EQ(p.pairs.lost_of_pixel[i], 0u) << "pixel " << i;
    }
    EXPECT_GT(with_room, 1000u);
    EXPECT_EQ(p.pairs.wrong, 0u);
    EXPECT_LT(double(p.pairs.listed), 1.5 * double(p.pairs.lit))
        << "volumes are close to what they stand for";
  }
}

int trials_wished(int by_default) {
  const char* wish = std::getenv("LIGHTGRID_TRIALS");
  return wish ? std::atoi(wish) : by_default;
}

// Lights of all sizes about surfaces at all angles, cameras and planes of all kinds.
TEST(Lidr, LosesNothingOfRandomLightsInRandomViews) {
  const int trials = trials_wished(60);
  uint64_t lit = 0;
  for (int trial = 0; trial < trials; ++trial) {
    Random random(1000 + uint64_t(trial));
    const Scene scene = random_scene(random);
    const View view = random_view(random);
    for (const LidrVolumes volumes : {LidrVolumes::stencil, LidrVolumes::front_faces}) {
      Settings settings = lidr_settings(LidrPacking::bitshift, 16, 255, volumes);
      settings.set(setting::volume_mesh, VolumeMeshes(trial % 3));
      const Pairs p = pairs_of(scene, view, settings);
      ASSERT_LE(p.max_listed, 16u);
      ASSERT_EQ(p.pairs.lost, 0u) << "trial " << trial << " volumes " << int(volumes);
      ASSERT_EQ(p.pairs.wrong, 0u) << "trial " << trial << " volumes " << int(volumes);
      lit += p.pairs.lit;
    }
  }
  EXPECT_GT(lit, uint64_t(trials) * 1000);
}

// Fifteen lights that reach a pixel's surface by 10^-5 to 10^-7 of their radius, exactly where a face of
// their mesh touches the sphere.
Scene lights_tangent_to_faces(Random& random, const View& view, const LightMesh& mesh,
                              const std::vector<float>& depth) {
  SmallScene s = small_scene(false);
  const std::vector<uint32_t> pixels = covered_pixels(depth);
  for (int i = 0; i < 15 && !pixels.empty(); ++i) {
    const uint32_t pixel = pixels[random.next() % pixels.size()];
    const glm::dvec3 p =
        position_from_depth(view, int(pixel) % view.width, int(pixel) / view.width, depth[pixel]);
    const size_t face = random.next() % (mesh.indices.size() / 3) * 3;
    const glm::dvec3 a = mesh.positions[mesh.indices[face]], b = mesh.positions[mesh.indices[face + 1]],
                     c = mesh.positions[mesh.indices[face + 2]];
    const glm::dvec3 normal = glm::normalize(glm::cross(b - a, c - a));
    const float radius = std::exp(random.uniform(-5, 4));
    const glm::dvec3 in_view = p - normal * (double(radius) * (1 - std::exp(random.uniform(-16, -11))));
    add_point(s.scene, "lamp", {0, 0, 0}, {1, 1, 1}, 1, radius);
    s.scene.lights.back().position = glm::transpose(glm::dmat3(view.view_from_world)) * in_view + view.eye;
  }
  return s.scene;
}

// The rounding of lights, matrices, corners and depth must stay within the volumes' slack: without it, some
// are lost.
TEST(Lidr, LosesNothingOfLightsTangentToTheirMeshes) {
  const int trials = trials_wished(30);
  for (int trial = 0; trial < trials; ++trial) {
    Random random(5000 + uint64_t(trial));
    const View view = random_view(random);
    const Scene dark = small_scene(false).scene;
    TechniqueRun empty(test_devices(), dark, view, {}, find_technique("forward"));
    empty.run_frame();
    const VolumeMeshes meshes = trial % 2 ? VolumeMeshes::icosahedron : VolumeMeshes::box;
    const Scene scene = lights_tangent_to_faces(
        random, view, meshes == VolumeMeshes::box ? box_mesh() : ball_mesh(0), read_depth(empty));
    for (const LidrVolumes volumes : {LidrVolumes::stencil, LidrVolumes::front_faces}) {
      Settings settings = lidr_settings(LidrPacking::bitshift, 16, 255, volumes);
      settings.set(setting::volume_mesh, meshes);
      const Pairs p = pairs_of(scene, view, settings);
      ASSERT_EQ(p.pairs.lost, 0u) << "trial " << trial << " volumes " << int(volumes);
      ASSERT_EQ(p.pairs.wrong, 0u) << "trial " << trial << " volumes " << int(volumes);
    }
  }
}

}  // namespace
}  // namespace lightgrid
