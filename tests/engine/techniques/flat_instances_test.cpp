// Instances that a scale of 0 flattens.
#include <glm/gtc/matrix_transform.hpp>

#include "support/small_scene.h"
#include "techniques/rendering.h"
#include "techniques/tilted_normals.h"

namespace lightgrid {
namespace {

glm::dmat4 scaled(const glm::dvec3& scale) { return glm::scale(glm::dmat4(1), scale); }

// A wall of one side, which a scale along z does not change, with a light and the eye before it.
Scene wall_under(const glm::dmat4& turned, const glm::dvec3& scale, bool normal_map) {
  Scene scene;
  add_tilted_material(scene, normal_map);
  const int wall = add_mesh(scene, wall_mesh({0, 0, 0}, 0.9f, 0, "wall"));
  add_instance(scene, "wall", wall, placed({0, 0, -3}) * turned * scaled(scale));
  add_point(scene, "lamp", {0.3f, 0.4f, -1}, {1, 1, 1}, 5, 20);
  return scene;
}

TEST(FlatInstances, ShowThePictureOfTheUnflattenedWall) {
  const View view = small_view(48, 32);
  for (const char* technique : {"visibility", "forward", "deferred"}) {
    for (const bool normal_map : {false, true}) {
      for (const double angle : {0.0, 0.2, 0.3, 0.5, -0.7}) {
        const glm::dmat4 turned = glm::rotate(glm::dmat4(1), angle, glm::dvec3(0.6, 1, 0.3));
        const Image thick = render(wall_under(turned, {1, 1, 1}, normal_map), view, technique),
                    flat = render(wall_under(turned, {1, 1, 0}, normal_map), view, technique);
        EXPECT_LT(compare_images(flat, thick).max_rel, 1e-5) << technique << normal_map << " " << angle;
      }
    }
  }
}

// The two lids of the flattened box lie in one plane.
TEST(FlatInstances, OfTwoSidesAreLitOnTheEyesSide) {
  const View view = small_view(48, 32);
  for (const glm::dvec3 scale : {glm::dvec3(2, 2, 0), glm::dvec3(-2, 2, 0)}) {
    Scene scene;
    scene.background = {0, 0, 1};
    scene.ambient = {0, 0, 0};
    const int paint = add_material(scene, "paint", {0.8f, 0.8f, 0.8f}, 0, 0.8f);
    scene.materials[size_t(paint)].double_sided = true;
    Mesh box;
    shapes::add_box(box, {-0.5f, -0.5f, -0.5f}, {0.5f, 0.5f, 0.5f});
    const int mesh = add_mesh(scene, shapes::finished(std::move(box), "box", paint));
    const glm::dmat4 turned = glm::rotate(glm::dmat4(1), 0.4, glm::dvec3(1, 1, 0));
    add_instance(scene, "box", mesh, placed({0, 0, -3}) * turned * scaled(scale));
    add_point(scene, "lamp", {0, 0, 0}, {1, 1, 1}, 5, 20);
    for (const char* technique : {"visibility", "forward"}) {
      const Image image = render(scene, view, technique);
      int covered = 0, dark = 0;
      for (const glm::vec4& p : image.pixels) {
        const bool surface = glm::vec3(p) != scene.background;
        covered += surface;
        dark += surface && !(p.g > 0);
      }
      EXPECT_GT(covered, 100) << technique;
      EXPECT_EQ(dark, 0) << technique << " of " << covered;
    }
  }
}

TEST(FlatInstances, OnALineOrAPointCoverNothing) {
  const View view = small_view(48, 32);
  Scene empty = wall_under(glm::dmat4(1), {1, 1, 1}, false);
  empty.instances.clear();
  const glm::dmat4 turned = glm::rotate(glm::dmat4(1), 0.3, glm::dvec3(1, 1, 1));
  for (const char* technique : {"visibility", "forward"}) {
    const Image background = render(empty, view, technique);
    for (const glm::dvec3 scale : {glm::dvec3(1, 0, 0), glm::dvec3(0, 0, 1), glm::dvec3(0, 0, 0)})
      EXPECT_TRUE(identical(render(wall_under(turned, scale, false), view, technique), background))
          << technique;
  }
}

}  // namespace
}  // namespace lightgrid
