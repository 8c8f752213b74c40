// light_prepass in double: its equations at pixels of a wall, as docs/techniques/light_prepass.md has them.
#pragma once

#include <cmath>

#include "passes/common/light_buffer.h"
#include "passes/common/prepass_settings.h"
#include "plan/settings/model.h"
#include "support/small_scene.h"
#include "techniques/rendering.h"

namespace lightgrid::light_prepass_by_hand {

inline constexpr double pi = 3.14159265358979323846;
inline constexpr PrepassSpecular variants[] = {PrepassSpecular::plain, PrepassSpecular::fifth_term,
                                               PrepassSpecular::luminance, PrepassSpecular::bent,
                                               PrepassSpecular::stored};
inline constexpr const char* variant_names[] = {"plain", "fifth-term", "luminance", "bent", "stored"};

inline Settings volumes(PrepassSpecular specular, Brdf brdf = Brdf::blinn) {
  Settings s;
  s.set(setting::brdf, brdf);
  apply_setting(s, "prepass-lights=volumes");
  s.set(setting::prepass_specular, specular);
  return s;
}

// The perceptual roughness whose exponent 2 / alpha^2 - 2 is n.
inline float roughness_of(double n) { return float(std::pow(2 / (n + 2), 0.25)); }

// A wall of one material that fills the view, and lamps whose highlights overlap on it.
inline Scene lit_wall(int lamps, bool white, glm::vec3 color, float metallic, double shininess) {
  Scene scene;
  scene.ambient = {0, 0, 0};
  const int material = add_material(scene, "wall", color, metallic, roughness_of(shininess));
  add_instance(scene, "wall", add_mesh(scene, wall_mesh({0, 0, -4}, 8, material, "wall")));
  constexpr glm::vec3 hues[] = {{1, 0.25f, 0.25f}, {0.25f, 1, 0.25f}, {0.25f, 0.25f, 1}};
  for (int i = 0; i < lamps; ++i) {
    const double turn = 2 * pi * i / lamps;
    const double x = 0.3 + 0.9 * std::cos(turn), y = 0.1 + 0.9 * std::sin(turn);
    add_point(scene, "lamp", {x, y, -2.8}, white ? glm::vec3(1) : hues[i % 3], 3, 6);
  }
  return scene;
}

inline double smooth_step(double t) { return t * t * (3 - 2 * t); }

// KHR_materials_specular, KHR_materials_ior.
inline glm::dvec3 f0_by_hand(const Material& m) {
  const double root = (double(m.ior) - 1) / (double(m.ior) + 1);
  return glm::min(glm::dvec3(m.specular_color) * root * root, glm::dvec3(1)) * double(m.specular);
}

// The light that the model reflects of the diffuse sums, which are the same for all channels: the article's
// appendix, with the luminance in units of `scale` for the cosine.
inline glm::dvec3 diffuse_by_hand(const Material& m, double n_dot_v, double luminance, double scale) {
  const double cosine = std::min(16 * luminance / scale, 1.0), roll_off = double(m.model.roll_off),
               k = double(m.model.minnaert_k);
  const double minnaert = std::pow(cosine, k - 1) * std::pow(std::max(n_dot_v, 1.0 / 16), 1 - k);
  const double rolled = smooth_step((cosine + roll_off) / (1 + roll_off)) - smooth_step(cosine);
  const glm::dvec3 skin = glm::dvec3(m.model.subsurface_color) * std::min(rolled / cosine, 1.0);
  const glm::dvec3 f0 = f0_by_hand(m);
  const double refracted = 1 - std::max({f0.r, f0.g, f0.b});
  return (glm::dvec3(m.base_color) * ((1 - double(m.metallic)) * refracted * minnaert) + skin) / pi;
}

// Equations 8.5.2 to 8.5.7 of the article with Schlick's Fresnel, as docs/techniques/light_prepass.md has
// them.
inline glm::dvec3 radiance_by_hand(const Scene& scene, const View& view, int x, int y,
                                   PrepassSpecular variant, double scale) {
  const Material& m = scene.materials[0];
  const glm::dvec3 ndc(2 * (x + 0.5) / view.width - 1, 2 * (y + 0.5) / view.height - 1, 0);
  const glm::dvec3 p =
      4.0 * glm::dvec3(ndc.x / view.clip_from_view[0][0], ndc.y / view.clip_from_view[1][1], -1);
  const glm::dvec3 normal(0, 0, 1), viewer = -glm::normalize(p), color(m.base_color);
  const double alpha = double(m.roughness) * double(m.roughness), shininess = 2 / (alpha * alpha) - 2;
  const double n = variant == PrepassSpecular::stored ? shininess : 32;
  glm::dvec3 diffuse(0);
  double specular = 0, fifth = 0, rim = 0;
  for (const Light& light : scene.lights) {
    const glm::dvec3 to_light = light.position - p;
    const double distance = glm::length(to_light), ratio = distance / double(light.radius_m);
    const double attenuation = std::max(1 - std::pow(ratio, 4), 0.0) / (distance * distance);
    const glm::dvec3 l = to_light / distance, h = glm::normalize(l + viewer);
    const double arriving = std::max(glm::dot(normal, l), 0.0) * attenuation;
    const double schlick = std::pow(1 - glm::dot(viewer, h), 5), lobe = std::pow(glm::dot(normal, h), n);
    const glm::dvec3 intensity = glm::dvec3(light.color) * double(light.intensity);
    const double brightest = std::max({intensity.r, intensity.g, intensity.b});
    diffuse += arriving * (1 - schlick) * intensity;
    specular += arriving * lobe * brightest;
    fifth += arriving * brightest;
    rim += arriving * lobe * schlick * brightest;
  }
  const double power = shininess / n;
  const double luminance = 0.2126 * diffuse.r + 0.7152 * diffuse.g + 0.0722 * diffuse.b;
  double highlight = 0, share = std::pow(1 - glm::dot(normal, viewer), 5), exponent = shininess;
  switch (variant) {
    case PrepassSpecular::plain:
    case PrepassSpecular::stored:
      highlight = specular;
      exponent = n;
      break;
    case PrepassSpecular::fifth_term:
      highlight = fifth * std::pow(specular / fifth, power);
      share = rim / specular;
      break;
    case PrepassSpecular::luminance:
      highlight = luminance * std::pow(std::min(specular / luminance, 1.0), power);
      break;
    case PrepassSpecular::bent:
      highlight = scale * std::pow(std::min(specular / scale, 1.0), power);
      break;
  }
  highlight *= (exponent + 2) / (8 * pi);
  const glm::dvec3 f0 = glm::mix(f0_by_hand(m), color, double(m.metallic));
  const double f90 = glm::mix(double(m.specular), 1.0, double(m.metallic));
  const glm::dvec3 reflected = diffuse_by_hand(m, glm::dot(normal, viewer), luminance, scale);
  return reflected * diffuse + highlight * (f0 * (1 - share) + f90 * share);
}

inline double error_by_hand(const Scene& scene, const View& view, const Image& image,
                            PrepassSpecular variant) {
  const double scale = reference_light(scene, plan_frame(scene, view, {}, {.lists = {.light_grid = true}}));
  double most = 0, brightest = 0;
  for (int y = 0; y < view.height; ++y) {
    for (int x = 0; x < view.width; ++x) {
      const glm::dvec3 expected = radiance_by_hand(scene, view, x, y, variant, scale);
      const glm::dvec3 drawn(glm::vec3(image.at(x, y)));
      for (int c = 0; c < 3; ++c) {
        most = std::max(most, std::abs(drawn[c] - expected[c]));
        brightest = std::max(brightest, expected[c]);
      }
    }
  }
  return most / brightest;
}

}  // namespace lightgrid::light_prepass_by_hand
