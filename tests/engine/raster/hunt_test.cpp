// Random scenes and cameras against the coverage oracle. LIGHTGRID_RASTER_HUNT=N takes N scenes instead of a
// few.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "raster/drawn.h"

namespace lightgrid {
namespace {

glm::dvec3 random_direction(RandomNumbers& random) {
  for (;;) {
    const glm::dvec3 v(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
    if (const double length = glm::length(v); length > 0.1 && length < 1) return v / length;
  }
}

double log_between(RandomNumbers& random, double low, double high) {
  return std::exp(random.between(std::log(low), std::log(high)));
}

glm::dmat3 random_turn(RandomNumbers& random) {
  const glm::dvec3 back = random_direction(random);
  const glm::dvec3 right =
      glm::normalize(glm::cross(std::abs(back.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0), back));
  return glm::transpose(glm::dmat3(right, glm::cross(back, right), back));
}

// Perspective, finite or not, or orthographic; off-centre.
RasterCamera random_view(RandomNumbers& random) {
  RasterCamera view;
  view.grid.width = 1 + random.below(130);
  view.grid.height = 1 + random.below(130);
  view.view_from_world = glm::dmat4(random_turn(random));
  view.eye = random_direction(random) * log_between(random, 0.01, 1e6);
  glm::dmat4& m = view.clip_from_view = glm::dmat4(0);
  const double scale = log_between(random, 0.05, 20), near = log_between(random, 1e-3, 10),
               far = near * log_between(random, 2, 1e5);
  m[0][0] = scale;
  m[1][1] = scale * view.grid.width / view.grid.height;
  if (random.below(4) == 0) {
    m[2][2] = 1 / (far - near);
    m[3][2] = far / (far - near);
    m[3][3] = 1;
    m[3][0] = random.between(-1, 1);
    return view;
  }
  m[2][3] = -1;
  m[3][2] = near;
  m[2][0] = random.between(-0.5, 0.5);
  m[2][1] = random.between(-0.5, 0.5);
  if (random.below(2) == 0) {
    m[2][2] = near / (far - near);
    m[3][2] = far * near / (far - near);
  }
  return view;
}

// Triangles around the eye and before it, of every size and shape, some with corners in common.
TriangleScene random_scene(RandomNumbers& random) {
  TriangleScene scene;
  scene.camera = random_view(random);
  const double size = log_between(random, 0.1, 1000);
  scene.meshes.resize(1 + size_t(random.below(2)));
  for (TriangleScene::MeshData& mesh : scene.meshes) {
    const int vertices = 3 + random.below(120), triangles = 1 + random.below(150), kind = random.below(4);
    for (int i = 0; i < vertices; ++i) {
      glm::vec3 p(random.between(-1, 1) * size, random.between(-1, 1) * size, random.between(-1, 1) * size);
      if (kind == 1)
        p = glm::vec3(std::round(random.between(-4, 4)), std::round(random.between(-4, 4)),
                      std::round(random.between(-4, 4)));
      if (kind == 2) p = p * float(log_between(random, 1e-3, 1));
      mesh.positions.push_back(p);
    }
    for (int i = 0; i < 3 * triangles; ++i) {
      // Kind 3 takes neighbours, as strips do.
      const int at = kind == 3 ? std::min(i / 3 + i % 3, vertices - 1) : random.below(vertices);
      mesh.indices.push_back(uint32_t(at));
    }
  }
  const int instances = 1 + random.below(3);
  for (int i = 0; i < instances; ++i) {
    RasterInstance instance{.mesh = random.below(int(scene.meshes.size())),
                            .two_sided = random.below(2) == 0};
    const glm::dmat3 turn = random_turn(random);
    for (int c = 0; c < 3; ++c) {
      instance.world_from_object[c] =
          glm::dvec4(turn[c] * log_between(random, 0.3, 3) * (random.below(4) ? 1.0 : -1.0), 0);
    }
    instance.world_from_object[3] =
        glm::dvec4(random_direction(random) * size * random.between(0, 1.5) + scene.camera.eye, 1);
    scene.instances.push_back(instance);
  }
  return scene;
}

size_t scenes_to_draw() {
  const char* wanted = std::getenv("LIGHTGRID_RASTER_HUNT");
  return wanted ? std::strtoull(wanted, nullptr, 10) : 400;
}

TEST(RasterHunt, FindsNoWrongPixel) {
  RandomNumbers random(20261122);
  size_t triangles = 0, pixels = 0, covered = 0, invalid = 0;
  Rasterizer shapes[] = {
      Rasterizer(raster_device(), raster_programs(), {.shape = KernelShape::lanes, .cluster_cones = false}),
      Rasterizer(raster_device(), raster_programs(), {.shape = KernelShape::group, .cluster_cones = false})};
  const size_t count = scenes_to_draw();
  for (size_t i = 0; i < count; ++i) {
    TriangleScene scene = random_scene(random);
    scene.camera.grid.samples = i % 8 < 6 ? 1 : 4;
    if (i % 3 == 0) scene.instances.push_back(scene.instances[0]);  // at equal depths the last is shown
    Rasterizer& rasterizer = shapes[i % 2];
    set_scene(rasterizer, scene);
    const Drawn result = drawn_by(rasterizer, scene);
    if (scene.camera.grid.samples == 1) {
      ASSERT_EQ(count_wrong(result, oracle_of(result, scene)), 0) << "scene " << i;
    }
    for (int s = 0; s < scene.camera.grid.samples && scene.camera.grid.samples > 1; ++s) {
      const Drawn one = sample_of(result, s);
      ASSERT_EQ(count_wrong(one, oracle_of(one, scene, standard_locations[s])), 0)
          << "scene " << i << ", sample " << s;
    }
    triangles += result.counts.triangles;
    pixels += result.triangles.size();
    covered += result.covered();
    invalid += result.counts.invalid_triangles;
  }
  EXPECT_GT(covered, pixels / 10);
  EXPECT_EQ(invalid, 0u);
  fmt::print("{} scenes, {} triangles, {} pixels and samples, {} of them covered\n", count, triangles, pixels,
             covered);
}

}  // namespace
}  // namespace lightgrid
