// The error of an image from rounding the geometry buffer, compared with the oracle's.
#pragma once

#include <algorithm>

#include "plan/settings/surfaces.h"
#include "techniques/rendering.h"

namespace lightgrid {

// Point and spot lights at every pixel with a surface, in double.
inline std::vector<glm::dvec3> shade_in_double(const RenderView& v, const SurfaceImages& surfaces,
                                               const std::vector<float>& depth,
                                               const std::vector<uint32_t>& pixels) {
  const std::vector<ViewLight> all = lights_in_view(v.scene, v.view);
  std::vector<ViewLight> local;
  for (int i : v.plan.lights.local) local.push_back(all[i]);
  const auto surface_at = [&](uint32_t pixel) {
    Surface surface = surface_of(surfaces, pixel);
    surface.emissive = {};
    surface.unlit = false;
    return surface;
  };
  return shade_pixels(v.view, depth, surface_at, local, {}, pixels);
}

struct RoundingLoss {
  double image = 0;        // of forward's brightest channel
  double unexplained = 0;  // by the rounding of the geometry buffer
};

// For techniques and scenes whose base lighting (ambient, emission) is in the image before anything is
// rounded. The rest of the error must equal that of the oracle's shading of the surfaces as stored.
inline RoundingLoss rounding_loss(const char* technique, const Scene& scene, const View& view,
                                  const Image& forward, int bits) {
  TechniqueRun run(test_devices(), scene, view, {{setting::buffer_bits, bits}}, find_technique(technique));
  run.run_frame();
  RenderView& v = run.view();
  const std::vector<float> depth = read_depth(v);
  const SurfaceImages kept = read_gbuffer_surfaces(v), drawn = read_surfaces(v);
  std::vector<uint32_t> pixels;
  for (uint32_t i = 0; i < depth.size(); ++i) {
    const bool unlit = drawn.emissive_occlusion.pixels[i].w < 0;
    if (depth[i] > 0 && !drawn.blended[i] && !unlit) pixels.push_back(i);
  }
  EXPECT_GT(pixels.size(), depth.size() / 4) << "nearly nothing is judged";
  const std::vector<glm::dvec3> rounded = shade_in_double(v, kept, depth, pixels);
  const std::vector<glm::dvec3> exact = shade_in_double(v, drawn, depth, pixels);
  const double brightest = brightest_channel(forward);
  const auto largest = [&](const glm::dvec3& c) { return std::max({c.x, c.y, c.z}) / brightest; };
  RoundingLoss loss;
  for (size_t k = 0; k < pixels.size(); ++k) {
    const glm::vec4 &here = run.image().pixels[pixels[k]], &there = forward.pixels[pixels[k]];
    const glm::dvec3 found = glm::dvec3(here) - glm::dvec3(there);
    loss.image = std::max(loss.image, largest(glm::abs(found)));
    loss.unexplained = std::max(loss.unexplained, largest(glm::abs(found - (rounded[k] - exact[k]))));
  }
  return loss;
}

// The loss at 32, 16 and 8 bits: each is explained, the first is zero, and each exceeds the previous one.
inline void expect_rounding_explains_the_loss(const char* technique, const Scene& scene, const View& view) {
  constexpr double exact_enough = 1e-5;  // of the brightest channel
  const Image forward = render(scene, view, "forward");
  const RoundingLoss in_32 = rounding_loss(technique, scene, view, forward, 32);
  const RoundingLoss in_16 = rounding_loss(technique, scene, view, forward, 16);
  const RoundingLoss in_8 = rounding_loss(technique, scene, view, forward, 8);
  for (const RoundingLoss& loss : {in_32, in_16, in_8}) EXPECT_LT(loss.unexplained, exact_enough);
  EXPECT_LT(in_32.image, exact_enough);
  EXPECT_GT(in_16.image, exact_enough) << "else nothing was explained";
  EXPECT_GT(in_8.image, 10 * in_16.image) << "a step of 8 bits is 256 times as large";
}

}  // namespace lightgrid
