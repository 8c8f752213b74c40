// Counts of pairs in the background: the same as a comparison's, of one light alone, and stopped.
#include "view/pair_count.h"

#include <gtest/gtest.h>

#include <numeric>

#include "accuracy/oracle.h"
#include "accuracy/shadow_truth.h"
#include "accuracy/surfaces_in_double.h"
#include "support/devices.h"
#include "support/small_scene.h"

namespace lightgrid::app {
using namespace lab;
namespace {

// Light 0 casts nothing; between lamps there are two suns, of which the second casts.
Scene scene_with_suns() {
  SmallScene s = small_scene_of_casters();
  s.scene.lights[0].casts_shadow = false;
  for (const int i : {2, 4}) s.scene.lights[size_t(i)].type = LightType::directional;
  s.scene.lights[2].casts_shadow = false;
  s.scene.lights[4].direction = glm::normalize(glm::vec3(-1, 0, -1));
  add_pane_before_wall(s, 0.7f);
  return s.scene;
}

const std::vector<std::string> leaking_maps = {"shadows=map", "shadow-size=16"};  // which leak and acne

struct CountedRun {
  explicit CountedRun(const std::vector<std::string>& assignments = leaking_maps)
      : run(software_devices(), scene, small_view(67, 41), settings_of(assignments),
            find_technique("visibility")) {
    run.draw_frame();
  }
  static Settings settings_of(const std::vector<std::string>& assignments) {
    Settings settings;
    for (const std::string& assignment : assignments) apply_setting(settings, assignment);
    return settings;
  }
  const LitPairs* counted(const CountChoice& choice) {
    count.start(run, choice);
    return count.result(choice, true);
  }

  // By a comparison's oracle.
  LitPairs compared() {
    const std::vector<float> depth = read_depth(run);
    ShadowTruth truth(scene, 1'000'000);
    return count_listed_pairs(run, depth, truth.pairs(run.view(), depth, shown_triangles(run)));
  }

  Scene scene = scene_with_suns();
  TechniqueRun run;
  SceneOcclusion occlusion{scene};
  PairCount count{occlusion};
};

TEST(PairCount, IsThatOfAComparison) {
  CountedRun c;
  const LitPairs* pairs = c.counted({1, {}, true});
  ASSERT_TRUE(pairs);
  const LitPairs expected = c.compared();
  EXPECT_GT(expected.leaked, 0u);
  EXPECT_GT(expected.acned, 0u);
  EXPECT_EQ(pairs->lit, expected.lit);
  EXPECT_EQ(pairs->listed_of_pixel, expected.listed_of_pixel);
  EXPECT_EQ(pairs->lost_of_pixel, expected.lost_of_pixel);
  EXPECT_EQ(pairs->hidden_of_pixel, expected.hidden_of_pixel);
  EXPECT_EQ(pairs->leaked_of_pixel, expected.leaked_of_pixel);
  EXPECT_EQ(pairs->acned_of_pixel, expected.acned_of_pixel);
  EXPECT_EQ(c.count.progress(), 1);
}

// An exact frame has no leaks and no acne, whatever blended surfaces hide.
TEST(PairCount, IsOfWhatBlendedSurfacesHideInTheRun) {
  CountedRun plain({"shadow-blended=none"});
  const uint64_t without = plain.counted({1, {}, true})->hidden;
  for (const char* setting : {"shadow-blended=opaque", "shadow-blended=alpha"}) {
    SCOPED_TRACE(setting);
    CountedRun c({setting});
    const LitPairs* pairs = c.counted({1, {}, true});
    ASSERT_TRUE(pairs);
    EXPECT_EQ(pairs->leaked + pairs->acned, 0u);
    EXPECT_GT(pairs->hidden, without + 200);
    EXPECT_EQ(pairs->hidden_of_pixel, c.compared().hidden_of_pixel);
  }
}

TEST(PairCount, OfLightsAloneIsThatOfAllInParts) {
  CountedRun c;
  const LitPairs all = *c.counted({1, {}, true});
  std::vector<uint32_t> sums[5];
  for (auto& sum : sums) sum.resize(all.lit_of_pixel.size());
  const std::vector<uint32_t> LitPairs::*maps[5] = {&LitPairs::listed_of_pixel, &LitPairs::lit_of_pixel,
                                                    &LitPairs::hidden_of_pixel, &LitPairs::leaked_of_pixel,
                                                    &LitPairs::acned_of_pixel};
  for (const int light : {0, 1, 3, 5, 4}) {
    const LitPairs* one = c.counted({1, light, true});
    ASSERT_TRUE(one);
    // The sun, 4, is in no list: among all lights only its shadow counts.
    for (int i = light == 4 ? 2 : 0; i < 5; ++i) {
      for (size_t p = 0; p < sums[i].size(); ++p) sums[i][p] += (one->*maps[i])[p];
    }
  }
  for (int i = 0; i < 5; ++i) EXPECT_EQ(sums[i], all.*maps[i]) << i;
}

TEST(PairCount, OfADirectionalLightAloneHoldsItsShadow) {
  CountedRun c;
  const LitPairs* sun = c.counted({1, 4, true});
  ASSERT_TRUE(sun);
  const FrameShadows shadows = read_frame_shadows(c.run);
  const std::vector<CastingTriangle> triangles = casting_triangles(c.scene, shadows.shown);
  ShadowTruth truth(c.scene, 0);
  std::vector<uint32_t> covered;
  for (uint32_t p = 0; p < shadows.depth.size(); ++p) {
    if (shadows.depth[p] > 0) covered.push_back(p);
  }
  const auto seen = truth.at_pixels(c.run.view(), shadows.depth, triangles, covered);
  uint64_t hidden = 0;
  for (const uint32_t p : covered) {
    EXPECT_EQ(sun->hidden_of_pixel[p], seen->at(p, 4) == Sight::hidden) << p;
    hidden += sun->hidden_of_pixel[p];
  }
  EXPECT_GT(hidden, 50u);
  EXPECT_LT(hidden, covered.size() / 2);
  EXPECT_EQ(sun->listed, covered.size());
}

// After leave_scene() the scene may change; what was stopped has no result, and another count may start.
TEST(PairCount, StopsWhereTheSceneChangesOrAnotherChoiceIsWanted) {
  CountedRun c;
  c.count.start(c.run, {1, {}, true});
  c.count.leave_scene();
  c.scene.instances[1].world_from_object[3].x += 3;
  c.occlusion.scene_moved();
  EXPECT_FALSE(c.count.result({1, {}, true}, true));
  EXPECT_FALSE(c.count.running());
  c.count.start(c.run, {1, {}, true});
  EXPECT_FALSE(c.count.result({2, {}, true}, true)) << "of another picture";
  EXPECT_FALSE(c.count.result({1, {}, true}, true)) << "that one was stopped";
  EXPECT_TRUE(c.counted({2, {}, false}));
  EXPECT_TRUE(c.count.result({2, {}, false}, false)) << "kept";
}

}  // namespace
}  // namespace lightgrid::app
