#include "oracle/blend_order.h"

#include <array>
#include <cmath>

#include <gmock/gmock.h>

#include "scenes/compose.h"
#include "scenes/shapes.h"

namespace lightgrid::lab {
namespace {

// Panes of glass that fill a view of 8 x 8 pixels, and a wall behind them.
struct Panes {
  Scene scene;
  View view;
  int glass = 0, plaster = 0;

  Panes() {
    plaster = add_material(scene, "plaster", {0.5f, 0.5f, 0.5f}, 0, 1);
    glass = add_material(scene, "glass", {0.5f, 0.5f, 0.5f}, 0, 1);
    scene.materials[size_t(glass)].alpha_mode = AlphaMode::blend;
    scene.materials[size_t(glass)].base_color.a = 0.5f;
    scene.materials[size_t(glass)].double_sided = true;
    quad(plaster, {-9, -9, -6}, {18, 0, 0}, {0, 18, 0});
    view = make_view(look_at({0, 0, 0}, {0, 0, -1}), 8, 8);
  }
  int quad(int material, glm::vec3 corner, glm::vec3 right, glm::vec3 up) {
    Mesh mesh;
    shapes::add_quad(mesh, corner, right, up);
    add_instance(scene, "quad", add_mesh(scene, shapes::finished(std::move(mesh), "quad", material)));
    return int(scene.instances.size()) - 1;
  }
  int pane(float z) { return quad(glass, {-5, -5, z}, {10, 0, 0}, {0, 10, 0}); }
  uint64_t wrong(std::vector<int> drawn) { return find_blend_order(scene, view, drawn).wrong; }
};

TEST(BlendOrder, OfParallelPanesIsThatOfTheirDistances) {
  Panes p;
  const int far_pane = p.pane(-4), near_pane = p.pane(-2);
  const BlendOrder order = find_blend_order(p.scene, p.view, std::array{far_pane, near_pane});
  EXPECT_EQ(order.blended, 64u);
  EXPECT_EQ(order.several, 64u);
  EXPECT_EQ(order.wrong, 0u);
  EXPECT_EQ(p.wrong({near_pane, far_pane}), 64u);
  EXPECT_THAT(describe(order), testing::HasSubstr("64 of 64 pixels"));
}

// They cross in the middle of the view: either order is wrong on one side.
TEST(BlendOrder, OfCrossingPanesIsWrongOnOneSide) {
  Panes p;
  const int a = p.quad(p.glass, {-5, -5, -5}, {10, 0, 4}, {0, 10, 0}),
            b = p.quad(p.glass, {-5, -5, -1}, {10, 0, -4}, {0, 10, 0});
  EXPECT_EQ(p.wrong({a, b}), 32u);
  EXPECT_EQ(p.wrong({b, a}), 32u);
}

// One mesh with two panes, the near one first.
TEST(BlendOrder, OfOneMeshIsThatOfItsTriangles) {
  Panes p;
  Mesh mesh;
  shapes::add_quad(mesh, {-5, -5, -2}, {10, 0, 0}, {0, 10, 0});
  shapes::add_quad(mesh, {-5, -5, -4}, {10, 0, 0}, {0, 10, 0});
  add_instance(p.scene, "box", add_mesh(p.scene, shapes::finished(std::move(mesh), "box", p.glass)));
  EXPECT_EQ(p.wrong({int(p.scene.instances.size()) - 1}), 64u);
}

TEST(BlendOrder, CountsOnlySurfacesThatShow) {
  Panes p;
  const int near_pane = p.pane(-2), far_pane = p.pane(-4), hidden = p.pane(-8);
  EXPECT_EQ(find_blend_order(p.scene, p.view, std::array{hidden, near_pane, far_pane}).several, 64u);
  // An opaque wall between them on the left.
  p.quad(p.plaster, {-9, -9, -3}, {9, 0, 0}, {0, 18, 0});
  EXPECT_EQ(p.wrong({hidden, near_pane, far_pane}), 32u);
  p.scene.materials[size_t(p.glass)].base_color.a = 0;
  EXPECT_EQ(find_blend_order(p.scene, p.view, std::array{hidden, near_pane, far_pane}).blended, 0u);
  EXPECT_EQ(find_blend_order(p.scene, p.view, {}).blended, 0u);
}

}  // namespace
}  // namespace lightgrid::lab
