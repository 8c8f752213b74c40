// Sorted packings: further passes for lights that find no group, and groups that are kept for still lights.
#include "base/error.h"
#include "passes/light_index/lidr_settings.h"
#include "techniques/lidr_scenes.h"

namespace lightgrid {
namespace {

Settings sorted_settings(LidrPacking packing, int overlap, int passes, LidrSort sort = LidrSort::view) {
  Settings settings = lidr_settings(packing, overlap);
  settings.set(setting::lidr_passes, passes);
  settings.set(setting::lidr_sort, sort);
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
      settings.set(setting::lidr_volumes, volumes);
      expect_within_limit(scene, view, settings, 8, forward);
      uint64_t before = ~0ull;
      for (const int passes : {1, 2}) {
        settings.set(setting::lidr_passes, passes);
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
      settings.set(setting::lidr_volumes, volumes);
      expect_within_limit(s.scene, view, settings, 16, forward);
    }
  }
}

// If surfaces have one depth, in one mesh and in two, the last is shown and lit.
TEST(LidrSort, MorePassesLightTheLastOfEqualSurfaces) {
  SmallScene s = small_scene();
  const int red = add_material(s.scene, "red", {0.9f, 0.1f, 0.1f}, 0, 0.8f);
  Mesh twice = wall_mesh({0.2f, 0, -4}, 1, red, "twice");
  const size_t indices = twice.indices.size();
  for (size_t i = 0; i < indices; ++i) twice.indices.push_back(twice.indices[i]);
  add_instance(s.scene, "over the wall", add_mesh(s.scene, std::move(twice)));
  const View view = small_view(96, 64);
  const Image forward = render(s.scene, view, "forward");
  for (const LidrPacking packing : sorted_packings)
    expect_within_limit(s.scene, view, sorted_settings(packing, 1, 8), 8, forward);
}

// Four of each type where there is room for four.
TEST(LidrTypes, APassForEachTypeHasRoomForEach) {
  SmallScene s = small_scene(false);
  for (int i = 0; i < 4; ++i) {
    add_point(s.scene, "lamp", {0.1 * i, 0.2, -3.4}, {1, 0.5f, 0.3f * i}, 1, 2);
    add_spot(s.scene, "spot", {0.1 * i, 0.1, -2.5}, {0, 0, -4}, {0.2f, 1, 0.2f * i}, 2, 4, 20, 50);
  }
  const View view = small_view(96, 64);
  const Image forward = render(s.scene, view, "forward");
  for (const LidrPacking packing : {LidrPacking::bitshift, LidrPacking::maxblend, LidrPacking::sort}) {
    for (const LidrVolumes volumes : {LidrVolumes::stencil, LidrVolumes::front_faces}) {
      SCOPED_TRACE(fmt::format("packing {}, volumes {}", int(packing), int(volumes)));
      Settings settings = lidr_settings(packing, 4, 0, volumes);
      EXPECT_GT(pairs_of(s.scene, view, settings).pairs.lost, 0u);
      settings.set(setting::lidr_types, LidrTypes::passes);
      expect_within_limit(s.scene, view, settings, 8, forward);
    }
  }
}

// The points' loop reads no cones: a scene of one type has its usual image.
TEST(LidrTypes, OneTypeTakesOnePass) {
  Settings settings = lidr_settings(LidrPacking::bitshift, 4);
  apply_setting(settings, "lidr-order=scene");
  const Scene scene = clustered_lights(4, 40);
  const Image flag = render(scene, small_view(96, 64), "lidr", settings);
  settings.set(setting::lidr_types, LidrTypes::passes);
  EXPECT_TRUE(identical(render(scene, small_view(96, 64), "lidr", settings), flag));
}

// Masks, blended surfaces and surfaces of one depth: forward's bytes, where no light is lost.
TEST(LidrNoPrepass, HasForwardsBytes) {
  SmallScene s = small_scene();
  for (const char* name : {"blend", "mask", "spot", "directional"}) effect(name).add(s);
  const int red = add_material(s.scene, "red", {0.9f, 0.1f, 0.1f}, 0, 0.8f);
  add_instance(s.scene, "over the wall",
               add_mesh(s.scene, wall_mesh({0.2f, 0, -4}, 1, red, "the same depth")));
  const View view = small_view(96, 64);
  for (const LidrPacking packing : {LidrPacking::bitshift, LidrPacking::sort}) {
    Settings settings = lidr_settings(packing, 16, 0, LidrVolumes::no_prepass);
    apply_setting(settings, "lidr-order=scene");
    TechniqueRun run(test_devices(), s.scene, view, settings, find_technique("lidr"));
    run.run_frame();
    const LitPairs pairs = count_listed_pairs(run, read_depth(run));
    EXPECT_EQ(pairs.lost, 0u);
    EXPECT_EQ(pairs.wrong, 0u);
    if (packing == LidrPacking::bitshift) {
      EXPECT_TRUE(identical(run.image(), render(s.scene, view, "forward")));
    } else {
      EXPECT_LT(compare_images(run.image(), render(s.scene, view, "forward")).max_rel, other_order);
    }
  }
}

TEST(LidrNoPrepass, FillsSlotsFaster) {
  const Scene scene = awkward_lights();
  const View view = small_view(96, 64);
  const auto listed = [&](LidrVolumes volumes) {
    return pairs_of(scene, view, lidr_settings(LidrPacking::bitshift, 16, 255, volumes)).pairs.listed;
  };
  EXPECT_LT(listed(LidrVolumes::stencil), listed(LidrVolumes::front_faces));
  EXPECT_LT(listed(LidrVolumes::front_faces), listed(LidrVolumes::no_prepass));
}

TEST(LidrNoPrepass, RefusesShadows) {
  SmallScene s = small_scene_of_casters();
  const Settings settings = lidr_settings(LidrPacking::bitshift, 16, 0, LidrVolumes::no_prepass);
  EXPECT_THROW(render(s.scene, small_view(32, 32), "lidr", settings), Error);
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
  settings.set(setting::lidr_volumes, LidrVolumes::front_faces);
  EXPECT_THROW(render(clustered_lights(4, 20), small_view(32, 32), "lidr", settings), Error);
}

}  // namespace
}  // namespace lightgrid
