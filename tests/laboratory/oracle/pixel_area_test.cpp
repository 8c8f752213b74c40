#include "oracle/pixel_area.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>
#include <set>

#include "support/small_scene.h"

namespace lightgrid::lab {
namespace {

TEST(PlacesOfArea, HaveOneInEachPartOfEveryShape) {
  for (int log_width = 0; log_width <= 8; ++log_width) {
    std::set<std::pair<int, int>> parts;
    for (int i = 0; i < places_of_area; ++i) {
      const glm::dvec2 p = place_of_area(i);
      parts.emplace(int(p.x * (1 << log_width)), int(p.y * (1 << (8 - log_width))));
    }
    EXPECT_EQ(parts.size(), 256u) << log_width;
  }
}

// Halves of a pixel by lines through its centre hold half of the places.
TEST(PlacesOfArea, MeasureHalvesWithin3In256) {
  for (int k = 0; k < 360; ++k) {
    const double turn = (k + 0.25) * std::numbers::pi / 180;
    int in = 0;
    for (int i = 0; i < places_of_area; ++i) {
      const glm::dvec2 p = place_of_area(i) - 0.5;
      in += p.x * std::cos(turn) + p.y * std::sin(turn) < 0;
    }
    EXPECT_NEAR(in, 128, 3) << k;
  }
}

// The camera sees 16 x 8 pixels of 1 x 1 at a distance of d.
struct Placed {
  Scene scene;
  View view;
  double pixel_m;  // at distance 4
};

Placed with_quad(glm::vec2 corner_px, glm::vec2 size_px, float z = -4) {
  Placed p;
  p.view = small_view(16, 8);
  p.pixel_m = 4 * 2 / p.view.clip_from_view[1][1] / 8;
  p.scene.background = {0, 0, 1};
  const int material = add_material(p.scene, "light", {1, 0.5f, 0.25f}, 0, 1);
  p.scene.materials[size_t(material)].unlit = true;
  const float px = float(p.pixel_m);
  Mesh mesh;
  shapes::add_quad(mesh, {(corner_px.x - 8) * px, (corner_px.y - 4) * px, z}, {size_px.x * px, 0, 0},
                   {0, size_px.y * px, 0}, 1, 1);
  add_instance(p.scene, "quad", add_mesh(p.scene, shapes::finished(std::move(mesh), "quad", material)));
  return p;
}

std::vector<PixelArea> areas_of(const Placed& p, const Occlusion* occlusion = nullptr) {
  std::vector<uint32_t> all(p.view.grid().values());
  std::iota(all.begin(), all.end(), 0u);
  return AreaOracle(p.scene, p.view, {}, {.ambient = p.scene.ambient}, occlusion).at(all);
}

TEST(AreaOracle, IsTheShareOfEachPixelThatAQuadCovers) {
  const glm::vec2 corner(3.3f, 2.6f), size(5.25f, 2.9f);
  const Placed p = with_quad(corner, size);
  const std::vector<PixelArea> areas = areas_of(p);
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 16; ++x) {
      const auto covered = [](double low, double high, int at) {
        return std::clamp(std::min(high, at + 1.0) - std::max(low, double(at)), 0.0, 1.0);
      };
      const double share = covered(corner.x, corner.x + size.x, x) * covered(corner.y, corner.y + size.y, y);
      const PixelArea& a = areas[size_t(y * 16 + x)];
      EXPECT_NEAR(a.radiance.r, share, 2.0 / 256) << x << ' ' << y;
      EXPECT_NEAR(a.radiance.g, 0.5 * share, 1.0 / 256) << x << ' ' << y;
      EXPECT_NEAR(a.radiance.b, 0.25 * share + 1 - share, 2.0 / 256) << x << ' ' << y;
      EXPECT_EQ(a.at_edge, share > 0 && share < 1) << x << ' ' << y;
    }
  }
}

// The quad's diagonal is no edge, a second quad in the same plane is one, and a blended one is left out.
TEST(AreaOracle, TellsEdgesAndBlendedSurfaces) {
  Placed p = with_quad({0, 0}, {16, 8});
  for (const PixelArea& a : areas_of(p)) EXPECT_FALSE(a.at_edge);
  const Placed other = with_quad({8.5f, 0}, {3, 8}, -3.99f);
  add_instance(p.scene, "other", add_mesh(p.scene, Mesh(other.scene.meshes[0])));
  std::vector<PixelArea> areas = areas_of(p);
  EXPECT_TRUE(areas[3 * 16 + 8].at_edge);
  EXPECT_FALSE(areas[3 * 16 + 10].at_edge);
  p.scene.materials.push_back(p.scene.materials[0]);
  p.scene.materials[1].alpha_mode = AlphaMode::blend;
  p.scene.meshes[1].material = 1;
  areas = areas_of(p);
  EXPECT_TRUE(areas[3 * 16 + 8].blended);
  EXPECT_TRUE(areas[3 * 16 + 10].blended);
  EXPECT_FALSE(areas[3 * 16 + 7].blended);
}

// Unlit panes of one colour before the picture of with_quad.
void add_pane(Placed& p, float z, const glm::vec3& color, float alpha) {
  const Placed pane = with_quad({-4, -4}, {24, 16}, z);
  Material material = pane.scene.materials[0];
  material.base_color = glm::vec4(color, alpha);
  material.alpha_mode = AlphaMode::blend;
  Mesh mesh = pane.scene.meshes[0];
  mesh.material = int(p.scene.materials.size());
  p.scene.materials.push_back(material);
  add_instance(p.scene, "pane", add_mesh(p.scene, std::move(mesh)));
}

// The nearer pane is the first instance; one behind the quad shows only beside it.
TEST(AreaOracle, LaysBlendedSurfacesOverOthersByDepth) {
  Placed p = with_quad({4, 0}, {8, 8});
  add_pane(p, -3, {0, 1, 0}, 0.25f);
  add_pane(p, -3.5f, {1, 1, 1}, 0.5f);
  add_pane(p, -5, {0, 0, 0}, 0.75f);
  const std::vector<PixelArea> areas = areas_of(p);
  const auto expect = [&](int x, const glm::dvec3& under) {
    const glm::dvec3 far = 0.5 * under + 0.5, all = 0.75 * far + 0.25 * glm::dvec3(0, 1, 0);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(areas[size_t(3 * 16 + x)].radiance[c], all[c], 1e-7) << x;
  };
  expect(7, {1, 0.5, 0.25});
  expect(1, {0, 0, 0.25});
}

TEST(AreaOracle, HasTheSpreadOfItsPlaces) {
  const Placed p = with_quad({0, 0}, {5.25f, 8});
  const PixelArea edge = areas_of(p)[3 * 16 + 5], inside = areas_of(p)[3 * 16 + 2];
  EXPECT_NEAR(edge.spread.r, std::sqrt(0.25 * 0.75 / 256), 1e-6);
  EXPECT_EQ(inside.spread, glm::dvec3(0));
}

TEST(AreaOracle, CountsSurfacesAtSomePlaces) {
  Placed p = with_quad({2.5f, 0}, {6, 8});
  const Placed other = with_quad({5, 0.5f}, {3, 8}, -3.99f);
  add_instance(p.scene, "other", add_mesh(p.scene, Mesh(other.scene.meshes[0])));
  const AreaOracle oracle(p.scene, p.view, {}, {}, nullptr);
  for (const int places : {2, 4, 8, 16}) {
    const uint32_t pixels[] = {2 * 16, 2 * 16 + 2, 2 * 16 + 3, 5, 2 * 16 + 6};
    const std::vector<SeenSurfaces> seen = oracle.surfaces_at(pixels, places);
    EXPECT_EQ(seen[0].surfaces, 0);
    EXPECT_FALSE(seen[0].at_edge());
    EXPECT_EQ(seen[1].surfaces, 1);
    EXPECT_EQ(seen[1].covered, places / 2);
    EXPECT_TRUE(seen[1].at_edge()) << "the background";
    EXPECT_EQ(seen[2].covered, places);
    EXPECT_FALSE(seen[2].at_edge());
    EXPECT_EQ(seen[3].surfaces, 2);
    EXPECT_EQ(seen[3].covered, places);
    EXPECT_TRUE(seen[3].at_edge());
    EXPECT_FALSE(seen[4].at_edge()) << "the nearer alone";
  }
}

// A sun from the eye's direction, and a caster whose shadow on the wall ends within a pixel, at x.
Placed shadowed_wall(float x) {
  Placed p = with_quad({0, 0}, {16, 8});
  p.scene.materials[0].unlit = false;
  p.scene.materials[0].base_color = {1, 1, 1, 1};
  p.scene.ambient = {0, 0, 0};
  // Behind the eye, in the sun's way: parallel light, so its shadow has its size.
  Placed caster = with_quad({-8, -8}, {8 + x, 40}, 1);
  add_instance(p.scene, "caster", add_mesh(p.scene, Mesh(caster.scene.meshes[0])));
  p.scene.materials[0].double_sided = true;
  Light& sun = p.scene.lights.emplace_back();
  sun.type = LightType::directional;
  sun.direction = {0, 0, -1};
  sun.intensity = 3;
  sun.casts_shadow = true;
  return p;
}

TEST(AreaOracle, HasTheShareOfAPixelInShadow) {
  const Placed p = shadowed_wall(5.375f);
  const Occlusion occlusion(p.scene);
  const std::vector<PixelArea> areas = areas_of(p, &occlusion), lit = areas_of(p);
  for (int y = 0; y < 8; ++y) {
    const auto at = [&](int x) { return areas[size_t(y * 16 + x)].radiance.g; };
    const auto unshadowed = [&](int x) { return lit[size_t(y * 16 + x)].radiance.g; };
    EXPECT_EQ(at(4), 0);
    EXPECT_NEAR(at(5) / unshadowed(5), 1 - 0.375, 2.0 / 256);
    EXPECT_EQ(at(6), unshadowed(6));
    EXPECT_GT(at(6), 0.1);
  }
}

// The only place of a pixel lies where the shadow ends.
TEST(AreaOracle, DoubtsALightAtTheEdgeOfAShadow) {
  const Placed p = shadowed_wall(5 + 128.5f / 256);
  const Occlusion occlusion(p.scene);
  const AreaOracle oracle(p.scene, p.view, {}, {}, &occlusion);
  const uint32_t pixels[] = {3 * 16 + 5, 3 * 16 + 6};
  const std::vector<PixelArea> areas = oracle.at(pixels, 1);
  EXPECT_GT(areas[0].doubt.g, 0.1);
  EXPECT_EQ(areas[0].doubt, areas[0].radiance);
  EXPECT_EQ(areas[1].doubt, glm::dvec3(0));
}

}  // namespace
}  // namespace lightgrid::lab
