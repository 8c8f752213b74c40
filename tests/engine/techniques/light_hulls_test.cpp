// Light hulls: a wall lit in a box by hand, and every technique's picture with hulls of many shapes.
#include <cmath>

#include "accuracy/oracle_sample.h"
#include "plan/settings/model.h"
#include "plan/settings/surfaces.h"
#include "scene/property_rows.h"
#include "scene/random.h"
#include "support/error_of.h"
#include "support/small_scene.h"
#include "techniques/rendering.h"

namespace lightgrid {
namespace {

void set_hull(Scene& scene, int light, const std::string& planes) {
  apply_properties(scene, {.lights = {{light, "test", given_fields({{"hull", planes}}, "test", false)}},
                           .instances = {},
                           .open = {}});
}

// 0.4 x 0.2 x 2 m around a lamp 0.5 m in front of the wall at z = -4.
constexpr const char* box = "1 0 0 0.4, -1 0 0 0.4, 0 2 0 0.4, 0 -1 0 0.2, 0 0 1 2, 0 0 -1 2";
constexpr glm::dvec3 box_lamp{0.3, 0.1, -3.5};

Scene lamp_in_a_box() {
  SmallScene s = small_scene(false);
  add_point(s.scene, "lamp", glm::vec3(box_lamp), {1, 0.7f, 0.4f}, 2, 3);
  return s.scene;
}

glm::dvec3 on_wall(const View& view, int x, int y) {
  const glm::dvec2 ndc((x + 0.5) * 2 / view.width - 1, (y + 0.5) * 2 / view.height - 1);
  return 4.0 * glm::dvec3(ndc.x / view.clip_from_view[0][0], ndc.y / view.clip_from_view[1][1], -1);
}

TEST(LightHulls, LightWhatLiesInsideThem) {
  Scene scene = lamp_in_a_box();
  std::erase_if(scene.instances, [](const Instance& i) { return i.name != "wall"; });
  const View view = small_view(96, 64);
  const Image open = render(scene, view, "forward"), dark = [&] {
    Scene unlit = scene;
    unlit.lights.clear();
    return render(unlit, view, "forward");
  }();
  set_hull(scene, 0, box);
  const Image drawn = render(scene, view, "forward");
  int inside = 0, outside = 0;
  for (int y = 0; y < view.height; ++y) {
    for (int x = 0; x < view.width; ++x) {
      const glm::dvec3 from_lamp = glm::abs(on_wall(view, x, y) - box_lamp);
      const double depth = std::min(0.4 - from_lamp.x, 0.2 - from_lamp.y);
      if (depth > 0.011) {
        EXPECT_LT(glm::length(drawn.at(x, y) - open.at(x, y)), 1e-5) << x << ' ' << y;
        ++inside;
      } else if (depth < -0.001) {
        EXPECT_LT(glm::length(drawn.at(x, y) - dark.at(x, y)), 1e-6) << x << ' ' << y;
        ++outside;
      }
    }
  }
  EXPECT_GT(inside, 50);
  EXPECT_GT(outside, 1000);
}

// Boxes, wedges with fewer planes, and shapes that the lamp is outside of.
Scene hulls_of_all_kinds() {
  SmallScene s = small_scene(false);
  effect("blend").add(s);
  Random random(5);
  for (int i = 0; i < 14; ++i) {
    const glm::vec3 at{random.uniform(-2, 2), random.uniform(-1.5f, 1.5f), random.uniform(-3.9f, -2)};
    if (i % 4 == 3)
      add_spot(s.scene, "torch", at, at + glm::vec3(0, 0, -1), {1, 1, 1}, 0.5f, 2, 5, 70);
    else
      add_point(s.scene, "lamp", at, {1, random.uniform(0, 1), 0.5f}, 0.5f, 2);
    std::string planes;
    for (int k = 0; k < i % 9; ++k)
      planes += fmt::format("{}{} {} {} {}", k ? "," : "", random.uniform(-1, 1), random.uniform(-1, 1),
                            random.uniform(-1, 1), random.uniform(k % 3 ? 0.1f : -0.2f, 0.8f));
    set_hull(s.scene, int(s.scene.lights.size()) - 1, planes);
  }
  effect("directional").add(s);
  return s.scene;
}

TEST(LightHulls, AreTheSameInEveryTechnique) {
  const Scene scene = hulls_of_all_kinds();
  const View view = small_view(63, 37);
  const Image forward = render(scene, view, "forward");
  ASSERT_GT(brightest_channel(forward), 0.01f);
  for (const Technique* technique : techniques()) {
    if (technique->approximate) continue;
    SCOPED_TRACE(technique->name);
    expect_close(scene, view, {}, forward, technique->name, 1e-4);
  }
  Settings lambert{{setting::brdf, Brdf::lambert}};
  expect_close(scene, view, lambert, render(scene, view, "forward", lambert), "light_prepass", 1e-4);
}

TEST(LightHulls, AreTheOracles) {
  const Scene scene = hulls_of_all_kinds();
  TechniqueRun run(test_devices(), scene, small_view(63, 37), {}, find_technique("forward"));
  run.run_frame();
  const SurfaceOracle oracle(run.view(), read_depth(run));
  const Image image = run.image();
  ASSERT_GT(oracle.pixels().size(), 500u);
  EXPECT_LT(oracle_error(image, image, oracle.pixels(), oracle.shade(oracle.pixels(), true)).max_rel, 1e-4);
}

TEST(LightHulls, AreNotInPlansOfOtherScenes) {
  const Scene scene = lamp_in_a_box();
  Scene empty = scene;
  set_hull(empty, 0, "");
  const FramePlan plan = plan_frame(empty, small_view(9, 5), {}, find_technique("forward").needs);
  EXPECT_TRUE(plan.effects.empty());
}

TEST(LightHulls, WithWrongPlanesAreRefusedWithTheLightsName) {
  for (const char* wrong : {"1 0 0", "1 0 0 1 2", "0 0 0 1", "a b c d", "nan 0 0 1",
                            "1 0 0 1,1 0 0 1,1 0 0 1,1 0 0 1,1 0 0 1,1 0 0 1,1 0 0 1,1 0 0 1,1 0 0 1"}) {
    Scene scene = lamp_in_a_box();
    set_hull(scene, 0, wrong);
    EXPECT_THAT(error_of([&] { render(scene, small_view(9, 5), "forward"); }),
                testing::AllOf(testing::HasSubstr("light \"lamp\": hull"), testing::HasSubstr("8 planes")))
        << wrong;
  }
}

}  // namespace
}  // namespace lightgrid
