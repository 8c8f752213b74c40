// A mirrored instance is the mirror image of an unmirrored one.
#include <algorithm>

#include <glm/gtc/matrix_transform.hpp>

#include "support/small_scene.h"
#include "techniques/rendering.h"
#include "techniques/tilted_normals.h"

namespace lightgrid {
namespace {

// A quad to the right and its mirror image to the left, lit from straight above the eye.
Scene two_quads(bool normal_map) {
  Scene scene;
  add_tilted_material(scene, normal_map);
  const int quad = add_mesh(scene, wall_mesh({1.2f, 0, -4}, 0.9f, 0, "quad"));
  add_instance(scene, "quad", quad);
  add_instance(scene, "mirrored", quad, glm::scale(glm::dmat4(1), glm::dvec3(-1, 1, 1)));
  Light light;
  light.type = LightType::directional;
  light.direction = glm::normalize(glm::vec3(0, -1, -1));
  scene.lights.push_back(light);
  return scene;
}

double asymmetry(const Image& image) {
  double largest = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      largest = std::max(largest, double(std::abs(image.at(x, y).g - image.at(image.width - 1 - x, y).g)));
    }
  }
  return largest;
}

TEST(Mirrored, InstancesShowTheMirrorImageAlsoThroughANormalMap) {
  const View view = small_view(96, 64);
  const Image plain = render(two_quads(false), view, "forward_plus");
  const Image mapped = render(two_quads(true), view, "forward_plus");
  EXPECT_GT(compare_images(mapped, plain).max_rel, 0.05) << "the normal map does nothing";
  EXPECT_LT(asymmetry(plain), 1e-5);
  EXPECT_LT(asymmetry(mapped), 1e-5);
}

}  // namespace
}  // namespace lightgrid
