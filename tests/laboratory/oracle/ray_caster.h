// A ray caster in double for tests, written from the texts of glTF 2.0 (appendix B) and KHR_lights_punctual
// alone. It shares only the plain structs that describe a scene with the renderer: no code of
// src/engine/shared or src/laboratory/oracle.
//
// One of two permitted forms is used: masking and shadowing are height-correlated (Heitz 2014), which
// appendix B describes as more accurate and Khronos' own viewer uses. No floors, neither on roughness nor on
// distance.
//
// Surfaces: infinite planes, and the triangles of a scene's meshes with the vertices' normals interpolated.
// Materials without textures. No shadows, no ambient light.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "scene/scene.h"

namespace lightgrid::lab::ray_caster {

using glm::dvec3;

// --- glTF 2.0, appendix B ---------------------------------------------------

inline double heaviside(double x) { return x > 0 ? 1 : 0; }

// Trowbridge-Reitz.
inline double distribution(double alpha, double n_dot_h) {
  const double a2 = alpha * alpha, f = n_dot_h * n_dot_h * (a2 - 1) + 1;
  return a2 * heaviside(n_dot_h) / (std::numbers::pi * f * f);
}

// Heitz 2014, equations 72 and 99.
inline double lambda(double alpha, double cosine) {
  const double tangent2 = (1 - cosine * cosine) / (cosine * cosine);
  return (std::sqrt(1 + alpha * alpha * tangent2) - 1) / 2;
}
inline double masking_shadowing(double alpha, double n_dot_l, double n_dot_v) {
  return 1 / (1 + lambda(alpha, n_dot_l) + lambda(alpha, n_dot_v));
}

inline dvec3 material_brdf(const Material& m, const dvec3& n, const dvec3& l, const dvec3& v) {
  const dvec3 h = (l + v) / glm::length(l + v), base_color(m.base_color);
  const double alpha = double(m.roughness) * double(m.roughness), metallic = m.metallic;
  const double n_dot_l = glm::dot(n, l), n_dot_v = glm::dot(n, v);
  const double fresnel_w = std::pow(1 - std::abs(glm::dot(v, h)), 5);
  const dvec3 diffuse_brdf = base_color / std::numbers::pi;
  const double specular_brdf = distribution(alpha, glm::dot(n, h)) *
                               masking_shadowing(alpha, n_dot_l, n_dot_v) /
                               (4 * std::abs(n_dot_v) * std::abs(n_dot_l));
  const double dielectric_fresnel = 0.04 + (1 - 0.04) * fresnel_w;
  const dvec3 dielectric_brdf = (1 - dielectric_fresnel) * diffuse_brdf + dielectric_fresnel * specular_brdf;
  const dvec3 metal_fresnel = base_color + (1.0 - base_color) * fresnel_w;
  const dvec3 metal_brdf = metal_fresnel * specular_brdf;
  return (1 - metallic) * dielectric_brdf + metallic * metal_brdf;
}

// --- KHR_lights_punctual ----------------------------------------------------

struct Illumination {
  dvec3 to_light;     // unit
  dvec3 illuminance;  // on a surface that faces the light, lux
};

inline Illumination illumination(const Light& light, const dvec3& at) {
  const dvec3 color = dvec3(light.color) * double(light.intensity),
              along = glm::normalize(dvec3(light.direction));
  if (light.type == LightType::directional) return {-along, color};
  const dvec3 offset = light.position - at;
  const double d = glm::length(offset);
  const dvec3 to_light = offset / d;
  double attenuation = 1 / (d * d);
  if (std::isfinite(light.radius_m)) {
    attenuation *= std::max(std::min(1 - std::pow(d / double(light.radius_m), 4), 1.0), 0.0);
  }
  if (light.type == LightType::spot) {
    const double outer = std::cos(double(light.outer_cone_rad)),
                 inner = std::cos(double(light.inner_cone_rad));
    const double scale = 1 / std::max(0.001, inner - outer), offset_of_angle = -outer * scale;
    const double angular = std::clamp(glm::dot(along, -to_light) * scale + offset_of_angle, 0.0, 1.0);
    const bool step = light.inner_cone_rad == light.outer_cone_rad;
    attenuation *= step ? glm::dot(along, -to_light) > outer : angular * angular;
  }
  return {to_light, color * attenuation};
}

// --- Rays -------------------------------------------------------------------

struct Ray {
  dvec3 origin, direction;  // unit
};

struct Hit {
  double distance;
  dvec3 normal;  // unit; the shading normal
  int material;
};

struct Plane {
  dvec3 point, normal;
  int material;
};

// Through the centre of pixel (x, y) of a perspective camera, row 0 at the bottom.
inline Ray ray_through(const Camera& camera, int width, int height, int x, int y) {
  const double up = std::tan(camera.fov_y_rad / 2), right = up * width / height;
  const dvec3 in_view((2 * (x + 0.5) / width - 1) * right, (2 * (y + 0.5) / height - 1) * up, -1);
  return {dvec3(camera.world_from_view[3]), glm::normalize(glm::dmat3(camera.world_from_view) * in_view)};
}

inline std::optional<Hit> hit_of(const Plane& plane, const Ray& ray) {
  const double distance =
      glm::dot(plane.point - ray.origin, plane.normal) / glm::dot(ray.direction, plane.normal);
  if (!(distance > 0 && std::isfinite(distance))) return {};
  return Hit{distance, plane.normal, plane.material};
}

struct Triangle {
  dvec3 corners[3], normals[3];
};

// Corners weighted by the signed areas opposite to them, as the solution of a 3 x 3 system.
inline std::optional<Hit> hit_of(const Triangle& t, const Ray& ray, int material) {
  const dvec3 edge1 = t.corners[1] - t.corners[0], edge2 = t.corners[2] - t.corners[0];
  const double volume = -glm::dot(glm::cross(edge1, edge2), ray.direction);
  if (volume <= 0) return {};  // seen from behind, or edge on
  const dvec3 from = ray.origin - t.corners[0], turned = glm::cross(ray.direction, from);
  const double distance = glm::dot(glm::cross(edge1, edge2), from) / volume;
  const double u = -glm::dot(edge2, turned) / volume, v = glm::dot(edge1, turned) / volume;
  if (u < 0 || v < 0 || u + v > 1 || distance <= 0) return {};
  return Hit{distance, glm::normalize((1 - u - v) * t.normals[0] + u * t.normals[1] + v * t.normals[2]),
             material};
}

// The meshes of a scene in world space, each with a bounding sphere.
class Meshes {
 public:
  explicit Meshes(const Scene& scene) {
    for (const Instance& instance : scene.instances) {
      const Mesh& mesh = scene.meshes[instance.mesh];
      Body body{dvec3(0), 0, mesh.material, {}};
      const glm::dmat3 turn = glm::transpose(glm::inverse(glm::dmat3(instance.world_from_object)));
      for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        Triangle triangle;
        for (int k = 0; k < 3; ++k) {
          const uint32_t vertex = mesh.indices[i + k];
          triangle.corners[k] = dvec3(instance.world_from_object * glm::dvec4(mesh.positions[vertex], 1));
          triangle.normals[k] = turn * dvec3(mesh.normals[vertex]);
          body.center += triangle.corners[k];
        }
        body.triangles.push_back(triangle);
      }
      body.center /= 3.0 * double(body.triangles.size());
      for (const Triangle& triangle : body.triangles) {
        for (const dvec3& corner : triangle.corners)
          body.radius = std::max(body.radius, glm::distance(corner, body.center));
      }
      bodies_.push_back(std::move(body));
    }
  }

  std::optional<Hit> first_hit(const Ray& ray) const {
    std::optional<Hit> first;
    for (const Body& body : bodies_) {
      if (glm::length(glm::cross(body.center - ray.origin, ray.direction)) > 1.0001 * body.radius) continue;
      for (const Triangle& triangle : body.triangles) {
        const auto hit = hit_of(triangle, ray, body.material);
        if (hit && (!first || hit->distance < first->distance)) first = hit;
      }
    }
    return first;
  }

 private:
  struct Body {
    dvec3 center;
    double radius;
    int material;
    std::vector<Triangle> triangles;
  };
  std::vector<Body> bodies_;
};

inline dvec3 radiance(const Scene& scene, const Ray& ray, const Hit& hit) {
  const dvec3 position = ray.origin + ray.direction * hit.distance;
  dvec3 sum(0);
  for (const Light& light : scene.lights) {
    const Illumination in = illumination(light, position);
    const double cosine = glm::dot(hit.normal, in.to_light);
    if (cosine <= 0) continue;
    sum += material_brdf(scene.materials[hit.material], hit.normal, in.to_light, -ray.direction) *
           in.illuminance * cosine;
  }
  return sum;
}

}  // namespace lightgrid::lab::ray_caster
