// The setting samples: which techniques take it, and the pictures of those that do.
#include <fmt/ranges.h>
#include <gmock/gmock.h>

#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

#include "base/error.h"
#include "plan/settings/samples.h"
#include "support/error_of.h"
#include "support/fine_truth.h"
#include "support/small_scene.h"
#include "techniques/rendering.h"

namespace lightgrid {
using namespace lab;
namespace {

using testing::HasSubstr;

TEST(Samples, AreTakenByTechniquesThatDeclareThemAndRefusedByOthersByName) {
  const SmallScene s = small_scene();
  GpuScene gpu(test_devices(), s.scene);
  for (const Technique* technique : techniques()) {
    const bool declared = reads_setting(*technique, "samples");
    Settings settings;
    apply_setting(settings, "samples=8");
    EXPECT_LE(max_samples(*technique, settings), declared ? 8 : 1) << technique->name;
    if (declared) continue;
    const std::string message =
        error_of([&] { TechniqueRun run(test_devices(), gpu, small_view(17, 9), settings, *technique); });
    EXPECT_THAT(message, HasSubstr("samples=8")) << technique->name;
    EXPECT_THAT(message, HasSubstr(technique->name));
  }
}

// The picture of the setting, and of one sample where the technique cannot take them.
TEST(Samples, AreDrawnWhereTheSceneAsksForThem) {
  SmallScene plain = small_scene(), asks = small_scene();
  effect("blend").add(plain);
  effect("blend").add(asks);
  asks.scene.samples = 4;
  const View view = small_view(33, 17);
  for (const Technique* technique : techniques()) {
    Settings four;
    apply_setting(four, "samples=4");
    const Image drawn = render(asks.scene, view, technique->name, {});
    EXPECT_TRUE(identical(drawn, render(plain.scene, view, technique->name, four))) << technique->name;
    Settings one;
    apply_setting(one, "samples=1");
    EXPECT_FALSE(same_bytes(drawn, render(asks.scene, view, technique->name, one))) << technique->name;
    EXPECT_TRUE(identical(render(asks.scene, view, technique->name, one),
                          render(plain.scene, view, technique->name, {})))
        << technique->name;
  }
  Settings opencl;
  apply_setting(opencl, "raster=opencl");
  const Image of_opencl = render(asks.scene, view, "deferred_tiled", opencl);
  EXPECT_FALSE(same_bytes(of_opencl, render(plain.scene, view, "deferred_tiled", opencl)));
  apply_setting(opencl, "samples=4");
  EXPECT_TRUE(identical(of_opencl, render(plain.scene, view, "deferred_tiled", opencl)));
  Settings weighted;
  apply_setting(weighted, "samples-resolve=weighted");
  EXPECT_TRUE(identical(render(asks.scene, view, "deferred_tiled", weighted),
                        render(plain.scene, view, "deferred_tiled", {})));
}

FineTruth truth_of(const Scene& scene, int width, int height) {
  return {test_devices(), scene, small_view(FineTruth::side * width, FineTruth::side * height)};
}

class SamplesOfVisibility : public testing::Test {
 protected:
  SamplesOfVisibility() {
    for (const char* name : {"blend", "mask", "spot", "directional"}) effect(name).add(s_);
  }
  Image draw(const std::string& more, int width = 67, int height = 41) const {
    Settings settings;
    for (size_t begin = 0; begin < more.size();) {
      const size_t end = std::min(more.find(' ', begin), more.size());
      apply_setting(settings, more.substr(begin, end - begin));
      begin = end + 1;
    }
    return render(s_.scene, small_view(width, height), "visibility", settings);
  }
  SmallScene s_ = small_scene();
};

TEST_F(SamplesOfVisibility, HaveTheSameBytesInEveryShapeTileAndListOfLights) {
  const Image four = draw("samples=4");
  EXPECT_FALSE(same_bytes(four, draw("samples=1")));
  for (const char* more : {"kernel-shape=group", "lights=all", "tile=8", "slices=8 z-bins=16"})
    EXPECT_TRUE(identical(draw(std::string("samples=4 ") + more), four)) << more;
  for (const char* masks : {"samples=2 samples-masks=samples", "samples=4 samples-masks=samples",
                            "samples=8 samples-masks=coverage"}) {
    const Image image = draw(masks);
    EXPECT_FALSE(same_bytes(image, draw(std::string(masks, 9)))) << masks;
    EXPECT_TRUE(identical(draw(masks + std::string(" kernel-shape=group")), image)) << masks;
  }
}

// The scene's edges are all silhouettes: masks and blended surfaces cover pixels by their centres. Only in
// the sun: a lamp close to the ball lights a spot of less than a pixel, which is no edge and would outweigh
// them.
TEST_F(SamplesOfVisibility, HaveErrorsThatFallAtEdgesAndStayInside) {
  s_ = small_scene(false);
  effect("directional").add(s_);
  for (Material& m : s_.scene.materials) {
    m.metallic = 0;
    m.roughness = 1;
  }
  const FineTruth truth = truth_of(s_.scene, 67, 41);
  std::vector<double> at_edges, inside;
  for (const char* samples : {"samples=1", "samples=2", "samples=4", "samples=8"}) {
    const Image image = draw(samples);
    at_edges.push_back(truth.error(image, true));
    inside.push_back(truth.error(image, false));
    RecordProperty(samples, fmt::format("edges {:.5f}, inside {:.5f}", at_edges.back(), inside.back()));
  }
  // With random places errors would fall by the square root of 2 per step; these places are spread evenly.
  for (size_t i = 1; i < at_edges.size(); ++i) EXPECT_LT(at_edges[i], at_edges[i - 1] / std::sqrt(2.0)) << i;
  const double slope = std::log2(at_edges.back() / at_edges.front()) / 3;
  EXPECT_LT(slope, -0.6) << fmt::format("{}", fmt::join(at_edges, " "));
  // Creases of the ball are inside, and fall a little with the first step.
  for (const double error : inside) {
    EXPECT_LE(error, inside.front());
    EXPECT_GT(error, 0.7 * inside.front());
  }
}

// Light of two surfaces of constant radiance and of the background, at pixels whose shares the linear mean
// tells.
class SamplesResolve : public testing::Test {
 protected:
  SamplesResolve() {
    s_.scene.background = {0.1f, 0.2f, 0.3f};
    Material& m = s_.scene.materials.emplace_back();
    m.unlit = true;
    m.base_color = {20, 6, 1, 1};
    add_instance(s_.scene, "panel", add_mesh(s_.scene, wall_mesh({0.13f, 0.07f, -4}, 1.03f, 0, "panel")));
    s_.scene.instances[0].world_from_object = glm::rotate(glm::dmat4(1), 0.1, {0, 0, 1});
  }
  Image draw(const char* resolve, const char* shape = "lanes", const char* technique = "visibility") const {
    Settings settings;
    settings.set(setting::samples, 4);
    apply_setting(settings, std::string("samples-resolve=") + resolve);
    if (shape == std::string("group")) apply_setting(settings, "kernel-shape=group");
    return render(s_.scene, small_view(41, 29), technique, settings);
  }
  // Calls check(share of the panel, pixel) at pixels of both.
  template <typename Check>
  size_t at_edges(const char* technique, const Check& check) const {
    const Image linear = draw("linear", "lanes", technique);
    size_t edges = 0;
    for (size_t i = 0; i < linear.pixels.size(); ++i) {
      const double share = (double(linear.pixels[i].r) - 0.1) / (20 - 0.1);
      if (share < 0.1 || share > 0.9) continue;
      EXPECT_NEAR(share * 4, std::round(share * 4), 1e-4);
      check(share, i);
      ++edges;
    }
    return edges;
  }
  struct {
    Scene scene;
  } s_;
  const glm::dvec3 panel_{20, 6, 1}, background_{0.1f, 0.2f, 0.3f};
};

TEST_F(SamplesResolve, AfterTheToneMapIsTheMeanOfWhatItShows) {
  for (const char* technique : {"visibility", "forward", "deferred"}) {
    const Image image = draw("tonemapped", "lanes", technique);
    const size_t edges = at_edges(technique, [&](double share, size_t i) {
      const glm::dvec3 expected =
          glm::mix(glm::dvec3(tone_map_neutral(background_)), glm::dvec3(tone_map_neutral(panel_)), share);
      const glm::dvec3 shown(tone_map_neutral(glm::vec3(image.pixels[i])));
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(shown[c], expected[c], 1e-6) << i << ' ' << share;
    });
    EXPECT_GT(edges, 30u) << technique;
  }
}

// The derivative of the tone map's brightest channel, as a difference of grey light, in which all channels
// are alike.
TEST_F(SamplesResolve, WeightedIsTheMeanByTheToneMapsDerivative) {
  const auto weight = [](const glm::dvec3& light) {
    const double least = std::min({light.r, light.g, light.b}), peak = std::max({light.r, light.g, light.b});
    const double off = least < 0.08 ? least - 6.25 * least * least : 0.04;
    const auto shown = [](double x) { return x < 0.76 ? x : 1 - 0.24 * 0.24 / (x + 0.24 - 0.76); };
    return (shown(peak - off + 1e-4) - shown(peak - off - 1e-4)) / 2e-4;
  };
  const double of_panel = weight(panel_), of_background = weight(background_);
  EXPECT_NEAR(of_background, 1, 1e-6);
  EXPECT_LT(of_panel, 1e-3);
  for (const char* technique : {"visibility", "forward", "deferred"}) {
    const Image image = draw("weighted", "lanes", technique);
    const size_t edges = at_edges(technique, [&](double share, size_t i) {
      const double a = share * of_panel, b = (1 - share) * of_background;
      const glm::dvec3 expected = (panel_ * a + background_ * b) / (a + b);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(image.pixels[i][c], expected[c], 1e-5) << i << ' ' << share;
    });
    EXPECT_GT(edges, 30u) << technique;
  }
}

TEST_F(SamplesResolve, HasTheSameBytesInBothShapesAndInside) {
  for (const char* resolve : {"linear", "tonemapped", "weighted"})
    EXPECT_TRUE(identical(draw(resolve, "group"), draw(resolve))) << resolve;
  for (const char* technique : {"visibility", "forward"}) {
    const Image linear = draw("linear", "lanes", technique);
    for (const char* resolve : {"tonemapped", "weighted"}) {
      const Image image = draw(resolve, "lanes", technique);
      for (size_t i = 0; i < image.pixels.size(); ++i) {
        if (linear.pixels[i].r == 20 || linear.pixels[i].r == 0.1f) {
          EXPECT_EQ(image.pixels[i], linear.pixels[i]);
        }
      }
    }
  }
}

TEST(SamplesResolves, IsRefusedWhereTilesAverage) {
  Settings settings;
  apply_setting(settings, "samples=4");
  apply_setting(settings, "samples-resolve=tonemapped");
  for (const char* technique : {"deferred_tiled", "forward_plus_compute"})
    EXPECT_THROW(check_samples(find_technique(technique), settings), Error);
  for (const char* technique : {"visibility", "world_grid", "forward", "lidr"})
    EXPECT_NO_THROW(check_samples(find_technique(technique), settings));
}

// OpenGL's coverage, shaded once a pixel and surface.
class SamplesOfOpenGl : public testing::Test {
 protected:
  void SetUp() override {
    for (const char* name : {"blend", "mask", "spot", "directional"}) effect(name).add(s_);
    try {
      draw("forward", 4);
    } catch (const Error& error) {
      GTEST_SKIP() << error.what();
    }
  }
  Image draw(const char* technique, int samples, const char* shading = "edges", const char* shape = "auto",
             std::initializer_list<const char*> more = {}) const {
    Settings settings;
    settings.set(setting::samples, samples);
    apply_setting(settings, std::string("samples-shading=") + shading);
    apply_setting(settings, std::string("kernel-shape=") + shape);
    for (const char* each : more) apply_setting(settings, each);
    return render(s_.scene, small_view(67, 41), technique, settings);
  }
  SmallScene s_ = small_scene();
};

TEST_F(SamplesOfOpenGl, ShowTheImageOfForwardInEveryTechniqueThatTakesThem) {
  const Image four = draw("forward", 4);
  EXPECT_FALSE(same_bytes(four, draw("forward", 1)));
  for (const char* technique : {"forward_plus", "clustered", "world_grid"})
    EXPECT_TRUE(identical(draw(technique, 4), four)) << technique;
  for (const char* technique : {"forward_multipass", "forward_zprepass"})
    EXPECT_LT(compare_images(draw(technique, 4), four).max_rel, 1e-6) << technique;
}

TEST_F(SamplesOfOpenGl, HaveErrorsThatFallAtEdgesAndStaySmallInside) {
  s_ = small_scene(false);
  effect("directional").add(s_);
  for (Material& m : s_.scene.materials) {
    m.metallic = 0;
    m.roughness = 1;
  }
  const FineTruth truth = truth_of(s_.scene, 67, 41);
  const Image one = draw("forward", 1), four = draw("forward", 4);
  // Random places would halve it.
  EXPECT_LT(truth.error(four, true), truth.error(one, true) / 3);
  // Where two triangles of the ball meet in a pixel each is shaded at a place of its own, which is none of
  // its centre.
  EXPECT_LT(truth.error(four, false), truth.error(four, true) / 10);
  RecordProperty("errors",
                 fmt::format("edges {:.5f} and {:.5f}, inside {:.5f} and {:.5f}", truth.error(one, true),
                             truth.error(four, true), truth.error(one, false), truth.error(four, false)));
}

// Surfaces that are stored for each sample: in GLSL and OpenCL, light by light and from lists.
TEST_F(SamplesOfOpenGl, HaveOneImageInEveryTechniqueThatStoresThem) {
  // Without blended surfaces, which lie over the mean in one, and over each sample in the other.
  s_ = small_scene();
  for (const char* name : {"directional", "spot", "groups"}) effect(name).add(s_);
  const Image volumes = draw("deferred", 4);
  for (const char* technique : {"deferred_tiled", "forward_plus_compute"}) {
    const Image tiles = draw(technique, 4, "all");
    EXPECT_LT(compare_images(tiles, volumes).max_rel, 1e-4) << technique;
    EXPECT_TRUE(identical(draw(technique, 4, "all", "group"), tiles)) << technique;
    const Image edges = draw(technique, 4, "edges");
    EXPECT_TRUE(identical(draw(technique, 4, "edges", "group"), edges)) << technique;
    EXPECT_FALSE(same_bytes(edges, tiles)) << technique;
    EXPECT_LT(compare_images(edges, tiles).rmse_rel, 2e-3) << technique;
    EXPECT_TRUE(identical(draw(technique, 4, "edges", "auto", {"group-tiles=off"}), edges)) << technique;
  }
}

// Sums in another order; and powers, which 16 lanes round otherwise than one.
TEST_F(SamplesOfOpenGl, HaveOneLightBufferByTilesAndByVolumes) {
  for (const char* name : {"directional", "spot", "groups"}) effect(name).add(s_);
  for (const char* specular : {"prepass-specular=plain", "prepass-specular=fifth-term"}) {
    const Image volumes = draw("light_prepass", 4, "edges", "auto", {specular, "prepass-lights=volumes"});
    const Image tiles = draw("light_prepass", 4, "all", "auto", {specular});
    EXPECT_LT(compare_images(tiles, volumes).max_rel, 1e-4) << specular;
    EXPECT_LT(compare_images(draw("light_prepass", 4, "all", "group", {specular}), tiles).max_rel, 1e-7);
    const Image edges = draw("light_prepass", 4, "edges", "auto", {specular});
    EXPECT_LT(compare_images(draw("light_prepass", 4, "edges", "group", {specular}), edges).max_rel, 1e-7);
    EXPECT_FALSE(same_bytes(edges, tiles)) << specular;
    EXPECT_LT(compare_images(edges, tiles).rmse_rel, 2e-3) << specular;
  }
}

// Behind front faces a pixel's lights are those of all its samples, and a surface is shaded once: forward's
// picture, as no pixel here has more lights than slots.
TEST_F(SamplesOfOpenGl, ShowForwardsImageWithIndicesOfWholePixels) {
  effect("spot").add(s_);
  const Image image = draw("lidr", 4, "edges", "auto", {"lidr-volumes=front-faces"});
  EXPECT_LT(compare_images(image, draw("forward", 4)).max_rel, 1e-5);
}

// Passes that draw surfaces again test masks again, and must leave what the first one left. Of one colour a
// surface shows the same wherever it is shaded.
TEST_F(SamplesOfOpenGl, ShowOneMaskInEveryPass) {
  s_ = small_scene();
  effect("mask").add(s_);
  Bitmap& speckles = s_.scene.bitmaps[size_t(s_.scene.textures[0].bitmap)];
  for (size_t i = 0; i < speckles.rgba.size(); ++i)
    if (i % 4 != 3) speckles.rgba[i] = 255;
  // The ball is black, and lit, so that lights are in the plan.
  for (Material& m : s_.scene.materials) m.unlit = &m == &s_.scene.materials[size_t(s_.wall_material)];
  s_.scene.materials[1].base_color = {0, 0, 0, 1};
  s_.scene.materials[1].metallic = 0;
  std::vector<Image> seen = {draw("forward", 1)};
  for (const char* masks : {"samples-masks=centre", "samples-masks=samples", "samples-masks=coverage"}) {
    const auto with = [&](const char* technique) {
      return draw(technique, 4, "edges", "auto", {"brdf=lambert", masks});
    };
    const Image forward = with("forward");
    for (const Image& other : seen) EXPECT_FALSE(same_bytes(forward, other)) << masks;
    seen.push_back(forward);
    for (const char* technique :
         {"forward_multipass", "deferred", "deferred_tiled", "lidr", "light_prepass", "forward_plus"})
      EXPECT_LT(compare_images(with(technique), forward).max_rel, 1e-6) << technique << " " << masks;
  }
}

// With indices of its own each sample is shaded alone.
TEST_F(SamplesOfOpenGl, ShowOneImageInEveryPackingOfIndicesOfSamples) {
  effect("spot").add(s_);
  const Image image = draw("lidr", 4);
  for (const char* more : {"lidr-packing=sort", "lidr-packing=maxblend-sort", "lidr-unpack=float"})
    EXPECT_LT(compare_images(draw("lidr", 4, "edges", "auto", {more}), image).max_rel, 1e-5) << more;
}

// With a lamp, so that there are volumes, lists and indices; it is far, so that no pixel outshines all
// others.
TEST_F(SamplesOfOpenGl, HaveErrorsThatFallAtEdgesWhereSamplesAreLit) {
  s_ = small_scene(false);
  effect("directional").add(s_);
  add_point(s_.scene, "far", {-1, 1, 0}, {1, 1, 1}, 20, 20);
  for (Material& m : s_.scene.materials) {
    m.metallic = 0;
    m.roughness = 1;
  }
  const FineTruth truth = truth_of(s_.scene, 67, 41);
  const double inside = truth.error(draw("forward", 4), false);
  for (const char* technique :
       {"deferred", "deferred_tiled", "forward_plus_compute", "light_prepass", "lidr"}) {
    const Image one = draw(technique, 1), four = draw(technique, 4);
    EXPECT_LT(truth.error(four, true), truth.error(one, true) / 3) << technique;
    if (technique != std::string("light_prepass")) {  // whose lobe is another
      EXPECT_LE(truth.error(four, false), inside) << technique;
    }
  }
  const Image behind = draw("lidr", 4, "edges", "auto", {"lidr-volumes=no-prepass"});
  EXPECT_LT(truth.error(behind, true), truth.error(draw("lidr", 1), true) / 3);
}

TEST_F(SamplesOfOpenGl, AreRefusedWhereTheMachineHasOtherNumbers) {
  for (const int samples : {2, 8}) {
    try {
      draw("forward_plus", samples);  // some machines have them
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::machine);
      EXPECT_THAT(error.what(), HasSubstr(fmt::format("{} samples", samples)));
    }
  }
}

}  // namespace
}  // namespace lightgrid
