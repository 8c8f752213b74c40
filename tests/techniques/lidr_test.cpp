// lidr within its overlap limit is the brute-force image, in every packing and row of the table; past it, lights are missing
// and none is another.
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "base/error.h"
#include "passes/frame/light_index_layout.h"
#include "passes/frame/light_volumes.h"
#include "reference/position.h"
#include "scene/random.h"
#include "support/small_scene.h"
#include "techniques/rendering.h"

namespace lightgrid {
namespace {

Settings lidr_settings(LidrPacking packing, int overlap = 0, int lights = 0, LidrVolumes volumes = LidrVolumes::stencil) {
  return {.lidr_packing = packing, .lidr_overlap = overlap, .lidr_lights = lights, .lidr_volumes = volumes};
}

// Clusters of lights on the wall, `overlap` each, which neither touch nor cover each other on screen; `lights` in all.
Scene clustered_lights(int overlap, int lights) {
  SmallScene s = small_scene(false);
  s.scene.instances.resize(1);  // without the ball
  for (int i = 0; i < lights; ++i) {
    const int cluster = i / overlap, within = i % overlap;
    const glm::dvec3 center(-1.6 + 0.25 * (cluster % 14), -1.6 + 0.25 * (cluster / 14), -3.97);
    add_point(s.scene, "lamp", center + 0.01 * glm::dvec3(std::cos(within), std::sin(within), 0), {1, 0.5f + 0.02f * within, 0.4f},
              0.05f, 0.08f);
  }
  return s.scene;
}

struct Pairs {
  LitPairs pairs;
  uint32_t most_listed = 0, most_lit = 0;
  Image image;
};

Pairs pairs_of(const Scene& scene, const View& view, const Settings& settings) {
  TechniqueRun run(test_devices(), scene, view, settings, find_technique("lidr"));
  run.run_frame();
  Pairs out{count_listed_pairs(run, read_depth(run.frame())), 0, 0, run.image()};
  for (uint32_t n : out.pairs.listed_of_pixel) out.most_listed = std::max(out.most_listed, n);
  for (uint32_t n : out.pairs.lit_of_pixel) out.most_lit = std::max(out.most_lit, n);
  return out;
}

// Sums are taken in another order than forward's; each has the rounding of a few lights.
constexpr double other_order = 1e-5;

void expect_within_limit(const Scene& scene, const View& view, const Settings& settings, uint32_t limit, const Image& forward) {
  const Pairs p = pairs_of(scene, view, settings);
  EXPECT_LE(p.most_lit, limit) << "the scene is no test of this row";
  EXPECT_LE(p.most_listed, limit);
  EXPECT_EQ(p.pairs.lost, 0u);
  EXPECT_EQ(p.pairs.wrong, 0u);
  EXPECT_LT(compare_images(p.image, forward).max_rel, other_order);
  EXPECT_EQ(count_nan_pixels(p.image), 0u);
}

struct Row {
  int overlap, lights;
};
const Row table[] = {{1, 15}, {1, 255}, {1, 65535}, {2, 15}, {2, 255}, {2, 65535}, {4, 15}, {4, 255}, {4, 65535},
                     {8, 15}, {8, 255}, {8, 65535}, {16, 15}, {16, 255}};

struct LidrTable : testing::TestWithParam<LidrPacking> {
  // As many lights as the row tells apart, up to what the wall has room for.
  static Scene scene_of(const Row& row) { return clustered_lights(row.overlap, std::min({row.lights, 300, 196 * row.overlap})); }
};

TEST_P(LidrTable, HasTheImageOfEveryLightInEveryRow) {
  const View view = small_view(96, 64);
  for (const Row& row : table) {
    SCOPED_TRACE(fmt::format("{} overlaps of {} lights", row.overlap, row.lights));
    const Settings settings = lidr_settings(GetParam(), row.overlap, row.lights);
    if (GetParam() == LidrPacking::maxblend && row.overlap > 4) {
      EXPECT_THROW(light_index_layout(settings, 5), Error);
      continue;
    }
    const Scene scene = scene_of(row);
    expect_within_limit(scene, view, settings, uint32_t(row.overlap), render(scene, view, "forward"));
  }
  EXPECT_THROW(light_index_layout(lidr_settings(GetParam(), 16, 65535), 5), Error);
}

TEST_P(LidrTable, HasItBehindFrontFacesToo) {
  const View view = small_view(96, 64);
  for (const Row& row : {Row{1, 255}, Row{4, 255}, Row{16, 255}, Row{4, 65535}}) {
    if (GetParam() == LidrPacking::maxblend && row.overlap > 4) continue;
    SCOPED_TRACE(fmt::format("{} overlaps of {} lights", row.overlap, row.lights));
    const Scene scene = scene_of(row);
    expect_within_limit(scene, view, lidr_settings(GetParam(), row.overlap, row.lights, LidrVolumes::front_faces), uint32_t(row.overlap),
                        render(scene, view, "forward"));
  }
}

// With lights in the scene's order the sum is forward's, bit for bit; and unpacking in float reads the same lights.
TEST_P(LidrTable, HasTheBytesInTheScenesOrder) {
  const View view = small_view(96, 64);
  for (const Row& row : {Row{2, 255}, Row{4, 255}, Row{4, 65535}, Row{8, 255}, Row{16, 15}}) {
    if (GetParam() == LidrPacking::maxblend && row.overlap > 4) continue;
    SCOPED_TRACE(fmt::format("{} overlaps of {} lights", row.overlap, row.lights));
    const Scene scene = scene_of(row);
    const Image forward = render(scene, view, "forward");
    Settings settings = lidr_settings(GetParam(), row.overlap, row.lights);
    settings.lidr_order = LidrOrder::scene;
    EXPECT_TRUE(identical(render(scene, view, "lidr", settings), forward));
    settings.lidr_unpack = LidrUnpack::floats;
    EXPECT_TRUE(identical(render(scene, view, "lidr", settings), forward)) << "in float";
  }
}

// A light listed for a pixel is one whose volume the pixel may be in: past the limit some are missing, none is mixed of two.
void expect_no_wrong_light(const Scene& scene, const View& view, const Settings& settings) {
  TechniqueRun run(test_devices(), scene, view, settings, find_technique("lidr"));
  run.run_frame();
  const std::vector<float> depth = read_depth(run.frame());
  const ListedLights lists = listed_lights(run, depth);
  std::vector<ViewLight> lights = lights_in_view(scene, view);
  std::vector<const LightVolume*> volume_of(lights.size(), nullptr);
  const auto volumes = light_volumes(view, lights, settings.volume_mesh, 4);
  for (const LightVolume& v : volumes) volume_of[v.light] = &v;
  size_t listed = 0;
  for (uint32_t pixel : covered_pixels(depth)) {
    const glm::dvec3 p = position_from_depth(view, int(pixel) % view.width, int(pixel) / view.width, depth[pixel]);
    for (uint32_t i = 0; i < lists.count[pixel]; ++i, ++listed) {
      const uint32_t light = lists.indices[lists.first[pixel] + i];
      ASSERT_LT(light, lights.size());
      ASSERT_NE(volume_of[light], nullptr);
      ASSERT_LE(glm::length(p - volume_of[light]->center), 1.01 * volume_of[light]->radius) << "pixel " << pixel << " light " << light;
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
    if (GetParam() == LidrPacking::maxblend && overlap > 4) continue;
    SCOPED_TRACE(overlap);
    expect_no_wrong_light(scene, small_view(96, 64), lidr_settings(GetParam(), overlap));
  }
}

INSTANTIATE_TEST_SUITE_P(Packings, LidrTable, testing::Values(LidrPacking::bitshift, LidrPacking::maxblend, LidrPacking::sort),
                         [](const auto& info) {
                           return info.param == LidrPacking::sort ? "Sort" : info.param == LidrPacking::maxblend ? "Maxblend" : "Bitshift";
                         });

TEST(Lidr, KeepsTheBrightestWhereThereIsNoRoom) {
  SmallScene s = small_scene(false);
  for (int i = 0; i < 9; ++i) add_point(s.scene, "lamp", {0, 0, -3.5}, {1, 1, 1}, i == 6 ? 50.0f : 1.0f, 2);
  TechniqueRun run(test_devices(), s.scene, small_view(32, 32), lidr_settings(LidrPacking::bitshift, 1), find_technique("lidr"));
  run.run_frame();
  const ListedLights lists = listed_lights(run, read_depth(run.frame()));
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

// The last index of 16 bits, and one more than there is.
TEST(Lidr, SixtyFiveThousandLights) {
  SmallScene s = small_scene(false);
  s.scene.instances.resize(1);
  for (int i = 0; i < 65535; ++i) {
    add_point(s.scene, "lamp", {-1.8 + 0.0156 * (i % 256), -2 + 0.0156 * (i / 256), -3.999}, {1, 1, 1}, 1e-4f, 0.009f);
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
    EXPECT_EQ(std::string(error.what()), "lidr: 65536 point and spot lights are more than the 65535 that have an index");
  }
}

TEST(Lidr, MoreLightsThanAskedForAreRefused) {
  try {
    light_index_layout(lidr_settings(LidrPacking::bitshift, 4, 15), 16);
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    EXPECT_EQ(std::string(error.what()), "lidr: 16 point and spot lights are more than the 15 that have an index; use lidr-lights=auto");
  }
}

// Lights about everything, few enough: around the eye, past near and far, behind, grazing, tangent, over the whole screen.
Scene awkward_lights() {
  SmallScene s = small_scene();
  effects()[0].add(s);  // glass
  effects()[11].add(s); // a spot
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

// Of 18 lights no pixel is in more than 16 volumes.
TEST(Lidr, LightsAboutTheEyeTheNearPlaneAndEverything) {
  const Scene scene = awkward_lights();
  Camera ends = look_at({0, 0, 0}, {0, 0, -1});
  ends.far_m = 4.5;
  Camera orthographic = ends;
  orthographic.orthographic = true, orthographic.half_width_m = orthographic.half_height_m = 2, orthographic.near_m = -3;
  for (const View& view : {small_view(127, 73), make_view(ends, 127, 73), make_view(orthographic, 127, 73)}) {
    const Image forward = render(scene, view, "forward");
    for (const LidrVolumes volumes : {LidrVolumes::stencil, LidrVolumes::front_faces}) {
      for (const VolumeMeshes meshes : {VolumeMeshes::automatic, VolumeMeshes::icosahedron, VolumeMeshes::box}) {
        SCOPED_TRACE(fmt::format("near {} volumes {} mesh {}", view.near_m, int(volumes), int(meshes)));
        Settings settings = lidr_settings(LidrPacking::bitshift, 16, 255, volumes);
        settings.volume_mesh = meshes;
        expect_within_limit(scene, view, settings, 16, forward);
      }
    }
  }
}

TEST(Lidr, WithEveryEffectsCodeAndWithBlinnPhong) {
  const View view = small_view(64, 48);
  for (const Scene& scene : {awkward_lights(), small_scene(false).scene}) {
    Settings settings;
    settings.everything_on = true;
    expect_within_limit(scene, view, settings, 16, render(scene, view, "forward"));
    settings = {.brdf = Brdf::blinn};
    expect_within_limit(scene, view, settings, 16, render(scene, view, "forward", settings));
  }
}

TEST(Lidr, ImagesOfAnySize) {
  const Scene scene = awkward_lights();
  for (const glm::ivec2 size : {glm::ivec2(1, 1), glm::ivec2(17, 9), glm::ivec2(1279, 721)}) {
    SCOPED_TRACE(size.x);
    const View view = small_view(size.x, size.y);
    expect_within_limit(scene, view, lidr_settings(LidrPacking::bitshift, 16), 16, render(scene, view, "forward"));
  }
}

// Fifteen lights, all of which a pixel has room for.
Scene random_scene(Random& random) {
  SmallScene s = small_scene(false);
  for (int i = 0; i < 15; ++i) {
    const double radius = std::exp(random.uniform(-5, 5));
    const glm::dvec3 toward = glm::normalize(glm::dvec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)));
    // Near the wall, at its distance from a point of it, or about the eye.
    const glm::dvec3 on_wall(random.uniform(-2, 2), random.uniform(-2, 2), -4);
    const double away = random.uniform() < 0.5 ? radius * (1 - std::exp(random.uniform(-14, 0))) : radius * random.uniform();
    const glm::dvec3 place = (random.uniform() < 0.2 ? glm::dvec3(0) : on_wall) + toward * away;
    if (random.uniform() < 0.5) {
      add_point(s.scene, "lamp", place, {1, 1, 1}, 1, float(radius));
    } else {
      const double outer = std::exp(random.uniform(-3, 5));
      add_spot(s.scene, "torch", place, place - toward, {1, 1, 1}, 1, float(radius), 0, std::min(outer, 179.0));
    }
  }
  return s.scene;
}

View random_view(Random& random) {
  Camera camera = look_at({random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-3.9f, 2)},
                          {random.uniform(-1, 1), random.uniform(-1, 1), -4});
  camera.near_m = std::exp(random.uniform(-7, -2));
  camera.fov_y_rad = random.uniform(0.02f, 2.6f);
  if (random.uniform() < 0.3) camera.far_m = random.uniform(3, 8);
  if (random.uniform() < 0.2) {
    camera.orthographic = true, camera.half_width_m = camera.half_height_m = random.uniform(0.1f, 3);
    camera.near_m = -random.uniform(0, 5), camera.far_m = 10;
  }
  return make_view(camera, int(random.uniform(8, 160)), int(random.uniform(8, 100)));
}

// Where a pixel has room left, nothing that reaches it is missing: on scenes whose volumes lie about surfaces in every way.
TEST(Lidr, LosesNothingWhereThereIsRoom) {
  for (const char* name : {"hall", "spheres", "terrain", "street"}) {
    SCOPED_TRACE(name);
    const Scene scene = find_builtin_scene(name)->make();
    const Pairs p = pairs_of(scene, default_view(scene, 160, 90), {});
    size_t with_room = 0;
    for (size_t i = 0; i < p.pairs.lost_of_pixel.size(); ++i) {
      if (p.pairs.listed_of_pixel[i] == p.most_listed) continue;
      ++with_room;
      ASSERT_EQ(p.pairs.lost_of_pixel[i], 0u) << "pixel " << i;
    }
    EXPECT_GT(with_room, 1000u);
    EXPECT_EQ(p.pairs.wrong, 0u);
    EXPECT_LT(double(p.pairs.listed), 1.5 * double(p.pairs.lit)) << "volumes are close to what they stand for";
  }
}

int trials_wished(int by_default) {
  const char* wish = std::getenv("LIGHTGRID_TRIALS");
  return wish ? std::atoi(wish) : by_default;
}

// Lights of all sizes about surfaces at all angles, cameras and planes of all kinds.
TEST(Lidr, LosesNothingOfRandomLightsInRandomViews) {
  const int trials = trials_wished(60);
  uint64_t lit = 0;
  for (int trial = 0; trial < trials; ++trial) {
    Random random(1000 + uint64_t(trial));
    const Scene scene = random_scene(random);
    const View view = random_view(random);
    for (const LidrVolumes volumes : {LidrVolumes::stencil, LidrVolumes::front_faces}) {
      Settings settings = lidr_settings(LidrPacking::bitshift, 16, 255, volumes);
      settings.volume_mesh = VolumeMeshes(trial % 3);
      const Pairs p = pairs_of(scene, view, settings);
      ASSERT_LE(p.most_listed, 16u);
      ASSERT_EQ(p.pairs.lost, 0u) << "trial " << trial << " volumes " << int(volumes);
      ASSERT_EQ(p.pairs.wrong, 0u) << "trial " << trial << " volumes " << int(volumes);
      lit += p.pairs.lit;
    }
  }
  EXPECT_GT(lit, uint64_t(trials) * 1000);
}

// Fifteen lights that reach a pixel's surface by a part in 10^5 to 10^7 of their radius, just where a face of their mesh touches
// the ball.
Scene lights_tangent_to_faces(Random& random, const View& view, const LightMesh& mesh, const std::vector<float>& depth) {
  SmallScene s = small_scene(false);
  const std::vector<uint32_t> pixels = covered_pixels(depth);
  for (int i = 0; i < 15 && !pixels.empty(); ++i) {
    const uint32_t pixel = pixels[random.next() % pixels.size()];
    const glm::dvec3 p = position_from_depth(view, int(pixel) % view.width, int(pixel) / view.width, depth[pixel]);
    const size_t face = random.next() % (mesh.indices.size() / 3) * 3;
    const glm::dvec3 a = mesh.positions[mesh.indices[face]], b = mesh.positions[mesh.indices[face + 1]], c = mesh.positions[mesh.indices[face + 2]];
    const glm::dvec3 normal = glm::normalize(glm::cross(b - a, c - a));
    const float radius = std::exp(random.uniform(-5, 4));
    const glm::dvec3 in_view = p - normal * (double(radius) * (1 - std::exp(random.uniform(-16, -11))));
    add_point(s.scene, "lamp", {0, 0, 0}, {1, 1, 1}, 1, radius);
    s.scene.lights.back().position = glm::transpose(glm::dmat3(view.view_from_world)) * in_view + view.eye;
  }
  return s.scene;
}

// What lights, matrices, corners and depth round must stay within the volumes' slack: without it, some of these are lost.
TEST(Lidr, LosesNothingOfLightsTangentToTheirMeshes) {
  const int trials = trials_wished(30);
  for (int trial = 0; trial < trials; ++trial) {
    Random random(5000 + uint64_t(trial));
    const View view = random_view(random);
    const Scene dark = small_scene(false).scene;
    TechniqueRun empty(test_devices(), dark, view, {}, find_technique("forward"));
    empty.run_frame();
    const VolumeMeshes meshes = trial % 2 ? VolumeMeshes::icosahedron : VolumeMeshes::box;
    const Scene scene = lights_tangent_to_faces(random, view, meshes == VolumeMeshes::box ? box_mesh() : ball_mesh(0), read_depth(empty.frame()));
    for (const LidrVolumes volumes : {LidrVolumes::stencil, LidrVolumes::front_faces}) {
      Settings settings = lidr_settings(LidrPacking::bitshift, 16, 255, volumes);
      settings.volume_mesh = meshes;
      const Pairs p = pairs_of(scene, view, settings);
      ASSERT_EQ(p.pairs.lost, 0u) << "trial " << trial << " volumes " << int(volumes);
      ASSERT_EQ(p.pairs.wrong, 0u) << "trial " << trial << " volumes " << int(volumes);
    }
  }
}

TEST(Lidr, EveryFrameIsTheSameAndMakesNothingNew) {
  const Scene scene = awkward_lights();
  for (const LidrPacking packing : {LidrPacking::bitshift, LidrPacking::sort}) {
    TechniqueRun run(test_devices(), scene, small_view(64, 48), lidr_settings(packing), find_technique("lidr"));
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
  TechniqueRun run(test_devices(), scene, view, lidr_settings(LidrPacking::bitshift, 16), find_technique("lidr"));
  TechniqueRun forward(test_devices(), scene, view, {}, find_technique("forward"));
  run.run_frame(), forward.run_frame();
  const size_t pixels = 640 * 360;
  const size_t images = pixels * 16, stencil = pixels, meshes = 10'962, volumes = 255 * 68;
  EXPECT_EQ(run.result().memory_light_grid, images);
  EXPECT_EQ(run.result().memory_total, forward.result().memory_total + images + stencil + meshes + volumes);
}

}  // namespace
}  // namespace lightgrid
