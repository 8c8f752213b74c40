#include "oracle/shading.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <numeric>

#include "oracle/attenuation.h"
#include "oracle/pixel_tiles.h"
#include "oracle/position.h"

namespace lightgrid::lab {

namespace {

using glm::dvec3;

constexpr double coat_f0 = 0.04;

// Schlick 1994.
template <typename Reflectance>
Reflectance fresnel(const Reflectance& f0, double v_dot_h, double f90 = 1) {
  return f0 + (f90 - f0) * std::pow(1 - std::abs(v_dot_h), 5);
}

double largest(const dvec3& v) { return std::max({v.r, v.g, v.b}); }

// V.N^(1 - k), floored: docs/material_models.md#energy.
double minnaert_of_viewer(const Surface& s, const dvec3& to_eye) {
  return std::pow(std::clamp(glm::dot(s.normal, to_eye), 1.0 / 16, 1.0), 1 - s.minnaert_k);
}

// Engel, ShaderX7, appendix of 8.5: N.L^k V.N^(1 - k). Over N.L, since callers multiply by it.
dvec3 diffuse_of(const Surface& s, const dvec3& to_eye, const dvec3& to_light) {
  const dvec3 lambert = s.base_color / std::numbers::pi;
  if (s.minnaert_k == 1) return lambert;
  const double n_dot_l = std::clamp(glm::dot(s.normal, to_light), 0.0, 1.0);
  if (n_dot_l == 0) return dvec3(0);
  return lambert * (std::pow(n_dot_l, s.minnaert_k) * minnaert_of_viewer(s, to_eye) / n_dot_l);
}

double smoothstep(double low, double high, double x) {
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

// The same appendix, after lambSkin of NVIDIA's SDK 9.5: Subsurface, over pi as all diffuse light is here.
dvec3 subsurface_of(const Surface& s, const dvec3& to_light) {
  const double ldn = glm::dot(s.normal, to_light);
  const double sub_lamb = smoothstep(-s.roll_off, 1, ldn) - smoothstep(0, 1, ldn);
  return s.subsurface_color * (std::max(0.0, sub_lamb) / std::numbers::pi);
}

// Reflection of constant radiance by the diffuse part: the integral of N.L^k over the hemisphere is 2 pi / (k
// + 1). That of skin's term is pi R.
dvec3 diffuse_ambient(const Surface& s, const dvec3& to_eye) {
  return s.base_color * (2 / (s.minnaert_k + 1) * minnaert_of_viewer(s, to_eye));
}

// Reflection of constant radiance from all sides: this program's own simplification, without Fresnel. Diffuse
// light is whole with the default reflectance, and in proportion to what is left of it with another.
dvec3 ambient_reflectance(const Surface& s, const dvec3& to_eye, Brdf lobe) {
  const dvec3 diffuse = diffuse_ambient(s, to_eye), subsurface = s.subsurface_color * s.roll_off;
  if (lobe == Brdf::lambert) return diffuse + subsurface;
  return diffuse * ((1 - s.metallic) * (1 - largest(s.f0)) / (1 - 0.04)) + subsurface +
         glm::mix(s.f0, s.base_color, s.metallic);
}

// GGX (Walter et al. 2007) with |N x H|^2 in place of 1 - (N.H)^2, which cancels at small roughness.
double ggx_distribution(const dvec3& normal, const dvec3& half, double alpha) {
  const dvec3 across = glm::cross(normal, half);
  const double along = std::max(glm::dot(normal, half), 0.0) * alpha;
  const double k = alpha / (glm::dot(across, across) + along * along);
  return k * k * std::numbers::inv_pi;
}

// Height-correlated Smith masking (Heitz 2014), over 4 N.L N.V.
double smith_visibility(double n_dot_v, double n_dot_l, double alpha) {
  const double a2 = alpha * alpha;
  return 0.5 / (n_dot_l * std::sqrt(n_dot_v * n_dot_v * (1 - a2) + a2) +
                n_dot_v * std::sqrt(n_dot_l * n_dot_l * (1 - a2) + a2));
}

// Blinn-Phong with the width of GGX at that alpha: (n + 2) / (8 pi) cos^n.
double blinn_lobe(const dvec3& normal, const dvec3& half, double alpha) {
  const double exponent = 2 / (alpha * alpha) - 2, cosine = std::max(glm::dot(normal, half), 0.0);
  return (exponent + 2) / (8 * std::numbers::pi) * std::pow(cosine, exponent);
}

double specular_of(const dvec3& normal, double perceptual_roughness, const dvec3& to_eye,
                   const dvec3& to_light, Brdf lobe) {
  const dvec3 half = glm::normalize(to_eye + to_light);
  const double roughness = std::max(perceptual_roughness, 0.045), alpha = roughness * roughness;
  if (lobe == Brdf::blinn) return blinn_lobe(normal, half, alpha);
  const double n_dot_v = std::max(glm::dot(normal, to_eye), 1e-4);
  const double n_dot_l = std::clamp(glm::dot(normal, to_light), 0.0, 1.0);
  return smith_visibility(n_dot_v, n_dot_l, alpha) * ggx_distribution(normal, half, alpha);
}

// Opposite directions have no half vector (a surface seen from behind). Fresnel is 1 there, so the diffuse
// part is 0.
bool are_opposite(const dvec3& a, const dvec3& b) { return glm::dot(a + b, a + b) < 1e-8; }

// The coat's share of the result: KHR_materials_clearcoat, fresnel_coat.
double coat_share(const Surface& surface, const dvec3& to_eye, Brdf lobe) {
  if (surface.coat == 0 || lobe == Brdf::lambert) return 0;
  return surface.coat * fresnel(coat_f0, std::max(glm::dot(surface.coat_normal, to_eye), 1e-4));
}

dvec3 light_radiance(const Surface& surface, const dvec3& position, const dvec3& to_eye,
                     const ViewLight& light, const ShadeSettings& settings) {
  const dvec3 arriving =
      attenuation(light, position, settings.window) * light_reaches(light, position, surface.mask);
  if (arriving == dvec3(0)) return dvec3(0);
  const dvec3 from_light = position - light.position;
  const auto back_of = [&](const dvec3& to_light) {
    return reflected(surface, to_eye, to_light, settings.brdf);
  };
  dvec3 back;
  if (light.lit) {
    back = (*light.lit)(from_light, {back_of, to_eye, {surface.normal, surface.coat_normal}}) *
           glm::dot(from_light, from_light);
  } else if (is_directional(light)) {
    back = back_of(-light.direction);
  } else {
    const double distance = length_of(from_light.x, from_light.y, from_light.z);
    back = back_of(-from_light / std::max(distance, std::numeric_limits<double>::min()));
  }
  return back == dvec3(0) ? dvec3(0) : back * light.radiant_intensity * arriving;
}

std::vector<ViewLight> unhidden(const std::vector<ViewLight>& lights, const std::vector<uint32_t>& among,
                                uint32_t pixel, const ShadeSettings& settings) {
  std::vector<ViewLight> seen;
  for (const uint32_t light : among) {
    if (!settings.hidden(pixel, light)) seen.push_back(lights[light]);
  }
  return seen;
}

}  // namespace

dvec3 brdf(const Surface& surface, const dvec3& to_eye, const dvec3& to_light, Brdf lobe) {
  if (lobe == Brdf::lambert) return diffuse_of(surface, to_eye, to_light);
  if (are_opposite(to_eye, to_light)) return dvec3(0);
  const double specular = specular_of(surface.normal, surface.roughness, to_eye, to_light, lobe);
  // The form of the specification: a mix of two materials.
  const double v_dot_h = glm::dot(to_eye, glm::normalize(to_eye + to_light));
  const dvec3 diffuse = diffuse_of(surface, to_eye, to_light);
  const dvec3 reflected_part = fresnel(surface.f0, v_dot_h, surface.f90);
  const dvec3 dielectric = diffuse * (1 - largest(reflected_part)) + specular * reflected_part;
  const dvec3 metal = fresnel(surface.base_color, v_dot_h) * specular;
  return glm::mix(dielectric, metal, surface.metallic);
}

dvec3 reflected(const Surface& surface, const dvec3& to_eye, const dvec3& to_light, Brdf lobe) {
  const double n_dot_l = std::clamp(glm::dot(surface.normal, to_light), 0.0, 1.0);
  const dvec3 own = n_dot_l == 0 ? dvec3(0) : brdf(surface, to_eye, to_light, lobe) * n_dot_l;
  const dvec3 base = own + subsurface_of(surface, to_light);
  const double share = coat_share(surface, to_eye, lobe);
  if (share == 0) return base;
  const double coat_n_dot_l = std::clamp(glm::dot(surface.coat_normal, to_light), 0.0, 1.0);
  const bool dark = coat_n_dot_l == 0 || are_opposite(to_eye, to_light);
  const double coat =
      dark ? 0
           : specular_of(surface.coat_normal, surface.coat_roughness, to_eye, to_light, lobe) * coat_n_dot_l;
  return glm::mix(base, dvec3(coat), share);
}

dvec3 shade(const Surface& surface, const dvec3& position, bool orthographic,
            const std::vector<ViewLight>& lights, const ShadeSettings& settings) {
  if (surface.unlit) return surface.base_color;
  const dvec3 to_eye = orthographic ? dvec3(0, 0, 1) : glm::normalize(-position);
  // The coat reflects ambient light as the base's lobes do, whole, and lies over what the surface emits.
  const dvec3 ambient = settings.ambient * surface.occlusion;
  dvec3 radiance = ambient * ambient_reflectance(surface, to_eye, settings.brdf);
  radiance = glm::mix(radiance + surface.emissive, ambient, coat_share(surface, to_eye, settings.brdf));
  for (const auto& term : settings.base) radiance += term(surface, position);
  for (const ViewLight& light : lights) {
    radiance += light_radiance(surface, position, to_eye, light, settings);
  }
  return radiance;
}

std::vector<dvec3> shade_pixels(const View& view, const std::vector<float>& depth,
                                const std::function<Surface(uint32_t pixel)>& surface_at,
                                const std::vector<ViewLight>& lights, const ShadeSettings& settings,
                                const std::vector<uint32_t>& pixels) {
  assert(depth.size() == view.grid().values());
  std::vector<dvec3> radiance(pixels.size());
  const auto position_of = [&](uint32_t p) {
    return position_from_depth(view, int(p) % view.width, int(p) / view.width, depth[p]);
  };
  std::vector<uint32_t> all(settings.hidden ? lights.size() : 0);
  std::iota(all.begin(), all.end(), 0u);
  // Without a window every light reaches everything, so all lights are used.
  const std::vector<ViewLight> none;
  for_each_tile(
      view.width, pixels, position_of, settings.window ? lights : none, [&](const TileOfPixels& tile) {
        std::vector<ViewLight> near;
        for (const uint32_t light : tile.lights) near.push_back(lights[light]);
        for (size_t k = 0; k < tile.indices.size(); ++k) {
          const uint32_t index = tile.indices[k];
          const auto shaded = [&](const std::vector<ViewLight>& by) {
            return shade(surface_at(pixels[index]), tile.positions[k], view.orthographic, by, settings);
          };
          if (settings.hidden) {
            const auto& among = settings.window ? tile.lights : all;
            radiance[index] = shaded(unhidden(lights, among, pixels[index], settings));
          } else {
            radiance[index] = shaded(settings.window ? near : lights);
          }
        }
      });
  return radiance;
}

std::vector<uint32_t> sample_pixels(const std::vector<uint32_t>& pixels, size_t most) {
  if (pixels.size() <= most) return pixels;
  std::vector<uint32_t> samples(most);
  for (size_t i = 0; i < most; ++i) {
    const size_t begin = i * pixels.size() / most, end = (i + 1) * pixels.size() / most;
    const double place = double(i) * std::numbers::phi;
    samples[i] = pixels[begin + size_t((place - std::floor(place)) * double(end - begin))];
  }
  return samples;
}

}  // namespace lightgrid::lab
