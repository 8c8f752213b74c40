// Surfaces and normals of samples that OpenCL stores (raster=opencl): every sample against a picture of one
// sample there, pixels of one surface against visibility, and the same bytes in every form.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "raster/raster_samples.h"
#include "support/fine_truth.h"
#include "support/small_scene.h"
#include "techniques/rendering.h"

namespace lightgrid {
using namespace lab;
namespace {

struct SampledFrame {
  Image image;
  SampleFigures figures;
};

SampledFrame frame_of_samples(const Scene& scene, const std::string& technique, const std::string& set) {
  TechniqueRun run(test_devices(), scene, small_view(67, 41), assigned(set), find_technique(technique));
  run.run_frame();
  return {run.image(), run.frame().sample_figures()};
}

// The largest difference of a channel.
double apart(const Image& a, const Image& b, size_t pixel) {
  const glm::vec4 d = glm::abs(a.pixels[pixel] - b.pixels[pixel]);
  return double(std::max({d.r, d.g, d.b, d.a}));
}

Scene scene_with_every_effect() {
  SmallScene s = small_scene();
  for (const SceneEffect& effect : effects()) effect.add(s);
  return s.scene;
}

// Slanted cards of one colour each before a wall, near lamps: what a sample shows changes from sample to
// sample by light alone, and a surface stored at its centroid is the surface at each sample.
Scene cards() {
  SmallScene s = small_scene();
  s.scene.instances.resize(1);
  for (int i = 0; i < 25; ++i) {
    const glm::vec3 center(0.6f * float(i % 5) - 1.2f, 0.4f * float(i / 5) - 0.8f,
                           -2.8f - 0.1f * float(i % 3));
    Mesh card;
    shapes::add_quad(card, center, {0.31f, 0.13f, 0.1f * float(i % 4)}, {-0.11f, 0.27f, 0.2f}, 1, 1);
    const int material = add_material(s.scene, "card", {0.2f + 0.03f * float(i), 0.5f, 0.9f}, 0, 0.7f);
    s.scene.materials[size_t(material)].double_sided = true;
    add_instance(s.scene, "card", add_mesh(s.scene, shapes::finished(std::move(card), "card", material)));
  }
  s.scene.ambient = {0.03f, 0.02f, 0.04f};
  return s.scene;
}

// The picture whose pixels' centres are a sample's place.
Image picture_at(const Scene& scene, glm::ivec2 place) {
  View view = small_view(67, 41);
  view.clip_from_view[2][0] += 2 * place.x / 256.0 / view.width;
  view.clip_from_view[2][1] += 2 * place.y / 256.0 / view.height;
  return render(scene, view, "visibility");
}

// Both add the lights of opencl_raster_test.cpp, whose rounding this is.
constexpr double rounding_of_lights = 2e-6;

TEST(StoredSamples, ShowWhatPicturesOfOneSampleShowThere) {
  const Scene scene = cards();
  const Image centres = picture_at(scene, {0, 0});
  for (const int samples : {2, 8}) {
    Image mean(centres.width, centres.height);
    for (const glm::ivec2& place : raster_samples(samples)) {
      const Image one = picture_at(scene, place);
      for (size_t i = 0; i < mean.pixels.size(); ++i) mean.pixels[i] += one.pixels[i] / float(samples);
    }
    const std::string set = fmt::format("raster=opencl samples={} samples-shading=", samples);
    const Image all = frame_of_samples(scene, "deferred_tiled", set + "all").image;
    EXPECT_LT(compare_images(all, mean).max_rel, rounding_of_lights) << samples;
    EXPECT_GT(compare_images(centres, mean).max_rel, 0.1);
    // Where a pixel shows one surface, its centre alone is shaded.
    const SampledFrame edges = frame_of_samples(scene, "deferred_tiled", set + "edges");
    for (size_t i = 0; i < mean.pixels.size(); ++i) {
      if (edges.figures.surfaces[i] > 0) {
        EXPECT_LT(apart(edges.image, all, i), rounding_of_lights * brightest_channel(all))
            << samples << ' ' << i;
      }
    }
    EXPECT_FALSE(same_bytes(edges.image, all));
    EXPECT_LT(compare_images(edges.image, all).rmse_rel, 2e-3) << samples;
    // With two samples each is the centroid of the only surface that it sees.
    if (samples == 2) {
      const Image visibility = frame_of_samples(scene, "visibility", "samples=2").image;
      EXPECT_LT(compare_images(edges.image, visibility).max_rel, rounding_of_lights);
    }
  }
}

// Inside, visibility's picture. At edges it shades a surface once, and light passes each of its samples.
TEST(StoredSamples, ShowVisibilitysPictureInBothShapes) {
  const Scene scene = scene_with_every_effect();
  const SampledFrame visibility = frame_of_samples(scene, "visibility", "samples=4"),
                     stored = frame_of_samples(scene, "deferred_tiled", "raster=opencl samples=4");
  const double brightest = brightest_channel(visibility.image);
  size_t edges = 0, differ = 0;
  for (size_t i = 0; i < stored.image.pixels.size(); ++i) {
    const bool edge = visibility.figures.surfaces[i] > 0;
    EXPECT_EQ(stored.figures.surfaces[i] > 0, edge) << i;
    const double d = apart(stored.image, visibility.image, i) / brightest;
    edges += edge;
    differ += edge && d > rounding_of_lights;
    EXPECT_LT(d, edge ? 0.05 : rounding_of_lights) << i;
  }
  EXPECT_EQ(stored.figures.edge_pixels, edges);
  EXPECT_GT(edges, 100u);
  EXPECT_GT(differ, 10u);
  EXPECT_EQ(stored.figures.covered, visibility.figures.covered);
  EXPECT_GT(stored.figures.shadings, visibility.figures.shadings);
  for (const char* more : {"kernel-shape=group", "group-tiles=off"})
    EXPECT_TRUE(identical(
        frame_of_samples(scene, "forward_plus_compute", std::string("raster=opencl samples=4 ") + more).image,
        stored.image))
        << more;
}

// Sums of light for each sample: under the matt model, which a light buffer has exactly, the picture of a
// geometry buffer.
TEST(StoredSamples, OfLightPrepassShowTheSamePicture) {
  const Scene scene = cards();
  for (const char* shading : {"samples-shading=all", "samples-shading=edges"}) {
    const std::string set = std::string("raster=opencl brdf=lambert samples=4 ") + shading;
    const SampledFrame stored = frame_of_samples(scene, "deferred_tiled", set),
                       sums = frame_of_samples(scene, "light_prepass", set);
    EXPECT_LT(compare_images(sums.image, stored.image).max_rel, rounding_of_lights) << shading;
    EXPECT_EQ(sums.figures.edge_pixels, stored.figures.edge_pixels);
    EXPECT_EQ(sums.figures.shadings, stored.figures.shadings);
    EXPECT_TRUE(
        identical(frame_of_samples(scene, "light_prepass", set + " kernel-shape=group").image, sums.image))
        << shading;
  }
}

// Images of coats, reflectance and surface numbers.
TEST(StoredSamples, HaveTheSameBytesInFewerBits) {
  SmallScene s = small_scene();
  for (const char* name : {"clearcoat", "specular", "groups"}) effect(name).add(s);
  const std::string set = "raster=opencl samples=2 buffer-bits=8 group-ids=16";
  const Image image = frame_of_samples(s.scene, "deferred_tiled", set).image;
  EXPECT_EQ(count_nan_pixels(image), 0u);
  EXPECT_TRUE(
      identical(frame_of_samples(s.scene, "deferred_tiled", set + " kernel-shape=group").image, image));
}

TEST(StoredSamples, HaveErrorsThatFallAtEdges) {
  SmallScene s = small_scene(false);
  effect("directional").add(s);
  add_point(s.scene, "far", {-1, 1, 0}, {1, 1, 1}, 20, 20);
  for (Material& m : s.scene.materials) {
    m.metallic = 0;
    m.roughness = 1;
  }
  const FineTruth truth(test_devices(), s.scene, small_view(FineTruth::side * 67, FineTruth::side * 41));
  const auto error = [&](const char* set, bool at_edges) {
    return truth.error(render(s.scene, small_view(67, 41), "deferred_tiled", assigned(set)), at_edges);
  };
  EXPECT_LT(error("raster=opencl samples=4", true), error("raster=opencl", true) / 3);
  EXPECT_LE(error("raster=opencl samples=4", false), error("raster=opencl", false));
}

}  // namespace
}  // namespace lightgrid
