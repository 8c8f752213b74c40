#include "reference/scene_surfaces.h"

#include <cmath>

namespace lightgrid {
namespace {

using glm::dvec2, glm::dvec3, glm::dvec4, glm::dmat3, glm::dmat4;

dmat3 xyw_of(const std::array<dvec4, 3>& corners) {
  const auto xyw = [](const dvec4& c) { return dvec3(c.x, c.y, c.w); };
  return {xyw(corners[0]), xyw(corners[1]), xyw(corners[2])};
}

// The weighted mean of values at vertices.
template <typename Values>
auto mean(const TriangleInView& triangle, const dvec3& weights, const Values& values) {
  using Wide = glm::vec<Values::value_type::length(), double>;
  Wide sum(0);
  for (int k = 0; k < 3; ++k) sum += weights[k] * Wide(values[triangle.vertices[k]]);
  return sum;
}

}  // namespace

// The corners' weights at a place, and their change from there to the next pixel.
struct SceneSurfaces::Weights {
  dvec3 here, right, up;  // the first adds up to 1, the others to 0
  dvec3 unscaled;         // corners * unscaled: the place, with w = 1
};

double TriangleInView::turn() const { return glm::determinant(xyw_of(corners)); }

TriangleInView SceneSurfaces::triangle(int instance, const std::array<uint32_t, 3>& vertices) const {
  const Instance& shown = scene_.instances[instance];
  const dmat4 clip = view_.clip_from_view * view_from_object(view_, shown.world_from_object);
  TriangleInView made{instance, vertices, {}};
  for (int k = 0; k < 3; ++k)
    made.corners[k] = clip * dvec4(dvec3(scene_.meshes[shown.mesh].positions[vertices[k]]), 1);
  return made;
}

// Solves corners * weights = place, which is linear in the place, and divides by the sum.
SceneSurfaces::Weights SceneSurfaces::weights_at(const TriangleInView& triangle, const dvec2& place) const {
  const dmat3 solve = glm::inverse(xyw_of(triangle.corners));
  const dvec3 w = solve * dvec3(2 * place.x / view_.width - 1, 2 * place.y / view_.height - 1, 1);
  const dvec3 dx = solve[0] * (2.0 / view_.width), dy = solve[1] * (2.0 / view_.height);
  const auto sum = [](const dvec3& v) { return v.x + v.y + v.z; };
  const dvec3 here = w / sum(w);
  return {here, (dx - here * sum(dx)) / sum(w), (dy - here * sum(dy)) / sum(w), w};
}

std::optional<double> SceneSurfaces::depth_at(const TriangleInView& triangle, const dvec2& place) const {
  const Weights w = weights_at(triangle, place);
  if (!(w.unscaled.x >= 0 && w.unscaled.y >= 0 && w.unscaled.z >= 0)) return {};
  if (!(w.unscaled.x + w.unscaled.y + w.unscaled.z > 0)) return {};
  const auto& c = triangle.corners;
  return w.unscaled.x * c[0].z + w.unscaled.y * c[1].z + w.unscaled.z * c[2].z;
}

dvec4 SceneSurfaces::sampled(const TextureSlot& slot, const TriangleInView& triangle, const Weights& w) {
  const Mesh& mesh = scene_.meshes[scene_.instances[triangle.instance].mesh];
  const std::vector<glm::vec2>& set = slot.uv_set == 1 ? mesh.uv1 : mesh.uv0;
  auto found = samplers_.find(slot.texture);
  if (found == samplers_.end()) {
    const Texture& texture = scene_.textures[slot.texture];
    found = samplers_.try_emplace(slot.texture, scene_.bitmaps[texture.bitmap], texture).first;
  }
  const glm::dmat3x2 uv_from_vertex(slot.uv_from_vertex);
  const auto uv = [&](const dvec3& weights, double offset) {
    return uv_from_vertex * dvec3(set.empty() ? dvec2(0) : mean(triangle, weights, set), offset);
  };
  return found->second.at(uv(w.here, 1), uv(w.right, 0), uv(w.up, 0));
}

dvec4 SceneSurfaces::color_of(const TriangleInView& triangle, const Weights& w) {
  const Mesh& mesh = scene_.meshes[scene_.instances[triangle.instance].mesh];
  const Material& m = scene_.materials[mesh.material];
  dvec4 color(m.base_color);
  if (m.base_color_map.texture >= 0) color *= sampled(m.base_color_map, triangle, w);
  if (!mesh.colors.empty()) color *= mean(triangle, w.here, mesh.colors);
  return color;
}

dvec4 SceneSurfaces::base_color_at(const TriangleInView& triangle, const dvec2& place) {
  return color_of(triangle, weights_at(triangle, place));
}

Surface SceneSurfaces::surface_at(const TriangleInView& triangle, const dvec2& place) {
  const Weights w = weights_at(triangle, place);
  const Instance& instance = scene_.instances[triangle.instance];
  const Mesh& mesh = scene_.meshes[instance.mesh];
  const Material& m = scene_.materials[mesh.material];
  Surface s;
  s.unlit = m.unlit;
  s.base_color = dvec3(color_of(triangle, w));
  if (m.unlit) return s;
  s.metallic = m.metallic, s.roughness = m.roughness, s.emissive = m.emissive;
  if (m.metallic_roughness_map.texture >= 0) {
    const dvec4 texel = sampled(m.metallic_roughness_map, triangle, w);
    s.roughness *= texel.g, s.metallic *= texel.b;
  }
  if (m.occlusion_map.texture >= 0)
    s.occlusion = 1 + m.occlusion_strength * (sampled(m.occlusion_map, triangle, w).r - 1);
  if (m.emissive_map.texture >= 0) s.emissive *= dvec3(sampled(m.emissive_map, triangle, w));

  const dmat3 directions(view_from_object(view_, instance.world_from_object));
  const bool mirrored = glm::determinant(directions) < 0, back = (triangle.turn() < 0) != mirrored;
  const dvec3 geometric =
      glm::normalize(glm::transpose(glm::inverse(directions)) * mean(triangle, w.here, mesh.normals));
  const auto bent = [&](const TextureSlot& map, double scale) {
    dvec3 n = geometric;
    if (map.texture < 0) return back ? -n : n;
    const dvec4 tangent = mean(triangle, w.here, mesh.tangents);
    dvec3 t = directions * dvec3(tangent);
    t -= n * glm::dot(n, t);
    if (glm::dot(t, t) > 1e-12) {
      t = glm::normalize(t);
      const dvec3 bitangent = glm::cross(n, t) * tangent.w * (mirrored ? -1.0 : 1.0);
      dvec3 mapped = dvec3(sampled(map, triangle, w)) * 2.0 - 1.0;
      mapped.x *= scale, mapped.y *= scale;
      n = glm::normalize(mapped.x * t + mapped.y * bitangent + mapped.z * n);
    }
    return back ? -n : n;
  };
  s.normal = bent(m.normal_map, m.normal_scale);
  const double root = (m.ior - 1.0) / (m.ior + 1.0);
  dvec3 color_of_f0 = m.specular_color;
  s.f90 = m.specular;
  if (m.specular_map.texture >= 0) s.f90 *= sampled(m.specular_map, triangle, w).a;
  if (m.specular_color_map.texture >= 0) color_of_f0 *= dvec3(sampled(m.specular_color_map, triangle, w));
  s.f0 = glm::min(color_of_f0 * root * root, dvec3(1)) * s.f90;
  s.subsurface_color = m.model.subsurface_color, s.roll_off = m.model.roll_off,
  s.minnaert_k = m.model.minnaert_k;
  if (m.clearcoat == 0) return s;
  s.coat = m.clearcoat, s.coat_roughness = m.clearcoat_roughness;
  if (m.clearcoat_map.texture >= 0) s.coat *= sampled(m.clearcoat_map, triangle, w).r;
  if (m.clearcoat_roughness_map.texture >= 0)
    s.coat_roughness *= sampled(m.clearcoat_roughness_map, triangle, w).g;
  s.coat_normal = bent(m.clearcoat_normal_map, m.clearcoat_normal_scale);
  return s;
}

}  // namespace lightgrid
