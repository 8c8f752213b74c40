// Area lights in techniques: pictures against the oracle, lists, and the same bytes from all kernels.
#include "scene/area_lights.h"

#include <gmock/gmock.h>

#include "accuracy/oracle_sample.h"
#include "effects/effects.h"
#include "scene/light_axes.h"
#include "scene/random.h"
#include "support/small_scene.h"
#include "techniques/rendering.h"

namespace lightgrid {
using namespace lab;
namespace {

// Panels of many sizes in front of a wall and a metal ball, some with ranges that end on themselves.
Scene panels(int count, uint64_t seed = 3) {
  Random random(seed);
  SmallScene s = small_scene(false);
  for (int i = 0; i < count; ++i) {
    const glm::vec3 at(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-3.8f, -1));
    const glm::vec3 to =
        at + glm::vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 0.5f));
    const double size = std::exp2(random.uniform(-4, 1));
    const float range = i % 5 == 0 ? float(size) / 2 : random.uniform(0.5f, 4);
    add_spot(s.scene, "panel", at, to, {1, 0.8f, 0.6f}, std::exp2(random.uniform(-2, 1)), range, 10, 25);
    set_up(s.scene.lights.back(), {random.uniform(-1, 1), 1, 0});
    set_rectangle(s.scene.lights.back(), size, size * random.uniform(0.1f, 1));
  }
  return s.scene;
}

struct AreaLobe {
  const char *name, *settings;
  double largest_rmse_rel;
};

struct AreaLights : testing::TestWithParam<AreaLobe> {};

// The error of 16 points is left. They crowd as GGX's lobe requires, and a power of a cosine ends sooner: Blinn's lobe
// has three times the error (a seventh of it with 64 points).
TEST_P(AreaLights, AreTheOraclesWithinTheErrorOfTheirPoints) {
  const Scene scene = panels(12);
  const View view = small_view(64, 40);
  TechniqueRun run(test_devices(), scene, view, assigned(GetParam().settings), find_technique("forward"));
  run.run_frame();
  const ReferenceErrors errors = measure_reference_errors(run.view(), run.image(), read_depth(run), 1500);
  fmt::print("{}: rmse_rel {:.2e}, max_rel {:.2e}\n", GetParam().name, errors.precision.rmse_rel,
             errors.precision.max_rel);
  EXPECT_LT(errors.precision.rmse_rel, GetParam().largest_rmse_rel);
  EXPECT_EQ(count_nan_pixels(run.image()), 0u);
}

INSTANTIATE_TEST_SUITE_P(Lobes, AreaLights,
                         testing::Values(AreaLobe{"ggx", "brdf=ggx", 2e-3},
                                         AreaLobe{"blinn", "brdf=blinn", 3e-3},
                                         AreaLobe{"lambert", "brdf=lambert", 2e-3}),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(AreaLights, FewerPointsAreLessExact) {
  const Scene scene = panels(12);
  const View view = small_view(64, 40);
  const Image all = render(scene, view, "visibility");
  double before = 0;
  for (const char* points : {"area-points=9", "area-points=4", "area-points=1"}) {
    const double error = compare_images(render(scene, view, "visibility", assigned(points)), all).rmse;
    EXPECT_GT(error, before) << points;
    before = error;
  }
}

TEST(AreaLights, NoListLosesOne) {
  const Scene scene = panels(40);
  const View view = small_view(127, 73);
  for (const char* technique : {"forward_plus", "clustered", "deferred_tiled", "visibility", "world_grid"}) {
    SCOPED_TRACE(technique);
    TechniqueRun run(test_devices(), scene, view, {}, find_technique(technique));
    run.run_frame();
    const LitPairs pairs = count_listed_pairs(run, read_depth(run));
    EXPECT_GT(pairs.lit, 1000u);
    EXPECT_EQ(pairs.lost, 0u);
    EXPECT_EQ(pairs.wrong, 0u);
  }
}

TEST(AreaLights, LightNothingBehindTheirPlane) {
  SmallScene s = small_scene();
  const View view = small_view(47, 31);
  const Scene without = s.scene;
  add_spot(s.scene, "panel", {0.2f, 0, -2}, {0.2f, 0, 0}, {1, 1, 1}, 100, 20, 10, 25);
  set_rectangle(s.scene.lights.back(), 3, 3);
  for (const char* technique : {"forward", "visibility", "deferred"})
    EXPECT_TRUE(identical(render(s.scene, view, technique), render(without, view, technique))) << technique;
}

// A rectangle of no area is a spot: the effect is not planned.
TEST(AreaLights, WithoutAnAreaAreSpots) {
  SmallScene s = small_scene();
  add_spot(s.scene, "panel", {-0.8f, 0.9f, -2.6f}, {0.3f, -0.2f, -4}, {1, 1, 1}, 3, 4, 10, 25);
  set_rectangle(s.scene.lights.back(), 1, 0);
  const View view = small_view(47, 31);
  Light& light = s.scene.lights.back();
  const auto planned = [&] {
    TechniqueRun run(test_devices(), s.scene, view, {}, find_technique("visibility"));
    return std::ranges::count(run.view().plan.effects, std::string("area_lights"),
                              [](const Effect* e) { return std::string(e->name); });
  };
  EXPECT_FALSE(has_rectangle(light));
  EXPECT_EQ(planned(), 0);
  set_rectangle(light, 1, 0.5);
  EXPECT_EQ(planned(), 1);
  light.type = LightType::point;
  EXPECT_EQ(planned(), 0);
}

// Point lights next to it keep their bits: the effect is a branch per light.
TEST(AreaLights, LeaveOtherLightsAlone) {
  SmallScene s = small_scene();
  const View view = small_view(47, 31);
  const Image plain = render(s.scene, view, "visibility");
  // Out of every surface's reach.
  add_spot(s.scene, "panel", {0, 0, 50}, {0, 0, 60}, {1, 1, 1}, 1, 1, 10, 25);
  set_rectangle(s.scene.lights.back(), 1, 1);
  EXPECT_TRUE(identical(render(s.scene, view, "visibility"), plain));
}

}  // namespace
}  // namespace lightgrid
