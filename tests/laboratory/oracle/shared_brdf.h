// The shading code of shaders and kernels, compiled as C++, against the reference in double. Included once
// with BLINN, once with LAMBERT, once with CLEARCOAT, once with SPECULAR, once with SKIN and MINNAERT, and
// once without any.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "oracle/shading.h"
#define SPOTS
#include "shared/punctual_light.h"

namespace lightgrid::lab {

inline glm::dvec3 random_direction(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
}

// The largest error of a channel over 1 + the value, over random points, materials and lights in front of
// them.
static double largest_error(Brdf lobe, double min_roughness) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform;
  double largest = 0;
  for (int i = 0; i < 100'000; ++i) {
    Surface surface{.normal = random_direction(random),
                    .base_color = {uniform(random), uniform(random), uniform(random)},
                    .metallic = uniform(random),
                    .roughness = std::max(uniform(random), min_roughness)};
    const glm::dvec3 position{uniform(random), uniform(random), -2 - uniform(random)};
    if (glm::dot(surface.normal, -position) < 0) surface.normal = -surface.normal;
#ifdef CLEARCOAT
    surface.coat = i % 8 == 0 ? 0 : uniform(random);
    surface.coat_roughness = std::max(uniform(random), min_roughness);
    surface.coat_normal = random_direction(random);
    if (glm::dot(surface.coat_normal, -position) < 0) surface.coat_normal = -surface.coat_normal;
#endif
#ifdef SPECULAR
    surface.f90 = i % 8 == 0 ? 0 : i % 8 == 1 ? 1 : float(uniform(random));
    for (int c = 0; c < 3; ++c) surface.f0[c] = float(surface.f90 * uniform(random));
#endif
#ifdef MINNAERT
    surface.subsurface_color = {uniform(random), uniform(random), uniform(random)};
    surface.roll_off = i % 8 == 0 ? 0 : float(uniform(random));
    surface.minnaert_k = i % 8 == 1 ? 1 : float(0.3 + 1.2 * uniform(random));
#endif
    ViewLight light{.type = i % 2 ? LightType::spot : LightType::point,
                    .position = position + random_direction(random),
                    .direction = random_direction(random),
                    .radiant_intensity = glm::dvec3(3, 2, 1),
                    .radius_m = 2,
                    .cos_inner = 0.9,
                    .cos_outer = 0.1};
    // As Frame makes them for the shaders.
    const double scale = 1 / (light.cos_inner - light.cos_outer);
    const PunctualLight packed{
        glm::vec4(light.position, 0.25), glm::vec4(light.radiant_intensity, 0),
        i % 2 ? glm::vec4(light.direction * scale, -light.cos_outer * scale) : glm::vec4(0, 0, 0, 1)};
    ShadingPoint p = shading_point(position, glm::normalize(-position), surface.normal, surface.base_color,
                                   real(surface.metallic), real(surface.roughness));
#ifdef SPECULAR
    p = with_specular(p, real(surface.metallic), surface.f0, real(surface.f90));
#endif
#ifdef MINNAERT
    p = with_skin(p, surface.subsurface_color, real(surface.roll_off));
    p = with_minnaert(p, glm::normalize(-position), real(surface.minnaert_k));
#endif
#ifdef CLEARCOAT
    p = with_coat(p, surface.coat_normal, real(surface.coat), real(surface.coat_roughness));
#endif
    const glm::dvec3 got(radiance_from(p, packed)),
        want = shade(surface, position, false, {light}, {.brdf = lobe});
    for (int c = 0; c < 3; ++c) largest = std::max(largest, std::abs(got[c] - want[c]) / (1 + want[c]));
  }
  return largest;
}

}  // namespace lightgrid::lab
