// Sorted packings: further passes for lights that find no group, and groups that are kept for still lights.
#include "base/error.h"
#include "techniques/lidr_scenes.h"

namespace lightgrid {
namespace {

Settings sorted_settings(LidrPacking packing, int overlap, int passes, LidrSort sort = LidrSort::view) {
  Settings settings = lidr_settings(packing, overlap);
  settings.lidr_passes = passes, settings.lidr_sort = sort;
  return settings;
}

constexpr LidrPacking sorted_packings[] = {LidrPacking::sort, LidrPacking::maxblend_sort};

// Clusters of 8 in images of 2: four passes hold all, and one pass a quarter.
TEST(LidrSort, MorePassesHaveTheLightsThatFoundNoGroup) {
  const Scene scene = clustered_lights(8, 200);
  const View view = small_view(96, 64);
  const Image forward = render(scene, view, "forward");
  for (const LidrPacking packing : sorted_packings) {
    for (const LidrVolumes volumes : {LidrVolumes::stencil, LidrVolumes::front_faces}) {
      Settings settings = sorted_settings(packing, 2, 4);
      settings.lidr_volumes = volumes;
      expect_within_limit(scene, view, settings, 8, forward);
      uint64_t before = ~0ull;
      for (const int passes : {1, 2}) {
        settings.lidr_passes = passes;
        const Pairs p = pairs_of(scene, view, settings);
        EXPECT_EQ(p.pairs.wrong, 0u);
        EXPECT_GT(p.pairs.lost, 0u);
        EXPECT_LT(p.pairs.lost, before);
        EXPECT_GT(compare_images(p.image, forward).max_rel, 0.01) << "a pass too few shows";
        before = p.pairs.lost;
      }
    }
  }
}

// Directional and ambient light, emission and unlit surfaces are of the first pass alone; blended surfaces
// have all their lights.
TEST(LidrSort, MorePassesAddNothingTwice) {
  SmallScene s = small_scene();
  for (const char* name : {"blend", "mask", "spot", "directional", "emissive_map", "unlit"})
    effect(name).add(s);
  for (int i = 0; i < 5; ++i) add_point(s.scene, "lamp", {0.2 * i, 0.1, -3.0}, {1, 0.5f, 1}, 1, 3);
  const View view = small_view(96, 64);
  const Image forward = render(s.scene, view, "forward");
  for (const LidrPacking packing : sorted_packings) {
    for (const LidrVolumes volumes : {LidrVolumes::stencil, LidrVolumes::front_faces}) {
      Settings settings = sorted_settings(packing, 1, 16);
      settings.lidr_volumes = volumes;
      expect_within_limit(s.scene, view, settings, 16, forward);
    }
  }
}

TEST(LidrSort, StillGroupsHoldForEveryCamera) {
  const Scene scene = clustered_lights(4, 200);
  for (const LidrPacking packing : sorted_packings) {
    const Settings settings = sorted_settings(packing, 4, 4, LidrSort::still);
    TechniqueRun run(test_devices(), scene, small_view(96, 64), settings, find_technique("lidr"));
    for (int i = 0; i < 3; ++i) {
      View view = small_view(96, 64);
      view = make_view(look_at({0.4 * i, 0.2 * i, -0.3 * i}, {0, 0, -4}), 96, 64);
      run.look(view);
      run.run_frame();
      const LitPairs pairs = count_listed_pairs(run, read_depth(run));
      EXPECT_EQ(pairs.lost, 0u) << i;
      EXPECT_EQ(pairs.wrong, 0u) << i;
      EXPECT_LT(compare_images(run.image(), render(scene, view, "forward")).max_rel, other_order) << i;
      // A run that never saw another camera has the same groups.
      EXPECT_TRUE(identical(run.image(), render(scene, view, "lidr", settings))) << i;
    }
  }
}

// Lights of unusual reach: no group of the scene holds, and the view's do.
TEST(LidrSort, StillGroupsOfAwkwardLights) {
  const Scene scene = awkward_lights();
  const View view = small_view(96, 64);
  expect_within_limit(scene, view, sorted_settings(LidrPacking::sort, 8, 4, LidrSort::still), 32,
                      render(scene, view, "forward"));
}

TEST(LidrSort, StillGroupsBehindFrontFacesAreRefused) {
  Settings settings = sorted_settings(LidrPacking::sort, 4, 1, LidrSort::still);
  settings.lidr_volumes = LidrVolumes::front_faces;
  EXPECT_THROW(render(clustered_lights(4, 20), small_view(32, 32), "lidr", settings), Error);
}

}  // namespace
}  // namespace lightgrid
