// Exact shadows together with several samples a pixel (docs/samples.md#shadows).
#include <gmock/gmock.h>

#include "base/error.h"
#include "plan/settings/samples.h"
#include "plan/settings/shadows.h"
#include "support/small_scene.h"
#include "techniques/rendering.h"

namespace lightgrid {
namespace {

using testing::HasSubstr;

class ShadowedSamples : public testing::TestWithParam<int> {
 protected:
  ShadowedSamples() {
    for (const char* name : {"blend", "mask", "spot", "directional"}) effect(name).add(s_);
    for (Light& light : s_.scene.lights) light.casts_shadow = &light != &s_.scene.lights[2];
  }
  Image draw(const Scene& scene, const std::string& more = "", const char* technique = "visibility",
             size_t shadow_memory = 0) const {
    Settings settings;
    settings.set(setting::samples, GetParam());
    if (shadow_memory > 0) settings.set(setting::shadow_memory, shadow_memory);
    for (size_t begin = 0; begin < more.size();) {
      const size_t end = std::min(more.find(' ', begin), more.size());
      apply_setting(settings, more.substr(begin, end - begin));
      begin = end + 1;
    }
    return render(scene, small_view(67, 41), technique, settings);
  }
  SmallScene s_ = small_scene_of_casters();
};

TEST_P(ShadowedSamples, HaveTheSameBytesInEveryShapeTileListAndWayToKeepShadows) {
  const Image image = draw(s_.scene);
  EXPECT_FALSE(same_bytes(image, draw(s_.scene, "shadows=none")));
  for (const char* more :
       {"kernel-shape=group", "portable=on", "lights=all", "tile=8", "slices=8 z-bins=16", "shadow-reuse=on"})
    EXPECT_TRUE(identical(draw(s_.scene, more), image)) << more;
  EXPECT_TRUE(identical(draw(s_.scene, "", "visibility", 1200), image)) << "in bands";
  EXPECT_TRUE(identical(draw(s_.scene, "raster=opencl", "world_grid"), image));
}

TEST_P(ShadowedSamples, HaveTheSameBytesBelowBlendedCasters) {
  add_pane_before_wall(s_, 0.5f);
  const Image none = draw(s_.scene);
  for (const char* more : {"shadow-blended=opaque", "shadow-blended=alpha"}) {
    const Image image = draw(s_.scene, more);
    EXPECT_FALSE(same_bytes(image, none)) << more;
    EXPECT_TRUE(identical(draw(s_.scene, std::string(more) + " kernel-shape=group"), image)) << more;
  }
}

// Where nothing casts, nothing may be hidden: not by surfaces' own triangles, and not from lights whose
// shadows the plan leaves out.
TEST_P(ShadowedSamples, AreThoseWithoutShadowsWhereNoInstanceCasts) {
  const Image shadowed = draw(s_.scene);
  for (Instance& i : s_.scene.instances) i.casts_shadow = false;
  const Image image = draw(s_.scene);
  EXPECT_FALSE(same_bytes(image, shadowed));
  EXPECT_TRUE(identical(draw(s_.scene, "everything-on=on"), image));
}

// Cards hide a lamp and the sun, which cast nothing, from edges of other cards and of the wall. An ember
// casts, too dim to be seen.
TEST_P(ShadowedSamples, HideNoLightThatCastsNone) {
  s_ = small_scene(false);
  effect("directional").add(s_);
  for (int i = 0; i < 49; ++i)
    add_instance(s_.scene, "card",
                 add_mesh(s_.scene, wall_mesh({0.4f * float(i % 7) - 1.2f, 0.4f * float(i / 7) - 1.2f, -3.6f},
                                              0.1f, s_.wall_material, "card")));
  add_point(s_.scene, "lamp", {0.3f, 0.2f, -3.2f}, {1, 1, 1}, 5, 9);
  add_point(s_.scene, "ember", {0, 0, -1}, {1, 1, 1}, 1e-9f, 9).casts_shadow = true;
  const Image image = draw(s_.scene);
  Scene casting = s_.scene;
  for (Light& light : casting.lights) light.casts_shadow = true;
  EXPECT_GT(compare_images(draw(casting), image).max_rel, 1e-2);
  for (Instance& i : s_.scene.instances) i.casts_shadow = false;
  EXPECT_LT(compare_images(image, draw(s_.scene)).max_rel, 1e-6);
}

// A trough of smooth facets that a lamp lights from its focus: no facet hides another. Most pixels see
// several.
Scene trough(bool casts) {
  Scene scene;
  const int material = add_material(scene, "plaster", {0.8f, 0.8f, 0.8f}, 0, 1);
  Mesh mesh;
  constexpr int facets = 48;
  for (int i = 0; i <= facets; ++i) {
    const float angle = 3.14159265f * float(i) / float(facets);
    for (const float z : {-3.0f, -9.0f}) {
      mesh.positions.emplace_back(std::cos(angle), -std::sin(angle), z);
      mesh.normals.emplace_back(-std::cos(angle), std::sin(angle), 0);
      mesh.uv0.emplace_back(0, 0);
    }
  }
  for (uint32_t i = 0; i < 2 * facets; i += 2)
    for (const uint32_t k : {0u, 1u, 2u, 2u, 1u, 3u}) mesh.indices.push_back(i + k);
  scene.materials[size_t(material)].double_sided = true;
  add_instance(scene, "trough", add_mesh(scene, shapes::finished(std::move(mesh), "trough", material)));
  scene.instances[0].casts_shadow = casts;
  add_point(scene, "lamp", {0.2f, 0.05f, -6}, {1, 1, 1}, 5, 9);
  scene.lights[0].casts_shadow = true;
  return scene;
}

TEST_P(ShadowedSamples, HideNoHollowFromALampThatSeesAllOfIt) {
  Settings settings;
  settings.set(setting::samples, GetParam());
  const View view = make_view(look_at({0, 1.5, 0}, {0, -0.6, -6}), 160, 90);
  const Image lit = render(trough(false), view, "visibility", settings);
  EXPECT_GT(brightest_channel(lit), 0.1);
  EXPECT_TRUE(identical(render(trough(true), view, "visibility", settings), lit));
}

INSTANTIATE_TEST_SUITE_P(Samples, ShadowedSamples, testing::Values(2, 4, 8));

TEST(ShadowedSamplesRefused, ByNameWhereShadowsAreFoundForOneSample) {
  const SmallScene s = small_scene_of_casters();
  const auto refusal = [&](const char* technique, std::initializer_list<const char*> chosen) -> std::string {
    Settings settings;
    settings.set(setting::samples, 4);
    for (const char* each : chosen) apply_setting(settings, each);
    try {
      render(s.scene, small_view(17, 9), technique, settings);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input) << error.what();
      return error.what();
    }
    return "none";
  };
  const char* visibility = "visibility";
  EXPECT_THAT(refusal(visibility, {"shadows=map"}), HasSubstr("samples=4: light 0 \"lamp\""));
  EXPECT_THAT(refusal(visibility, {"shadows=map"}), HasSubstr("shadow maps"));
  EXPECT_THAT(refusal(visibility, {"shadow-rays=4"}), HasSubstr("shadow-rays"));
  EXPECT_THAT(refusal(visibility, {"shadow-pick=1"}), HasSubstr("shadow-pick"));
  EXPECT_THAT(refusal("world_grid", {"raster=opencl", "shadow-pick=1"}), HasSubstr("shadow-pick"));
  EXPECT_THAT(refusal("deferred_tiled", {"raster=opencl"}), HasSubstr("shadows of stored surfaces"));
  EXPECT_THAT(refusal("forward", {}), HasSubstr("shadows where OpenGL draws"));
  EXPECT_THAT(refusal("lidr", {"lidr-shadows=prepass"}), HasSubstr("shadows where OpenGL draws"));
  EXPECT_EQ(refusal(visibility, {}), "none");
  EXPECT_EQ(refusal("voxel_lights", {"raster=opencl"}), "none");
}

}  // namespace
}  // namespace lightgrid
