// The setting samples-masks: masks that are cut at samples, as triangles are.
#include <gtest/gtest.h>

#include "base/error.h"
#include "plan/settings/samples.h"
#include "support/fine_truth.h"
#include "support/small_scene.h"
#include "techniques/rendering.h"

namespace lightgrid {
using namespace lab;
namespace {

Image drawn(const Scene& scene, const char* technique, int samples, const char* masks) {
  Settings settings;
  settings.set(setting::samples, samples);
  apply_setting(settings, std::string("samples-masks=") + masks);
  return render(scene, small_view(67, 41), technique, settings);
}

int add_unlit(Scene& scene, const char* name, glm::vec3 color) {
  const int material = add_material(scene, name, color, 0, 1);
  scene.materials[size_t(material)].unlit = true;
  scene.materials[size_t(material)].double_sided = true;
  return material;
}

// A red pane over the whole view, whose mask shows one side of a slanted line; and behind it a green triangle
// that covers that side, its edge on the same line of the screen. Lamps, so that techniques take all their
// steps.
Scene cut_pane() {
  Scene scene = small_scene().scene;
  scene.instances.clear();
  scene.background = {0, 0, 1};
  const int red = add_unlit(scene, "red", {1, 0, 0}), green = add_unlit(scene, "green", {0, 1, 0});
  scene.materials[size_t(red)].alpha_mode = AlphaMode::mask;
  scene.materials[size_t(red)].alpha_cutoff = 0.5f;
  const glm::vec3 across = glm::normalize(glm::vec3(0.86f, -0.41f, 0)), along(-across.y, across.x, 0),
                  away(0.013f, 0.021f, -2);
  Mesh pane;
  shapes::add_quad(pane, {-3, -2, -2}, {6, 0, 0}, {0, 4, 0}, 1, 1);
  for (const glm::vec3& p : pane.positions)
    pane.colors.emplace_back(1, 1, 1, 0.5f + 0.125f * glm::dot(p - away, across));
  Mesh behind;
  behind.positions = {away + 8.f * along, away - 8.f * along, away + 8.f * across};
  for (glm::vec3& p : behind.positions) p *= 1.01f;  // seen from the eye, at the same place
  behind.normals.assign(3, {0, 0, 1});
  behind.indices = {0, 1, 2};
  add_instance(scene, "pane", add_mesh(scene, shapes::finished(std::move(pane), "pane", red)));
  add_instance(scene, "behind", add_mesh(scene, shapes::finished(std::move(behind), "behind", green)));
  return scene;
}

struct Colors {
  int green = 0, mixed = 0;  // pixels that show some green; red and blue
};
Colors colors_of(const Image& image) {
  Colors c;
  for (const glm::vec4& p : image.pixels) {
    c.green += p.g > 0.01f;
    c.mixed += p.r > 0.01f && p.b > 0.01f;
  }
  return c;
}

class SampleMasksAsTriangles : public testing::TestWithParam<const char*> {};

// Green shows where the mask hides a sample that the triangle's edge lets in.
TEST_P(SampleMasksAsTriangles, CutTheSamplesThatATriangleCuts) {
  const Scene scene = cut_pane();
  for (const int samples : {2, 4, 8}) {
    try {
      const Colors of_centres = colors_of(drawn(scene, GetParam(), samples, "centre"));
      EXPECT_GT(of_centres.green, 8) << samples;
      for (const char* masks : {"samples", "coverage"}) {
        const Colors c = colors_of(drawn(scene, GetParam(), samples, masks));
        // Corners are snapped to 1/256 pixel.
        EXPECT_LE(c.green, 1) << samples << " " << masks;
        EXPECT_GT(c.mixed, 20) << samples << " " << masks;
      }
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::machine) throw;  // OpenGL may have other numbers
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Techniques, SampleMasksAsTriangles,
                         testing::Values("visibility", "forward", "forward_plus", "deferred",
                                         "deferred_tiled", "light_prepass", "lidr"),
                         [](const auto& info) { return std::string(info.param); });

// Holes of some pixels, and of a part of one.
TEST(SampleMasks, HaveLessErrorAtTheirEdges) {
  for (const float repeats : {1.f, 2.5f}) {
    SmallScene s = small_scene(false);
    effect("directional").add(s);
    effect("mask").add(s);
    for (glm::vec2& uv : s.scene.meshes[size_t(s.wall)].uv0) uv *= repeats;
    for (Material& m : s.scene.materials) {
      m.metallic = 0;
      m.roughness = 1;
    }
    const FineTruth truth(test_devices(), s.scene, small_view(FineTruth::side * 67, FineTruth::side * 41));
    const auto error = [&](int samples, const char* masks) {
      return truth.error(drawn(s.scene, "visibility", samples, masks), true);
    };
    const double centre = error(4, "centre"), at_samples = error(4, "samples");
    EXPECT_LT(at_samples, 0.7 * centre) << repeats;
    EXPECT_LT(error(8, "samples"), 0.7 * at_samples) << repeats;
    // A slope says where an edge lies, of which a pixel has one.
    EXPECT_LT(error(4, "coverage"), (repeats == 1 ? 0.6 : 0.95) * centre) << repeats;
  }
}

TEST(SampleMasks, ChangeNothingWithoutAMaskInView) {
  const Scene scene = small_scene().scene;
  const Image centre = drawn(scene, "visibility", 4, "centre");
  EXPECT_TRUE(identical(drawn(scene, "visibility", 4, "samples"), centre));
  for (const bool mask : {false, true}) {
    SmallScene s = small_scene();
    if (mask) effect("mask").add(s);
    Settings settings;
    settings.set(setting::samples, 4);
    settings.set(setting::samples_masks, SampleMasks::samples);
    const FramePlan plan = plan_frame(s.scene, small_view(67, 41), settings, {});
    const auto decision = std::ranges::find(plan.decisions, "masks of samples", &Decision::effect);
    ASSERT_NE(decision, plan.decisions.end());
    EXPECT_EQ(decision->needed, mask);
    EXPECT_EQ(decision->why,
              mask ? "material 0 \"plaster\" on node 0 \"wall\"" : "no masked material in view");
  }
}

}  // namespace
}  // namespace lightgrid
