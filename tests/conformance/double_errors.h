// visibility against surfaces in double (support/double_surfaces.h, oracle/scene_surfaces.h), which have
// their own rasteriser, attributes and texture filter; and forward against the same.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "accuracy/oracle.h"
#include "accuracy/surfaces_in_double.h"
#include "plan/settings/model.h"
#include "support/devices.h"
#include "support/double_surfaces.h"

namespace lightgrid {
using namespace lab;

struct DoubleErrors {
  size_t pixels = 0, compared = 0;
  size_t elsewhere = 0, forward_elsewhere = 0;  // show another triangle than in double
  double largest = 0, mean = 0;  // errors of the compared pixels' largest channel, relative to the brightest
  double forward_largest = 0, forward_mean = 0;
  double sum = 0, forward_sum = 0, sum_in_double = 0;  // sums over all channels of the compared pixels
  // As `mean`, where the surfaces lie at visibility's own depth, which is that of a plane through corners
  // that are rounded to 1/256 pixel (docs/raster.md).
  double own_depth_mean = 0;
};

inline SceneTriangle triangle_of(const Scene& scene, const double_surfaces::Hit& hit) {
  if (hit.instance < 0) return {};
  const std::vector<uint32_t>& indices = scene.meshes[scene.instances[hit.instance].mesh].indices;
  return scene_triangle(hit.instance, &indices[3 * size_t(hit.triangle)]);
}

// At the pixels where all three show the same triangle. The scene has no blended surface in view.
inline DoubleErrors errors_against_double(const Scene& scene, const View& view,
                                          const Settings& settings = {}) {
  TechniqueRun visibility(software_devices(), scene, view, settings, find_technique("visibility"));
  TechniqueRun forward(software_devices(), scene, view, settings, find_technique("forward"));
  visibility.run_frame();
  forward.run_frame();
  EXPECT_TRUE(visibility.view().plan.surfaces.blended.empty());
  const std::vector<SceneTriangle> own = own_triangles(visibility),
                                   drawn = read_triangles(forward.view()).opaque;
  double_surfaces::Surfaces surfaces(scene, view, visibility.view().plan.surfaces.opaque);

  DoubleErrors e{.pixels = own.size()};
  std::vector<uint32_t> pixels;
  std::vector<float> depth(own.size());
  std::map<uint32_t, Surface> seen;
  for (uint32_t i = 0; i < own.size(); ++i) {
    const SceneTriangle triangle = triangle_of(scene, surfaces.hits()[i]);
    e.elsewhere += own[i] != triangle;
    e.forward_elsewhere += drawn[i] != triangle;
    if (own[i] != triangle || drawn[i] != triangle) continue;
    if (triangle.instance < 0) {
      EXPECT_EQ(glm::vec3(visibility.image().pixels[i]), scene.background);
      continue;
    }
    depth[i] = float(surfaces.hits()[i].depth);
    pixels.push_back(i);
    seen[i] = surfaces.surface_at(i);
  }
  e.compared = pixels.size();
  const auto lights = lights_in_view(scene, view);
  const auto shaded_at = [&](const std::vector<float>& depths) {
    const auto surface_at = [&](uint32_t pixel) { return seen.at(pixel); };
    return shade_pixels(view, depths, surface_at, lights,
                        {.brdf = settings[setting::brdf], .ambient = scene.ambient}, pixels);
  };
  const auto radiance = shaded_at(depth), at_own_depth = shaded_at(read_depth(visibility));
  double brightest = 0;
  for (const glm::dvec3& c : radiance) brightest = std::max({brightest, c.r, c.g, c.b});
  for (size_t i = 0; i < pixels.size() && brightest > 0; ++i) {
    const auto apart = [&](const Image& image, const std::vector<glm::dvec3>& expected) {
      const glm::dvec3 off =
          glm::abs(glm::dvec3(glm::vec3(image.pixels[pixels[i]])) - expected[i]) / brightest;
      return std::max({off.r, off.g, off.b});
    };
    const double of_visibility = apart(visibility.image(), radiance),
                 of_forward = apart(forward.image(), radiance);
    if (!(of_visibility <= e.largest)) e.largest = of_visibility;  // NaN too
    e.forward_largest = std::max(e.forward_largest, of_forward);
    e.mean += of_visibility / double(pixels.size());
    e.forward_mean += of_forward / double(pixels.size());
    for (int c = 0; c < 3; ++c) {
      e.sum += visibility.image().pixels[pixels[i]][c];
      e.forward_sum += forward.image().pixels[pixels[i]][c];
      e.sum_in_double += radiance[i][c];
    }
    e.own_depth_mean += apart(visibility.image(), at_own_depth) / double(pixels.size());
  }
  return e;
}

}  // namespace lightgrid
