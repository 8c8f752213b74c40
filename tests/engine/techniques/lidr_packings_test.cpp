// lidr within its overlap limit gives the brute-force image, in every packing and row of the table; past it,
// lights are missing but none is replaced by another.
#include <algorithm>

#include "base/error.h"
#include "oracle/position.h"
#include "passes/light_index/layout.h"
#include "passes/light_index/lidr_settings.h"
#include "passes/light_volumes/light_volumes.h"
#include "plan/settings/surfaces.h"
#include "techniques/lidr_scenes.h"

namespace lightgrid {
using namespace lab;
namespace {

struct Row {
  int overlap, lights;
};
// Table 2.9.1 of the article, in its order; and one light of 15, which it leaves out.
const Row table[] = {{2, 15},  {4, 15},   {8, 15},    {16, 15},   {1, 255},   {2, 255},   {4, 255},
                     {8, 255}, {16, 255}, {1, 65535}, {2, 65535}, {4, 65535}, {8, 65535}, {1, 15}};

bool has_row(LidrPacking packing, int overlap) { return packing != LidrPacking::maxblend || overlap <= 4; }

struct LidrTable : testing::TestWithParam<LidrPacking> {
  // As many lights as the row distinguishes, up to the capacity of the wall.
  static Scene scene_of(const Row& row) {
    return clustered_lights(row.overlap, std::min({row.lights, 300, 196 * row.overlap}));
  }
};

TEST_P(LidrTable, HasTheImageOfEveryLightInEveryRow) {
  const View view = small_view(96, 64);
  for (const Row& row : table) {
    SCOPED_TRACE(fmt::format("{} overlaps of {} lights", row.overlap, row.lights));
    const Settings settings = lidr_settings(GetParam(), row.overlap, row.lights);
    if (!has_row(GetParam(), row.overlap)) {
      EXPECT_THROW(light_index_layout(settings, 5), Error);
      continue;
    }
    const Scene scene = scene_of(row);
    expect_within_limit(scene, view, settings, uint32_t(row.overlap), render(scene, view, "forward"));
  }
  // Maximum and minimum of 16 bits take half as many channels.
  if (GetParam() != LidrPacking::maxblend_sort) {
    EXPECT_THROW(light_index_layout(lidr_settings(GetParam(), 16, 65535), 5), Error);
  }
}

TEST_P(LidrTable, HasItBehindFrontFacesToo) {
  const View view = small_view(96, 64);
  for (const Row& row : {Row{1, 255}, Row{4, 255}, Row{16, 255}, Row{4, 65535}}) {
    if (!has_row(GetParam(), row.overlap)) continue;
    SCOPED_TRACE(fmt::format("{} overlaps of {} lights", row.overlap, row.lights));
    const Scene scene = scene_of(row);
    expect_within_limit(scene, view,
                        lidr_settings(GetParam(), row.overlap, row.lights, LidrVolumes::front_faces),
                        uint32_t(row.overlap), render(scene, view, "forward"));
  }
}

// With lights in the scene's order the sum is forward's, bit for bit; and unpacking in float reads the same
// lights.
TEST_P(LidrTable, HasTheBytesInTheScenesOrder) {
  const View view = small_view(96, 64);
  for (const Row& row : {Row{2, 255}, Row{4, 255}, Row{4, 65535}, Row{8, 255}, Row{16, 15}}) {
    if (!has_row(GetParam(), row.overlap)) continue;
    SCOPED_TRACE(fmt::format("{} overlaps of {} lights", row.overlap, row.lights));
    const Scene scene = scene_of(row);
    const Image forward = render(scene, view, "forward");
    Settings settings = lidr_settings(GetParam(), row.overlap, row.lights);
    apply_setting(settings, "lidr-order=scene");
    EXPECT_TRUE(identical(render(scene, view, "lidr", settings), forward));
    apply_setting(settings, "lidr-unpack=float");
    EXPECT_TRUE(identical(render(scene, view, "lidr", settings), forward)) << "in float";
  }
}

// A light listed for a pixel is one whose volume may contain it: past the limit some are missing, no index is
// a mixture.
void expect_no_wrong_light(const Scene& scene, const View& view, const Settings& settings) {
  TechniqueRun run(test_devices(), scene, view, settings, find_technique("lidr"));
  run.run_frame();
  const std::vector<float> depth = read_depth(run);
  const ListedLights lists = listed_lights(run, depth);
  std::vector<ViewLight> lights = lights_in_view(scene, view);
  std::vector<const LightVolume*> volume_of(lights.size(), nullptr);
  const auto volumes = light_volumes(view, lights, settings[setting::volume_mesh], 4);
  for (const LightVolume& v : volumes) volume_of[v.light] = &v;
  size_t listed = 0;
  for (uint32_t pixel : covered_pixels(depth)) {
    const glm::dvec3 p =
        position_from_depth(view, int(pixel) % view.width, int(pixel) / view.width, depth[pixel]);
    for (uint32_t i = 0; i < lists.count[pixel]; ++i, ++listed) {
      const uint32_t light = lists.indices[lists.first[pixel] + i];
      ASSERT_LT(light, lights.size());
      ASSERT_NE(volume_of[light], nullptr);
      ASSERT_LE(glm::length(p - volume_of[light]->center), 1.01 * volume_of[light]->radius)
          << "pixel " << pixel << " light " << light;
    }
  }
  EXPECT_GT(listed, 0u);
  const LitPairs pairs = count_pairs(view, depth, lights, lists);
  EXPECT_GT(pairs.lost, 0u) << "no test of what is past the limit";
  EXPECT_EQ(pairs.wrong, 0u);
}

TEST_P(LidrTable, LosesLightsPastTheLimitAndMixesNone) {
  Scene scene = clustered_lights(16, 240);
  for (size_t i = 0; i < scene.lights.size(); i += 3) scene.lights[i].radius_m = 0.4f;
  for (const int overlap : {1, 2, 4, 8}) {
    if (!has_row(GetParam(), overlap)) continue;
    SCOPED_TRACE(overlap);
    expect_no_wrong_light(scene, small_view(96, 64), lidr_settings(GetParam(), overlap));
  }
}

INSTANTIATE_TEST_SUITE_P(Packings, LidrTable,
                         testing::Values(LidrPacking::bitshift, LidrPacking::maxblend, LidrPacking::sort,
                                         LidrPacking::maxblend_sort),
                         [](const auto& info) {
                           return info.param == LidrPacking::sort            ? "Sort"
                                  : info.param == LidrPacking::maxblend      ? "Maxblend"
                                  : info.param == LidrPacking::maxblend_sort ? "MaxblendSort"
                                                                             : "Bitshift";
                         });

}  // namespace
}  // namespace lightgrid
