// Light groups: every way to know a pixel's groups shows one picture, and tiles list no light whose groups
// none of their surfaces has.
#include <gmock/gmock.h>

#include "accuracy/surfaces_in_double.h"
#include "base/error.h"
#include "plan/settings/grid.h"
#include "plan/settings/masks.h"
#include "plan/settings/shadows.h"
#include "scene/light_groups.h"
#include "support/small_scene.h"
#include "techniques/rendering.h"

namespace lightgrid {
using namespace lab;
namespace {

constexpr int rooms_width = 127, rooms_height = 73;

Scene rooms() { return find_builtin_scene("rooms")->make(); }

View view_of(const Scene& scene, const char* camera) {
  return make_view(choose_camera(scene, camera), rooms_width, rooms_height);
}

// Ways that show one picture to the bit.
struct Ways {
  const char* name;
  std::vector<std::pair<const char*, const char*>> all;  // technique, settings
};

std::vector<Ways> families() {
  return {
      {"drawn",
       {{"forward", ""},
        {"forward_plus", ""},
        {"forward_plus", "group-tiles=off"},
        {"forward_plus", "group-ids=16 tile=8"},
        {"forward_plus", "kernel-shape=group grid-lists=masks"},
        {"forward_plus", "depth-bounds=none portable=on"},
        {"forward_plus", "depth-bounds=halfz-modified cull-test=exact"},
        {"clustered", ""},
        {"clustered", "kernel-shape=group slices=8"},
        {"world_grid", ""}}},
      {"tiled",
       {{"deferred_tiled", ""},
        {"deferred_tiled", "group-ids=16"},
        {"deferred_tiled", "group-tiles=off portable=on"},
        {"deferred_tiled", "kernel-shape=group"},
        {"deferred_tiled", "z-bins=16 tile=32"},
        {"forward_plus_compute", ""},
        {"forward_plus_compute", "group-ids=16 kernel-shape=group"}}},
      {"in_opencl",
       {{"visibility", ""},
        {"visibility", "lights=all"},
        {"visibility", "group-tiles=off slices=4"},
        {"visibility", "kernel-shape=group"},
        {"visibility", "portable=on tile=8"}}},
      {"tiled_in_opencl",
       {{"deferred_tiled", "raster=opencl"},
        {"deferred_tiled", "raster=opencl group-ids=16 kernel-shape=group"},
        {"forward_plus_compute", "raster=opencl"}}},
      {"volumes",
       {{"deferred", ""},
        {"deferred", "group-ids=16"},
        {"deferred", "volume-culling=stencil"},
        {"deferred", "volume-culling=scissor group-ids=16"},
        {"deferred", "volume-culling=depth-bounds"}}},
      {"full_screen",
       {{"deferred", "light-pass=full-screen"}, {"deferred", "light-pass=full-screen group-ids=16"}}},
      {"stencil",
       {{"deferred", "group-stencil=8"},
        {"deferred", "group-stencil=8 volume-culling=stencil"},
        {"deferred", "group-stencil=8 volume-culling=scissor"},
        {"deferred", "group-stencil=8 volume-culling=depth-bounds"}}},
      {"prepass",
       {{"light_prepass", ""},
        {"light_prepass", "group-ids=16"},
        {"light_prepass", "group-tiles=off portable=on"}}},
      {"prepass_in_groups",
       {{"light_prepass", "kernel-shape=group"}, {"light_prepass", "group-ids=16 kernel-shape=group"}}},
      {"prepass_by_volumes",
       {{"light_prepass", "prepass-lights=volumes"},
        {"light_prepass", "prepass-lights=volumes group-ids=16"}}},
      {"objects", {{"forward_zprepass", ""}}},
      {"passes", {{"forward_multipass", ""}}},
      {"indices", {{"lidr", "lidr-overlap=16"}}},
  };
}

struct GroupWays : testing::TestWithParam<Ways> {};

TEST_P(GroupWays, ShowOnePicture) {
  const Scene scene = rooms();
  for (const char* camera : {"doors", "kitchen", "court"}) {
    const View view = view_of(scene, camera);
    std::optional<Image> first;
    for (const auto& [technique, settings] : GetParam().all) {
      const Image image = render(scene, view, technique, assigned(settings));
      if (!first) first = image;
      EXPECT_TRUE(identical(image, *first)) << camera << ", " << technique << " " << settings;
    }
  }
}

// Families differ by the order of sums and by who draws, no more than without groups.
TEST_P(GroupWays, DifferFromForwardAsLittleAsWithoutGroups) {
  const auto& [technique, settings] = GetParam().all.front();
  const Scene scene = rooms();
  Scene without = scene;
  for (Light& light : without.lights) set_groups(light, all_groups);
  for (Instance& instance : without.instances) set_groups(instance, all_groups);
  const View view = view_of(scene, "doors");
  const auto error = [&](const Scene& of) {
    return compare_images(render(of, view, technique, assigned(settings)), render(of, view, "forward"));
  };
  const ImageError with_numbers = error(scene), plain = error(without);
  EXPECT_LE(with_numbers.rmse, 1.5 * plain.rmse + 1e-7);
}

INSTANTIATE_TEST_SUITE_P(Of, GroupWays, testing::ValuesIn(families()),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(LightGroups, ArePlannedWithTheirWitness) {
  const Scene scene = rooms();
  const TechniqueNeeds& needs = find_technique("forward").needs;
  const FramePlan plan = plan_frame(scene, view_of(scene, "doors"), {}, needs);
  const auto decision = std::ranges::find(plan.decisions, "light groups", &Decision::effect);
  ASSERT_NE(decision, plan.decisions.end());
  EXPECT_TRUE(decision->needed && plan.masks.needed);
  EXPECT_EQ(
      decision->why,
      "light 0 \"hall lamp 0\" has hall; 58 of 58 lights and 116 of 116 instances lack a group, which have "
      "7 different masks");
}

TEST(SurfaceNumbers, DifferentMasksAreNumberedOnce) {
  Scene scene;
  scene.instances.resize(4);
  for (const size_t i : {1, 3}) set_groups(scene.instances[i], 5);
  const MaskPlan masks = plan_masks(scene, all_effects, {}, {}, true, {});
  EXPECT_THAT(masks.values, testing::ElementsAre(all_groups, 5u));
  EXPECT_THAT(masks.of_instance, testing::ElementsAre(0u, 1u, 0u, 1u));
}

// The groups of all surfaces of each tile, by the triangles that are shown.
std::vector<uint32_t> groups_of_tiles(const std::vector<uint32_t>& of_pixels, int tile) {
  const int across = (rooms_width + tile - 1) / tile;
  std::vector<uint32_t> groups(size_t(across * ((rooms_height + tile - 1) / tile)));
  for (int y = 0; y < rooms_height; ++y)
    for (int x = 0; x < rooms_width; ++x)
      groups[size_t(y / tile * across + x / tile)] |= of_pixels[size_t(y * rooms_width + x)];
  return groups;
}

// Entries of pixels' lists whose light no surface of the tile can have.
size_t entries_outside(const Scene& scene, const char* technique, const std::string& settings) {
  TechniqueRun run(test_devices(), scene, view_of(scene, "doors"), assigned(settings),
                   find_technique(technique));
  run.run_frame();
  const std::vector<float> depth = read_depth(run);
  const ListedLights lists = listed_lights(run, depth);
  const int tile = run.view().plan.settings[setting::tile], across = (rooms_width + tile - 1) / tile;
  const std::vector<uint32_t> groups =
      groups_of_tiles(masks_of_pixels(run.view().plan, scene, shown_triangles(run)), tile);
  size_t outside = 0;
  for (int y = 0; y < rooms_height; ++y) {
    for (int x = 0; x < rooms_width; ++x) {
      const size_t pixel = size_t(y * rooms_width + x);
      if (!(depth[pixel] > 0)) continue;
      const size_t cell = lists.cell_of_pixel[pixel];
      for (uint32_t k = 0; k < lists.count[cell]; ++k) {
        const int light = run.view().plan.lights.local[lists.indices[lists.first[cell] + k]];
        outside += !(groups_of(scene.lights[size_t(light)]) & groups[size_t(y / tile * across + x / tile)]);
      }
    }
  }
  return outside;
}

TEST(TileMasks, ALightOutsideEveryGroupOfATileIsNotListed) {
  const Scene scene = rooms();
  for (const auto& [technique, settings] :
       std::vector<std::pair<const char*, std::string>>{{"forward_plus", ""},
                                                        {"forward_plus", "kernel-shape=group"},
                                                        {"forward_plus", "tile=8 portable=on"},
                                                        {"clustered", "tile=32"},
                                                        {"clustered", "slices=8 kernel-shape=group"},
                                                        {"deferred_tiled", "group-ids=16"},
                                                        {"deferred_tiled", "raster=opencl"},
                                                        {"forward_plus_compute", "depth-bounds=none"},
                                                        {"light_prepass", ""},
                                                        {"visibility", "tile=64"},
                                                        {"visibility", "kernel-shape=group tile=8"}}) {
    EXPECT_EQ(entries_outside(scene, technique, settings), 0u) << technique << " " << settings;
    EXPECT_GT(entries_outside(scene, technique, settings + " group-tiles=off"), 1000u)
        << technique << " " << settings;
  }
}

// 300 masks: numbers of 8 bits do not suffice, and only what needs them says so.
TEST(TileMasks, MoreMasksThanNumbersAreRefusedByName) {
  Scene scene = small_scene().scene;
  for (int i = 0; i < 300; ++i) {
    add_instance(scene, "copy", scene.instances[1].mesh,
                 placed({0.1 * (i % 20) - 1, 0.1 * (i / 20) - 1, -3}));
    set_groups(scene.instances.back(), uint32_t(1 + i));
  }
  set_groups(scene.lights[0], 1);
  set_groups(scene.lights[1], 1 << 8);
  const View view = small_view(64, 48);
  for (const char* technique : {"deferred", "deferred_tiled", "light_prepass"}) {
    try {
      render(scene, view, technique);
      ADD_FAILURE() << technique;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("301 different masks")) << technique;
      EXPECT_THAT(error.what(), testing::HasSubstr("group-ids=16"));
    }
  }
  const Image forward = render(scene, view, "forward");
  EXPECT_TRUE(identical(render(scene, view, "forward_plus"), forward));
  EXPECT_TRUE(identical(render(scene, view, "forward_plus", {{setting::number_bits, 16}}), forward));
  EXPECT_TRUE(identical(render(scene, view, "deferred", assigned("group-ids=16")),
                        render(scene, view, "deferred", assigned("group-ids=16 volume-culling=scissor"))));
  EXPECT_TRUE(identical(render(scene, view, "visibility"),
                        render(scene, view, "visibility", assigned("lights=all"))));
}

// Surfaces at one depth: the last is shown, and its groups are the tile's.
TEST(TileMasks, OfSurfacesAtOneDepthAreTheShownOnes) {
  SmallScene s = small_scene();
  add_instance(s.scene, "wall again", s.wall);
  set_groups(s.scene.instances.back(), 2);
  set_groups(s.scene.instances[0], 1);
  for (size_t i = 0; i < s.scene.lights.size(); ++i) set_groups(s.scene.lights[i], i % 2 ? 1 : 2);
  const View view = small_view(rooms_width, rooms_height);
  const Image forward = render(s.scene, view, "forward");
  std::ranges::reverse(s.scene.instances);
  EXPECT_FALSE(same_bytes(render(s.scene, view, "forward"), forward)) << "the order decides";
  for (const char* technique : {"forward_plus", "clustered"})
    expect_exact(s.scene, view, {}, render(s.scene, view, "forward"), technique);
}

// Lamps of one room cast shadows: their groups take nothing from shadows, and the other way round.
TEST(GroupsAndShadows, AreOnePictureInEveryTechnique) {
  Scene scene = rooms();
  for (Light& light : scene.lights)
    light.casts_shadow = light.name.starts_with("hall") || light.name.starts_with("moon");
  const View view = view_of(scene, "doors");
  const Image forward = render(scene, view, "forward");
  EXPECT_FALSE(same_bytes(forward, render(scene, view, "forward", {{setting::shadows, ShadowMethod::none}})));
  for (const char* technique : {"forward_plus", "clustered", "world_grid"})
    expect_exact(scene, view, {}, forward, technique);
  const Image in_opencl = render(scene, view, "visibility");
  EXPECT_TRUE(identical(render(scene, view, "visibility", assigned("kernel-shape=group")), in_opencl));
  EXPECT_TRUE(identical(render(scene, view, "visibility", assigned("shadow-reuse=on")), in_opencl));
}

}  // namespace
}  // namespace lightgrid
