// A small scene in which most lights cast, and what a run's shadows are according to the oracle.
#pragma once

#include "accuracy/shadow_truth.h"
#include "accuracy/surfaces_in_double.h"
#include "plan/settings/surfaces.h"
#include "support/small_scene.h"
#include "techniques/rendering.h"

namespace lightgrid {
using namespace lab;

// Between the lamps and the wall: a ball, a masked fence, a sliver, a flag that its matrix mirrors, and the
// surface around a lamp, which hides no light. Glass casts nothing; one lamp and the sun cast
// nothing that is found.
inline Scene shadowed_scene() {
  SmallScene s = small_scene();
  Scene& scene = s.scene;
  scene.materials[size_t(s.ball_material)].metallic = 0;
  scene.materials[size_t(s.ball_material)].roughness = 0.8f;
  for (Light& light : scene.lights) {
    light.radius_m = 4;
    light.casts_shadow = true;
    light.position.z += 0.9;
    light.position.y *= 0.6;
  }
  scene.lights[1].casts_shadow = false;
  add_spot(scene, "torch", {0, 0, -1}, {-0.5f, 0, -4}, {1, 1, 1}, 9, 5, 10, 25).casts_shadow = true;
  effect("directional").add(s);
  scene.lights.back().casts_shadow = true;
  const int wire = add_material(scene, "wire", {0.8f, 0.8f, 0.8f}, 0, 0.9f);
  scene.materials[size_t(wire)].base_color_map.texture = add_speckles(scene, true);
  scene.materials[size_t(wire)].alpha_mode = AlphaMode::mask;
  scene.materials[size_t(wire)].double_sided = scene.materials[size_t(s.wall_material)].double_sided = true;
  const int glass = add_material(scene, "glass", {0.5f, 0.8f, 0.9f}, 0, 0.1f);
  scene.materials[size_t(glass)].base_color.a = 0.4f;
  scene.materials[size_t(glass)].alpha_mode = AlphaMode::blend;
  add_instance(scene, "fence", add_mesh(scene, wall_mesh({-0.9f, 0.3f, -3.4f}, 0.5f, wire, "fence")));
  Mesh flag = wall_mesh({0, 0, 0}, 0.3f, s.wall_material, "flag");
  flag.indices.resize(flag.indices.size() - 3);
  const int flag_mesh = add_mesh(scene, std::move(flag));
  add_instance(scene, "flag", flag_mesh,
               placed({1.3, 0.6, -3.2}, 40) * glm::scale(glm::dmat4(1), glm::dvec3(-1, 1, 1)));
  add_instance(scene, "sliver", flag_mesh,
               placed({-0.2, 0.9, -3.6}, -20) * glm::scale(glm::dmat4(1), glm::dvec3(2, 0.01, 1)));
  add_lamp(scene, "bulb", s.ball, placed(scene.lights[0].position, 0, 0.15));
  // Seen from behind, where they are not drawn: 2 mm before the wall one hides light, half a millimetre
  // before it one does not.
  Mesh card = wall_mesh({0, 0, -4}, 0.25f, add_material(scene, "card", {1, 1, 1}, 0, 1), "card");
  for (size_t i = 0; i < card.indices.size(); i += 3) std::swap(card.indices[i], card.indices[i + 1]);
  const int card_mesh = add_mesh(scene, std::move(card));
  add_instance(scene, "card", card_mesh, placed({-0.7, -0.9, 0.002}));
  add_instance(scene, "card", card_mesh, placed({-1.3, -0.9, 0.0005}));
  add_instance(scene, "pane", add_mesh(scene, wall_mesh({0.9f, -0.7f, -2}, 0.25f, glass, "pane")));
  return scene;
}

// Shared by runs of one scene and view. It is never freed (support/devices.h).
struct ShadowStage {
  Scene scene;
  View view;
  GpuScene gpu{test_devices(), scene};
  ShadowTruth truth{scene, 10'000'000};

  LitPairs pairs(TechniqueRun& run) {
    const std::vector<float> depth = read_depth(run);
    return count_listed_pairs(run, depth, truth.pairs(run.view(), depth, shown_triangles(run)));
  }
};

// No light is lost, shaded though hidden, or hidden though seen.
inline testing::AssertionResult exact(const LitPairs& pairs) {
  if (pairs.lost + pairs.wrong + pairs.leaked + pairs.acned == 0 && pairs.lit > 0)
    return testing::AssertionSuccess();
  return testing::AssertionFailure() << fmt::format(
             "{} lit, {} lost, {} wrong, {} leaked, {} acned, {} either", pairs.lit, pairs.lost, pairs.wrong,
             pairs.leaked, pairs.acned, pairs.either);
}

inline HostShadows shadows_of(const TechniqueRun& run) { return run.frame().shadows(); }

inline bool same_bits(const HostShadows& a, const HostShadows& b) {
  return a.cells == b.cells && a.indices == b.indices && a.bits == b.bits;
}

struct ShadowWay {
  const Technique* technique;
  RasterApi raster;
};

// Every technique with both rasterisers, if it leaves the choice.
inline std::vector<ShadowWay> shadow_ways() {
  std::vector<ShadowWay> all;
  for (const Technique* t : techniques()) {
    if (t->name == std::string("voxel_lights")) continue;  // it has none
    all.push_back({t, RasterApi::opengl});
    if (reads_setting(*t, "raster")) all.push_back({t, RasterApi::opencl});
  }
  return all;
}

}  // namespace lightgrid
