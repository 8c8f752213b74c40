#include "oracle/seen_pairs.h"

#include <gtest/gtest.h>

#include <set>

#include "oracle/lit_set.h"
#include "oracle/position.h"
#include "oracle/shadow_scenes.h"

namespace lightgrid::lab {
namespace {

constexpr int side = 20;  // two tiles across and up

// Straight down from 5 m on 10 m of the ground: a pixel is half a metre. A roof of 1 m by 10 at y 2 and x 0
// to 1 hides light 0, at (0.5, 4, 0), from x -0.5 to 1.5, 4 columns of pixels. The roof itself is not seen:
// the depth is the ground's alone. Light 1, in the same place, casts nothing; light 2 reaches nothing.
struct RoofFromAbove {
  Scene scene = scene_of(
      {ground_mesh(), mesh_of({{0, 2, -9}, {0, 2, 9}, {1, 2, 9}, {0, 2, -9}, {1, 2, 9}, {1, 2, -9}})});
  View view;
  std::vector<float> depth;
  std::vector<CastingTriangle> triangles;
  CastingLights lights;

  RoofFromAbove() {
    Camera camera = look_at({0, 5, 0}, {0, 0, 0});
    camera.fov_y_rad = 1.5707963267948966;
    view = make_view(camera, side, side);
    depth.assign(side * side, float(view.near_m / 5));
    depth[0] = 0;
    // Up in the image is -z: pixel (x, y) is at x - 9.5 and 9.5 - y halves of a metre.
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) triangles.push_back({0, x - 9.5 > 9.5 - y ? 0u : 1u});
    }
    for (int i = 0; i < 3; ++i) {
      scene.lights.push_back(light_at({0.5, 4, 0}));
      scene.lights[size_t(i)].radius_m = i == 2 ? 1.0f : 100.0f;
      scene.lights[size_t(i)].casts_shadow = i != 1;
    }
    lights.in_view = lights_in_view(scene, view);
    lights.casting = {&scene.lights[0], nullptr, &scene.lights[2]};
  }
  SeenPairs pairs(const std::vector<uint32_t>& pixels) const {
    return {Occlusion(scene), {view, depth, triangles}, lights, pixels};
  }
  // As the frame would shade: every light listed at every tile, hidden by `hidden`.
  HostShadows shadows(const std::function<bool(int x, int y, uint32_t light)>& hidden) const {
    HostShadows s{.tiles_x = 2, .tiles_y = 2};
    for (uint32_t tile = 0; tile < 4; ++tile) {
      s.cells.push_back({2 * tile, 2});
      for (const uint32_t light : {0u, 1u}) {
        s.indices.push_back(light);
        for (int word = 0; word < HostShadows::words; ++word) {
          uint32_t bits = 0;
          for (int bit = 0; bit < 32; ++bit) {
            const int block = 2 * word + bit / 16, in_tile_x = block % 4 * 4 + bit % 4,
                      in_tile_y = block / 4 * 4 + bit % 16 / 4;
            if (hidden(int(tile % 2) * 16 + in_tile_x, int(tile / 2) * 16 + in_tile_y, light))
              bits |= 1u << bit;
          }
          s.bits.push_back(bits);
        }
      }
    }
    return s;
  }
};

bool under_roof(int x) { return x >= 9 && x < 13; }

TEST(SeenPairs, HoldsTheRoofsShadow) {
  const RoofFromAbove roof;
  const SeenPairs seen = roof.pairs(covered_pixels(roof.depth));
  EXPECT_EQ(seen.pixels(), side * side - 1u);
  EXPECT_EQ(seen.pairs(), side * side - 1u) << "of light 0 alone";
  EXPECT_FALSE(seen.decided(0));
  for (uint32_t p = 1; p < side * side; ++p) {
    EXPECT_EQ(seen.at(p, 0), under_roof(int(p) % side) ? Sight::hidden : Sight::seen) << p;
    EXPECT_EQ(seen.at(p, 1), Sight::seen);
    EXPECT_FALSE(seen.has_either(p));
  }
}

// Pixels are decided in blocks, but those of a directional light one by one.
TEST(SeenPairs, OfAnyLightAreThoseOfEachPairAlone) {
  RoofFromAbove roof;
  Light sun = light_at({0, 0, 0});
  sun.type = LightType::directional;
  sun.direction = {0, -1, 0};
  roof.scene.lights.push_back(sun);
  roof.lights.in_view = lights_in_view(roof.scene, roof.view);
  roof.lights.casting = {&roof.scene.lights[0], nullptr, &roof.scene.lights[2], &roof.scene.lights[3]};
  roof.triangles[77] = {};
  const Occlusion occlusion(roof.scene);
  const std::vector<uint32_t> pixels = covered_pixels(roof.depth);
  const SeenPairs seen(occlusion, {roof.view, roof.depth, roof.triangles}, roof.lights, pixels, false);
  int hidden[4] = {};
  for (const uint32_t p : pixels) {
    for (const uint32_t light : {0u, 2u, 3u}) {
      Sight alone = Sight::either;
      if (roof.triangles[p].instance >= 0) {
        const Receiver r =
            occlusion.receiver(roof.view, int(p) % side, int(p) / side, roof.depth[p], roof.triangles[p]);
        alone = occlusion.sight(roof.scene.lights[light], r).sight;
      }
      EXPECT_EQ(seen.at(p, light), alone) << p << " " << light;
      hidden[light] += alone == Sight::hidden;
    }
  }
  EXPECT_GT(hidden[0], 2 * side);
  EXPECT_GT(hidden[3], side);
}

// Through two panes that each let 0.6 of the light through, 0.36 comes: less than half.
TEST(SeenPairs, KnowWhatBlendedTrianglesHideTogether) {
  RoofFromAbove roof;
  Material glass;
  glass.alpha_mode = AlphaMode::blend;
  glass.base_color.a = 0.4f;
  roof.scene.materials.push_back(glass);
  roof.scene.meshes[1].material = 1;
  const auto hidden_columns = [&](BlendedCasters by_blended) {
    const Occlusion occlusion(roof.scene, by_blended);
    const std::vector<uint32_t> pixels = covered_pixels(roof.depth);
    const SeenPairs seen(occlusion, {roof.view, roof.depth, roof.triangles}, roof.lights, pixels);
    std::set<int> columns;
    for (const uint32_t p : pixels) {
      if (seen.at(p, 0) == Sight::hidden) columns.insert(int(p) % side);
    }
    return columns;
  };
  const std::set<int> under = {9, 10, 11, 12}, none;
  EXPECT_EQ(hidden_columns(BlendedCasters::none), none);
  EXPECT_EQ(hidden_columns(BlendedCasters::opaque), under);
  EXPECT_EQ(hidden_columns(BlendedCasters::alpha), none) << "one pane alone";
  Instance lower = roof.scene.instances[1];
  lower.world_from_object[3].y = -0.5;  // in its shadow are the same columns
  roof.scene.instances.push_back(lower);
  EXPECT_EQ(hidden_columns(BlendedCasters::alpha), under);
}

TEST(SeenPairs, APixelWithoutATriangleIsUndecidable) {
  RoofFromAbove roof;
  roof.triangles[42] = {};
  const SeenPairs seen = roof.pairs({41, 42});
  EXPECT_EQ(seen.at(42, 0), Sight::either);
  EXPECT_TRUE(seen.has_either(42));
  EXPECT_EQ(seen.at(41, 0), Sight::seen);
  EXPECT_FALSE(seen.decided(43));
}

TEST(SeenPairs, LitPairsAreSeenOnes) {
  const RoofFromAbove roof;
  const SeenPairs seen = roof.pairs(covered_pixels(roof.depth));
  const HostShadows right =
      roof.shadows([](int x, int, uint32_t light) { return light == 0 && under_roof(x); });
  const PairShadows shadows{seen, &right};
  const LitPairs pairs =
      count_pairs(roof.view, roof.depth, roof.lights.in_view, list_every_light(2), &shadows);
  EXPECT_EQ(pairs.lit, 2u * (side * side - 1) - 4 * side);
  EXPECT_EQ(pairs.lost + pairs.wrong + pairs.leaked + pairs.acned + pairs.either, 0u);
  EXPECT_EQ(pairs.hidden, 4u * side);
  EXPECT_EQ(pairs.hidden_of_pixel[9 + 5 * side], 1u);
  EXPECT_EQ(pairs.hidden_of_pixel[8 + 5 * side], 0u);
}

TEST(SeenPairs, WhatWasStoppedIsUndecided) {
  const RoofFromAbove roof;
  int asked = 0;
  const SeenPairs none(Occlusion(roof.scene), {roof.view, roof.depth, roof.triangles}, roof.lights,
                       covered_pixels(roof.depth), true, [&] {
                         ++asked;
                         return true;
                       });
  EXPECT_EQ(asked, 4) << "all tiles are in one region, which one thread takes";
  EXPECT_FALSE(none.decided(42));
  EXPECT_EQ(none.pairs(), 0u);
}

// Light 0 in no list: only what is seen of it is lost, and nothing of it leaks.
TEST(SeenPairs, OnlySeenPairsAreLost) {
  const RoofFromAbove roof;
  const SeenPairs seen = roof.pairs(covered_pixels(roof.depth));
  const PairShadows shadows{seen};
  const LitPairs pairs =
      count_pairs(roof.view, roof.depth, roof.lights.in_view, {{}, {0}, {1}, {1}}, &shadows);
  EXPECT_EQ(pairs.lost, side * side - 1u - 4 * side);
  EXPECT_EQ(pairs.leaked, 0u);
  EXPECT_EQ(pairs.hidden, 4u * side) << "listed or not";
}

// The roof's shadow a column too far right: one column leaks, another is dark.
TEST(SeenPairs, LeakedAndAcnedPairsAreCountedByPixel) {
  const RoofFromAbove roof;
  const SeenPairs seen = roof.pairs(covered_pixels(roof.depth));
  const HostShadows moved =
      roof.shadows([](int x, int, uint32_t light) { return light == 0 && under_roof(x - 1); });
  const PairShadows shadows{seen, &moved}, none{seen};
  const LitPairs pairs =
      count_pairs(roof.view, roof.depth, roof.lights.in_view, list_every_light(2), &shadows);
  EXPECT_EQ(pairs.leaked, uint64_t(side));
  EXPECT_EQ(pairs.acned, uint64_t(side));
  EXPECT_EQ(pairs.leaked_of_pixel[9 + 5 * side], 1u);
  EXPECT_EQ(pairs.acned_of_pixel[13 + 5 * side], 1u);
  EXPECT_EQ(pairs.acned_of_pixel[12 + 5 * side], 0u);
  EXPECT_EQ(count_pairs(roof.view, roof.depth, roof.lights.in_view, list_every_light(2), &none).leaked,
            4u * side)
      << "a frame without shadows";
}

// At the other pixels a light in range counts as lit, as without shadows.
TEST(SeenPairs, CountsOfASampleAreOfItsPixels) {
  RoofFromAbove roof;
  roof.triangles[9 + side] = {};
  const SeenPairs seen = roof.pairs({9 + side, 10 + side, 11 + side});
  const PairShadows shadows{seen};
  const LitPairs pairs =
      count_pairs(roof.view, roof.depth, roof.lights.in_view, list_every_light(2), &shadows);
  EXPECT_EQ(pairs.leaked, 2u);
  EXPECT_EQ(pairs.either, 1u);
  EXPECT_EQ(pairs.lit, 2u * (side * side - 1) - 3);
}

// Lists hold light 0 alone; light 1 comes after them, as directional lights do, and a frame darkens it under
// the roof, where it is seen.
TEST(SeenPairs, DirectionalLightsAreCountedWithoutLists) {
  const RoofFromAbove roof;
  const SeenPairs seen = roof.pairs(covered_pixels(roof.depth));
  const HostShadows dark = roof.shadows([](int x, int, uint32_t) { return under_roof(x); });
  const PairShadows shadows{seen, &dark, 1};
  const LitPairs pairs =
      count_pairs(roof.view, roof.depth, {roof.lights.in_view[0]}, list_every_light(1), &shadows);
  EXPECT_EQ(pairs.leaked, 0u);
  EXPECT_EQ(pairs.acned, 4u * side);
  EXPECT_EQ(pairs.lit, side * side - 1u - 4 * side) << "as lists have them";
}

}  // namespace
}  // namespace lightgrid::lab
