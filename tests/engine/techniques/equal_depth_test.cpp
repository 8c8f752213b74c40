// Several surfaces with exactly the same depth at a pixel: every technique shows the same one as forward, lit
// once.
#include <glm/gtc/matrix_transform.hpp>

#include "support/small_scene.h"
#include "techniques/rendering.h"

namespace lightgrid {
namespace {

// A square of 2 * side^2 triangles at z = -4; large ones are cut into several clusters.
void add_sheet(Mesh& mesh, glm::vec3 low, float size, int side, const glm::vec4& color) {
  const uint32_t base = uint32_t(mesh.positions.size());
  for (int y = 0; y <= side; ++y) {
    for (int x = 0; x <= side; ++x) {
      mesh.positions.push_back(low +
                               glm::vec3(size * float(x) / float(side), size * float(y) / float(side), 0));
      mesh.normals.emplace_back(0, 0, 1);
      // Half of a masked sheet's corners are above its cutoff.
      mesh.colors.emplace_back(glm::vec3(color), (x + y) % 2 ? color.a : 1);
    }
  }
  const uint32_t row = uint32_t(side) + 1;
  for (uint32_t y = 0; y + 1 < row; ++y) {
    for (uint32_t x = 0; x + 1 < row; ++x) {
      const uint32_t a = base + y * row + x;
      for (const uint32_t corner : {a, a + 1, a + row + 1, a, a + row + 1, a + row})
        mesh.indices.push_back(corner);
    }
  }
}

constexpr glm::vec4 colors[] = {
    {0.9f, 0.1f, 0.1f, 1}, {0.1f, 0.9f, 0.1f, 1}, {0.1f, 0.1f, 0.9f, 1}, {0.8f, 0.8f, 0.1f, 1}};

// Nineteen lamps in front of the wall: three draws of forward_zprepass, and both parities of
// forward_multipass.
Scene lamps_alone(int lamps = 19) {
  Scene scene = small_scene(false).scene;
  scene.instances.clear();
  scene.meshes.clear();
  for (int i = 0; i < lamps; ++i) {
    add_point(scene, "lamp", {-1.7f + 0.2f * float(i), 0.3f * float(i % 5) - 0.6f, -3.4f}, {1, 0.9f, 0.8f}, 1,
              2.5f);
  }
  return scene;
}

// `sheets` coincident squares, in one mesh or in one mesh each with its own material.
struct Stack {
  int sheets, side;
  bool one_mesh, masked;
  glm::dmat4 world_from_object{1};
};

Scene stacked(const Stack& stack, int lamps = 19) {
  Scene scene = lamps_alone(lamps);
  Mesh mesh;
  for (int i = 0; i < stack.sheets; ++i) {
    glm::vec4 color = colors[i];
    // Later masked sheets have the larger holes, so that each is visible somewhere.
    if (stack.masked) color.a = 0.8f - 0.25f * float(i);
    add_sheet(mesh, {-1.2f, -1.1f, -4}, 2.3f, stack.side, color);
    if (stack.one_mesh && i + 1 < stack.sheets) continue;
    const int material = add_material(scene, "paint", {1, 1, 1}, 0.2f * float(i), 0.3f);
    if (stack.masked) scene.materials[size_t(material)].alpha_mode = AlphaMode::mask;
    const int index = add_mesh(scene, shapes::finished(std::move(mesh), "sheets", material));
    add_instance(scene, "sheets", index, stack.world_from_object);
    mesh = Mesh();
  }
  return scene;
}

bool in_one_sum(const std::string& technique) {
  return technique == "forward" || technique == "forward_plus" || technique == "clustered";
}

void expect_each_as_forward(const Scene& scene, const View& view) {
  const Image forward = render(scene, view, "forward");
  for (const Technique* technique : techniques()) {
    if (technique->name == std::string("lidr"))
      continue;  // holds fewer lights a pixel than there are here: below
    if (technique->approximate) continue;
    SCOPED_TRACE(technique->name);
    const Image image = render(scene, view, technique->name);
    if (own_surfaces(*technique, {})) {
      expect_near(image, forward);
    } else if (in_one_sum(technique->name)) {
      EXPECT_TRUE(identical(image, forward));
    } else {
      EXPECT_LT(compare_images(image, forward).max_rel, 2e-6);
    }
    for (const glm::vec4& pixel : image.pixels) ASSERT_EQ(pixel.a, 1);
  }
}

// The visible sheet is the one whose own scene gives the same pixel.
double share_alike(const Image& a, const Image& b) {
  size_t alike = 0;
  for (size_t i = 0; i < a.pixels.size(); ++i) alike += glm::length(a.pixels[i] - b.pixels[i]) < 1e-6f;
  return double(alike) / double(a.pixels.size());
}

struct EqualDepth : testing::TestWithParam<Stack> {};

TEST_P(EqualDepth, ShowsTheSurfaceThatForwardShowsLitOnce) {
  expect_each_as_forward(stacked(GetParam()), small_view(127, 73));
}

TEST_P(EqualDepth, WithFewerLightsThanADrawTakes) {
  for (const int lamps : {0, 1, 2, 9}) {
    SCOPED_TRACE(lamps);
    const Scene scene = stacked(GetParam(), lamps);
    const View view = small_view(33, 19);
    const Image forward = render(scene, view, "forward");
    for (const char* technique : {"forward_multipass", "forward_zprepass", "lidr"}) {
      if (technique == std::string("lidr") && lamps > 2) continue;
      SCOPED_TRACE(technique);
      EXPECT_LT(compare_images(render(scene, view, technique), forward).max_rel, 2e-6);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Stacks, EqualDepth,
    testing::Values(Stack{2, 1, true, false}, Stack{3, 4, true, false}, Stack{4, 4, true, false},
                    Stack{2, 12, true, false}, Stack{4, 12, true, true}, Stack{3, 3, true, true},
                    Stack{2, 2, false, false}, Stack{4, 12, false, false}, Stack{3, 5, false, true}),
    [](const auto& info) {
      const Stack& s = info.param;
      return fmt::format("{}{}Of{}Triangles{}", s.sheets, s.one_mesh ? "InOneMesh" : "InMeshesOfTheirOwn",
                         2 * s.side * s.side, s.masked ? "Masked" : "");
    });

// The rule itself, by scenes of one sheet: of opaque sheets in small meshes the last one is visible.
TEST(EqualDepth, TheLastOneDrawnIsSeen) {
  const Stack three{3, 1, true, false};
  const View view = small_view(63, 37);
  Scene last = lamps_alone();
  Mesh mesh;
  add_sheet(mesh, {-1.2f, -1.1f, -4}, 2.3f, 1, colors[2]);
  const int material = add_material(last, "paint", {1, 1, 1}, 0.4f, 0.3f);
  add_instance(last, "sheets", add_mesh(last, shapes::finished(std::move(mesh), "sheets", material)));
  EXPECT_EQ(share_alike(render(stacked(three), view, "forward"), render(last, view, "forward")), 1);
}

// A small square in the plane of a large one of other triangles: both have the same depth wherever the plane
// faces the eye. The later one in the scene is seen, at every distance.
TEST(EqualDepth, TheLaterInstanceIsSeenAtEveryDistance) {
  for (const float distance : {0.4f, 0.9f, 1.7f, 3.1f, 6.5f, 12.7f, 25.0f}) {
    for (const bool large_last : {false, true}) {
      SCOPED_TRACE(fmt::format("{} m, {}", distance, large_last));
      Scene scene = lamps_alone();
      for (Light& lamp : scene.lights) {
        lamp.position.z = 0.5 - double(distance);
        lamp.radius_m = 40;
      }
      const auto add = [&](bool large) {
        Mesh mesh;
        const float half = distance * (large ? 0.9f : 0.31f);
        add_sheet(mesh, {-half + 0.1f * distance, -half, -distance}, 2 * half, large ? 17 : 3, colors[large]);
        const int material = add_material(scene, "paint", {1, 1, 1}, 0, 0.9f);
        add_instance(scene, "sheet", add_mesh(scene, shapes::finished(std::move(mesh), "sheet", material)));
      };
      add(!large_last);
      add(large_last);
      Mesh back;  // which the layers of distance depend on
      add_sheet(back, {-20, -20, -40}, 40, 3, colors[2]);
      const int material = add_material(scene, "paint", {1, 1, 1}, 0, 0.9f);
      add_instance(scene, "back", add_mesh(scene, shapes::finished(std::move(back), "back", material)));
      const View view = small_view(63, 37);
      const Image forward = render(scene, view, "forward");
      const glm::vec4 middle = forward.pixels[size_t(18) * 63 + 31];
      EXPECT_GT(large_last ? middle.g : middle.r, 2 * (large_last ? middle.r : middle.g));
      expect_each_as_forward(scene, view);
    }
  }
}

// Two walls that cross: depths are equal at some pixels of the line, by accident of rounding.
TEST(EqualDepth, WhereSurfacesCross) {
  Scene scene = lamps_alone();
  Mesh mesh;
  add_sheet(mesh, {-1.2f, -1.1f, -4}, 2.3f, 1, colors[0]);
  const int material = add_material(scene, "paint", {1, 1, 1}, 0, 0.3f);
  for (const float tilt : {1e-4f, -1e-4f, 1e-5f}) {  // nearly coplanar, so that many pixels are near the line
    const size_t first = mesh.positions.size();
    add_sheet(mesh, {-1.2f, -1.1f, -4}, 2.3f, 1, colors[1]);
    for (size_t i = first; i < mesh.positions.size(); ++i) mesh.positions[i].z += tilt * mesh.positions[i].x;
  }
  add_instance(scene, "walls", add_mesh(scene, shapes::finished(std::move(mesh), "walls", material)));
  expect_each_as_forward(scene, small_view(319, 181));
}

// Turned and mirrored, so that depths come from slanted planes and the winding is reversed.
TEST(EqualDepth, TurnedAndMirrored) {
  glm::dmat4 matrix = glm::translate(glm::dmat4(1), {0, 0, -4});
  matrix = glm::rotate(matrix, 0.7, {0.3, 1, 0.2});
  matrix = glm::scale(matrix, {-1, 1, 1});
  matrix = glm::translate(matrix, {0, 0, 4});
  Scene scene = stacked({4, 7, true, false, matrix});
  for (Material& material : scene.materials) material.double_sided = true;
  expect_each_as_forward(scene, small_view(127, 73));
}

}  // namespace
}  // namespace lightgrid
