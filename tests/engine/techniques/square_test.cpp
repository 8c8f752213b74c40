// The square: 2.8 million triangles by instances, too many for the tests that draw every built-in scene.
#include <set>

#include "plan/settings/grid.h"
#include "techniques/rendering.h"

namespace lightgrid {
namespace {

TEST(Square, HasItsTrianglesInInstancesOfFewMeshes) {
  const Scene scene = make_square();
  size_t drawn = 0, stored = 0, masked = 0, lights = 0;
  for (const Instance& i : scene.instances) {
    const Mesh& mesh = scene.meshes[i.mesh];
    drawn += mesh.indices.size() / 3;
    if (scene.materials[mesh.material].alpha_mode == AlphaMode::mask) masked += mesh.indices.size() / 3;
  }
  for (const Mesh& mesh : scene.meshes) stored += mesh.indices.size() / 3;
  for (const Light& light : scene.lights) lights += !is_directional(light);
  EXPECT_GE(drawn, 2'750'000u);
  EXPECT_LE(drawn, 2'850'000u);
  EXPECT_LT(stored, drawn / 10);
  EXPECT_GT(masked, drawn / 3);  // foliage
  EXPECT_EQ(lights, 300u);
  EXPECT_EQ(scene.lights.size(), 300u);
}

// Where everything stands, in one number: weights make a permutation or a shift show.
TEST(Square, IsTheSameOnEveryMachine) {
  const Scene scene = make_square();
  double sum = 0;
  for (size_t k = 0; k < scene.instances.size(); ++k) {
    const Instance& i = scene.instances[k];
    const Mesh& mesh = scene.meshes[i.mesh];
    glm::dvec3 corner(0);
    for (size_t v = 0; v < mesh.positions.size(); ++v)
      corner += glm::dvec3(mesh.positions[v]) * double(v % 13 + 1);
    const glm::dvec3 p(i.world_from_object * glm::dvec4(corner / double(mesh.positions.size()), 1));
    sum += double(k % 97 + 1) * (p.x + 2 * p.y + 3 * p.z);
  }
  for (size_t k = 0; k < scene.lights.size(); ++k) {
    const glm::dvec3 p = scene.lights[k].position;
    sum += double(k % 31 + 1) * (p.x + 2 * p.y + 3 * p.z);
  }
  EXPECT_NEAR(sum, 9826223.397, 0.05);
}

TEST(Square, LosesNoLightAndShowsForwardsPicture) {
  const Scene scene = make_square();
  const View view = default_view(scene, 160, 90);
  const Image forward = render(scene, view, "forward");
  for (const char* name : {"forward_plus", "clustered"}) expect_exact(scene, view, {}, forward, name);
  TechniqueRun run(test_devices(), scene, view, {}, find_technique("visibility"));
  run.run_frame();
  const LitPairs pairs = count_listed_pairs(run, read_depth(run));
  EXPECT_EQ(pairs.lost, 0u);
  EXPECT_EQ(pairs.wrong, 0u);
  EXPECT_GT(pairs.lit, 2 * 160 * 90u);
  EXPECT_TRUE(
      identical(run.image(), render(scene, view, "visibility", {{setting::lights, ShadedLights::all}})));
}

}  // namespace
}  // namespace lightgrid
