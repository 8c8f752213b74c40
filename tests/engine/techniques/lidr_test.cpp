// lidr: any number of lights, equal frames, and the memory computed on its page.
#include "base/error.h"
#include "passes/light_index/layout.h"
#include "passes/light_index/lidr_settings.h"
#include "scene/virtual_lights.h"
#include "support/error_of.h"
#include "techniques/lidr_scenes.h"

namespace lightgrid {
namespace {

TEST(Lidr, KeepsTheBrightestWhereThereIsNoRoom) {
  SmallScene s = small_scene(false);
  for (int i = 0; i < 9; ++i) add_point(s.scene, "lamp", {0, 0, -3.5}, {1, 1, 1}, i == 6 ? 50.0f : 1.0f, 2);
  TechniqueRun run(test_devices(), s.scene, small_view(32, 32), lidr_settings(LidrPacking::bitshift, 1),
                   find_technique("lidr"));
  run.run_frame();
  const ListedLights lists = listed_lights(run, read_depth(run));
  ASSERT_GT(lists.indices.size(), 100u);
  for (uint32_t light : lists.indices) ASSERT_EQ(light, 6u);
}

TEST(Lidr, AnyNumberOfLights) {
  for (const int lights : {0, 1, 15, 16, 255, 256}) {
    SCOPED_TRACE(lights);
    const Scene scene = clustered_lights(4, lights);
    const View view = small_view(64, 48);
    const Image forward = render(scene, view, "forward");
    for (const LidrPacking packing : {LidrPacking::bitshift, LidrPacking::maxblend, LidrPacking::sort}) {
      expect_within_limit(scene, view, lidr_settings(packing, 4), 4, forward);
    }
  }
}

// The last 16-bit index, and one more than that.
TEST(Lidr, SixtyFiveThousandLights) {
  SmallScene s = small_scene(false);
  s.scene.instances.resize(1);
  for (int i = 0; i < 65535; ++i) {
    add_point(s.scene, "lamp", {-1.8 + 0.0156 * (i % 256), -2 + 0.0156 * (i / 256), -3.999}, {1, 1, 1}, 1e-4f,
              0.009f);
  }
  const View view = small_view(48, 32);
  const Image forward = render(s.scene, view, "forward");
  for (const LidrPacking packing : {LidrPacking::bitshift, LidrPacking::maxblend, LidrPacking::sort}) {
    expect_within_limit(s.scene, view, lidr_settings(packing, 4), 4, forward);
  }
  add_point(s.scene, "lamp", {0, 0, -3}, {1, 1, 1}, 1, 1);
  try {
    render(s.scene, view, "lidr");
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()),
              "lidr: 65536 point and spot lights are more than the 65535 that have an index");
  }
}

TEST(Lidr, MoreLightsThanAskedForAreRefused) {
  EXPECT_EQ(
      std::string(error_of([&] { light_index_layout(lidr_settings(LidrPacking::bitshift, 4, 15), 16); })),
      "lidr: 16 point and spot lights are more than the 15 that have an index; use lidr-lights=auto");
}

// The last column is that of virtual lights, the one before it that of cones.
TEST(Lidr, ReadsTheSameLightsFromAUniformBlock) {
  Settings constants = lidr_settings(LidrPacking::bitshift);
  apply_setting(constants, "lidr-light-data=constants");
  SmallScene s = small_scene();
  for (const char* name : {"blend", "spot", "directional"}) effect(name).add(s);
  Light card = s.scene.lights[0];
  make_virtual(card);
  card.nearest_m = 0.3f;
  card.position.x += 0.4;
  for (const bool virtual_lights : {false, true}) {
    if (virtual_lights) s.scene.lights.push_back(card);
    TechniqueRun run(test_devices(), s.scene, small_view(64, 48), constants, find_technique("lidr"));
    for (const double x : {0.0, 0.3}) {
      const View view = make_view(look_at({x, 0, 0}, {0, 0, -4}), 64, 48);
      run.look(view);
      run.run_frame();
      EXPECT_TRUE(
          identical(run.image(), render(s.scene, view, "lidr", lidr_settings(LidrPacking::bitshift))));
    }
  }
  const Scene full = clustered_lights(4, 255), too_many = clustered_lights(4, 256);
  const View view = small_view(64, 48);
  EXPECT_TRUE(identical(render(full, view, "lidr", constants), render(full, view, "lidr")));
  EXPECT_EQ(std::string(error_of([&] { render(too_many, view, "lidr", constants); })),
            "lidr: a uniform block holds 255 lights, but 256 are in view; use lidr-light-data=textures");
}

TEST(Lidr, EveryFrameIsTheSameAndMakesNothingNew) {
  const Scene scene = awkward_lights();
  for (const LidrPacking packing : {LidrPacking::bitshift, LidrPacking::sort}) {
    TechniqueRun run(test_devices(), scene, small_view(64, 48), lidr_settings(packing),
                     find_technique("lidr"));
    run.run_frame();
    const Image first = run.image();
    const GlCounts before = gl_counts();
    run.run_frame();
    EXPECT_TRUE(identical(run.image(), first));
    for (int kind = 0; kind < 6; ++kind) EXPECT_EQ(gl_counts().made[kind], before.made[kind]);
  }
}

// docs/techniques/lidr.md#what-it-costs
TEST(Lidr, TakesTheMemoryThatItsPageComputes) {
  const Scene scene = clustered_lights(4, 255);
  const View view = small_view(640, 360);
  TechniqueRun run(test_devices(), scene, view, lidr_settings(LidrPacking::bitshift, 16),
                   find_technique("lidr"));
  TechniqueRun forward(test_devices(), scene, view, {}, find_technique("forward"));
  run.run_frame();
  forward.run_frame();
  const size_t pixels = 640 * 360;
  const size_t images = pixels * 16, stencil = pixels, meshes = light_mesh_bytes, volumes = 255 * 68;
  EXPECT_EQ(run.result().memory_light_grid, images);
  EXPECT_EQ(run.result().memory_total, forward.result().memory_total + images + stencil + meshes + volumes);
}

}  // namespace
}  // namespace lightgrid
