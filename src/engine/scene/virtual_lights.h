// Virtual point lights: the light that surfaces reflect once, as lights of the scene that any technique lists
// and shades like others (docs/fake_radiosity.md). Keller, "Instant Radiosity" (SIGGRAPH 1997); Dachsbacher,
// Stamminger, "Reflective Shadow Maps" (I3D 2005); Trebilco, "Light-Indexed Deferred Rendering" (ShaderX7).
// Pure functions; passes/resolve.h finds what a light's view reflects.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/camera.h"

namespace lightgrid {

// A spot without a range whose cone is the hemisphere around its direction.
void make_virtual(Light& light);

struct VirtualLightSettings {
  int count = 0;
  size_t from = SIZE_MAX;  // the most important lights alone are reflected
  double nearest_m = -1;   // Light::nearest_m; below 0: of each the radius of the disc that it stands for
  uint64_t seed = 1;       // shifts the points of the sequence
};

// Indices of the point and spot lights that are reflected, ascending: the `most` of greatest light_importance
// (scene/shadow_casters.h).
std::vector<size_t> reflected_lights(const Scene& scene, size_t most);

// The light's views, `side` pixels wide and high: one view for a spot up to 150 degrees wide, else six of 90
// degrees.
std::vector<View> views_from(const Light& light, int side, double near_m);

// A pixel of a light's view. All zero where nothing is reflected.
struct ReflectedPixel {
  glm::vec3 flux{0};    // lumens, or what intensity has as its unit times sr: what its surface reflects
  float area_m2 = 0;    // area of the surface
  glm::vec3 normal{0};  // the triangle's: unit, view space, towards the light
  float ahead_m = 0;    // along the view's axis
};

struct ReflectedView {
  View view;
  std::vector<ReflectedPixel> pixels;  // row 0 at the bottom
  Properties properties{};             // of the light, as far as its reflections have them
};

// `count` lights, each with an equal part of the flux that all pixels reflect together (sum of its channels):
// pixels are chosen in proportion to their flux, by Hammersley's points through the distribution of rows,
// then that of a row's pixels. Each is 1/64 of its pixel's width above its surface. If nothing is reflected,
// all are without intensity and range. Deterministic.
std::vector<Light> virtual_lights_of(const std::vector<ReflectedView>& views,
                                     const VirtualLightSettings& settings);

}  // namespace lightgrid
