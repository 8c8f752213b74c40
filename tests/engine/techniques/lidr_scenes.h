// Scenes for lidr, and the required result at a pixel with a free slot for each of its lights.
#pragma once

#include <algorithm>
#include <cmath>

#include "passes/light_index/lidr_settings.h"
#include "support/small_scene.h"
#include "techniques/rendering.h"

namespace lightgrid {

inline Settings lidr_settings(LidrPacking packing, int overlap = 0, int lights = 0,
                              LidrVolumes volumes = LidrVolumes::stencil) {
  return {{setting::lidr_packing, packing},
          {setting::lidr_overlap, overlap},
          {setting::lidr_lights, lights},
          {setting::lidr_volumes, volumes}};
}

// Clusters of lights on the wall, `overlap` each, which neither touch nor cover each other on screen;
// `lights` in all.
inline Scene clustered_lights(int overlap, int lights) {
  SmallScene s = small_scene(false);
  s.scene.instances.resize(1);  // without the ball
  for (int i = 0; i < lights; ++i) {
    const int cluster = i / overlap, within = i % overlap;
    const glm::dvec3 center(-1.6 + 0.25 * (cluster % 14), -1.6 + 0.25 * (cluster / 14), -3.97);
    add_point(s.scene, "lamp", center + 0.01 * glm::dvec3(std::cos(within), std::sin(within), 0),
              {1, 0.5f + 0.02f * within, 0.4f}, 0.05f, 0.08f);
  }
  return s.scene;
}

struct Pairs {
  LitPairs pairs;
  uint32_t max_listed = 0, max_lit = 0;
  Image image;
};

inline Pairs pairs_of(const Scene& scene, const View& view, const Settings& settings) {
  TechniqueRun run(test_devices(), scene, view, settings, find_technique("lidr"));
  run.run_frame();
  Pairs out{count_listed_pairs(run, read_depth(run)), 0, 0, run.image()};
  for (uint32_t n : out.pairs.listed_of_pixel) out.max_listed = std::max(out.max_listed, n);
  for (uint32_t n : out.pairs.lit_of_pixel) out.max_lit = std::max(out.max_lit, n);
  return out;
}

// Sums are in a different order from forward's; each has the rounding of a few lights.
inline constexpr double other_order = 1e-5;

inline void expect_within_limit(const Scene& scene, const View& view, const Settings& settings,
                                uint32_t limit, const Image& forward) {
  const Pairs p = pairs_of(scene, view, settings);
  EXPECT_LE(p.max_lit, limit) << "the scene is no test of this row";
  EXPECT_LE(p.max_listed, limit);
  EXPECT_EQ(p.pairs.lost, 0u);
  EXPECT_EQ(p.pairs.wrong, 0u);
  EXPECT_LT(compare_images(p.image, forward).max_rel, other_order);
  EXPECT_EQ(count_nan_pixels(p.image), 0u);
}

// Few enough lights everywhere: around the eye, past near and far, behind, grazing, tangent, over the whole
// screen.
inline Scene awkward_lights() {
  SmallScene s = small_scene();
  effect("blend").add(s);
  effect("spot").add(s);
  add_point(s.scene, "at the eye", {0, 0, 0}, {1, 1, 1}, 3, 3.5f);
  add_point(s.scene, "at the near plane", {0.02, 0, -0.1}, {1, 1, 1}, 1, 4.5f);
  add_point(s.scene, "behind", {0, 0, 1}, {1, 1, 1}, 5, 0.9f);
  add_point(s.scene, "behind, reaching", {0.5, 0.2, 1}, {0.5f, 1, 1}, 9, 5.5f);
  add_point(s.scene, "tangent", {0.2, 0.3, -5}, {1, 1, 1}, 9, 1.0f);
  add_point(s.scene, "grazing", {-1, 0.3, -5}, {1, 1, 1}, 9, 1.02f);
  add_point(s.scene, "everything", {0, 2, -2}, {0.3f, 0.3f, 1}, 1, std::numeric_limits<float>::infinity());
  add_spot(s.scene, "wide", {1, 1, -2}, {0, 0, -4}, {1, 1, 1}, 5, 6, 20, 80);
  add_spot(s.scene, "flood", {-1, 1, -2}, {0, 0, -4}, {1, 1, 1}, 2, 3, 60, 120);
  return s.scene;
}

}  // namespace lightgrid
