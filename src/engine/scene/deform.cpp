#include "scene/deform.h"

#include <cmath>

#include "scene/pose.h"

namespace lightgrid {
namespace {

// Twice the area, along the normal. In double: the product of two edges of 1e20 m overflows float.
glm::dvec3 area_normal(const Mesh& mesh, size_t triangle) {
  const glm::dvec3 a(mesh.positions[mesh.indices[triangle * 3]]),
      b(mesh.positions[mesh.indices[triangle * 3 + 1]]), c(mesh.positions[mesh.indices[triangle * 3 + 2]]);
  return glm::cross(b - a, c - a);
}

glm::vec3 unit_or(const glm::dvec3& v, const glm::vec3& fallback) {
  const double length = glm::length(v);
  return length > 0 && std::isfinite(length) ? glm::vec3(v / length) : fallback;
}

glm::vec3 any_across(const glm::vec3& normal) {
  const glm::vec3 axis = std::abs(normal.x) < 0.9f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
  return glm::normalize(axis - normal * glm::dot(axis, normal));
}

template <typename T>
void unshare(std::vector<T>& values, const std::vector<uint32_t>& indices) {
  if (values.empty()) return;
  std::vector<T> out(indices.size());
  for (size_t i = 0; i < indices.size(); ++i) out[i] = values[indices[i]];
  values = std::move(out);
}

}  // namespace

void make_flat_normals(Mesh& mesh) {
  unshare(mesh.positions, mesh.indices);
  unshare(mesh.uv0, mesh.indices);
  unshare(mesh.uv1, mesh.indices);
  unshare(mesh.colors, mesh.indices);
  mesh.tangents.clear();
  for (size_t i = 0; i < mesh.indices.size(); ++i) mesh.indices[i] = static_cast<uint32_t>(i);
  mesh.normals.resize(mesh.positions.size());
  for (size_t triangle = 0; triangle * 3 < mesh.indices.size(); ++triangle) {
    const glm::vec3 normal = unit_or(area_normal(mesh, triangle), {0, 0, 1});
    for (int corner = 0; corner < 3; ++corner) mesh.normals[triangle * 3 + corner] = normal;
  }
}

void repair_normals(Mesh& mesh) {
  bool any_missing = false;
  for (glm::vec3& normal : mesh.normals) {
    const double length = glm::length(glm::dvec3(normal));
    // Unit up to rounding: keeps the file's bits.
    if (std::abs(length - 1) < 1e-4) continue;
    normal = length > 1e-12 ? glm::vec3(glm::dvec3(normal) / length) : glm::vec3(0);
    any_missing |= normal == glm::vec3(0);
  }
  if (!any_missing) return;
  std::vector<glm::dvec3> sums(mesh.positions.size(), glm::dvec3(0));
  for (size_t triangle = 0; triangle * 3 < mesh.indices.size(); ++triangle)
    for (int corner = 0; corner < 3; ++corner)
      sums[mesh.indices[triangle * 3 + corner]] += area_normal(mesh, triangle);
  for (size_t i = 0; i < sums.size(); ++i)
    if (mesh.normals[i] == glm::vec3(0)) mesh.normals[i] = unit_or(sums[i], {0, 0, 1});
}

void make_tangents(Mesh& mesh, std::span<const glm::vec2> uv) {
  std::vector<glm::dvec3> along_u(mesh.positions.size(), glm::dvec3(0)), along_v = along_u;
  for (size_t at = 0; !uv.empty() && at + 2 < mesh.indices.size(); at += 3) {
    const uint32_t a = mesh.indices[at], b = mesh.indices[at + 1], c = mesh.indices[at + 2];
    const glm::dvec3 edge1 = glm::dvec3(mesh.positions[b]) - glm::dvec3(mesh.positions[a]);
    const glm::dvec3 edge2 = glm::dvec3(mesh.positions[c]) - glm::dvec3(mesh.positions[a]);
    const glm::dvec2 uv1 = glm::dvec2(uv[b]) - glm::dvec2(uv[a]), uv2 = glm::dvec2(uv[c]) - glm::dvec2(uv[a]);
    const double uv_area = uv1.x * uv2.y - uv2.x * uv1.y;
    if (uv_area == 0) continue;
    const double weight = glm::length(glm::cross(edge1, edge2)), sign = uv_area > 0 ? 1 : -1;
    const glm::dvec3 u(unit_or((edge1 * uv2.y - edge2 * uv1.y) * sign, glm::vec3(0)));
    const glm::dvec3 v(unit_or((edge2 * uv1.x - edge1 * uv2.x) * sign, glm::vec3(0)));
    for (uint32_t vertex : {a, b, c}) {
      along_u[vertex] += u * weight;
      along_v[vertex] += v * weight;
    }
  }
  mesh.tangents.resize(mesh.positions.size());
  for (size_t i = 0; i < mesh.tangents.size(); ++i) {
    const glm::dvec3 normal(mesh.normals[i]);
    const glm::dvec3 across = along_u[i] - normal * glm::dot(normal, along_u[i]);
    const bool usable = glm::length(across) > 1e-6 * glm::length(along_u[i]);
    const glm::vec3 tangent =
        usable ? unit_or(across, any_across(mesh.normals[i])) : any_across(mesh.normals[i]);
    // glTF's bitangent, cross(normal, tangent) * w, points up in the image, against growing v.
    const double along = glm::dot(glm::cross(normal, glm::dvec3(tangent)), along_v[i]);
    mesh.tangents[i] = glm::vec4(tangent, along > 0 ? -1.0f : 1.0f);
  }
}

namespace {

glm::vec3 unit_or_same(const glm::dvec3& v, const glm::vec3& fallback) {
  const double length = glm::length(v);
  return length > 0 && std::isfinite(length) ? glm::vec3(v / length) : fallback;
}

// The inverse transpose up to a factor, defined for singular matrices too.
glm::dmat3 cofactors(const glm::dmat3& m) {
  return {glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])};
}

// Calls set(value, sum of weighted displacements) for each value, if a target of nonzero weight displaces the
// attribute.
template <int N, typename Value, typename Set>
void displace(std::span<const MorphTarget> targets, std::span<const double> weights,
              std::vector<glm::vec<N, float>> MorphTarget::*attribute, std::vector<Value>& values,
              const Set& set) {
  std::vector<glm::vec<N, double>> sums;
  for (size_t target = 0; target < weights.size() && !values.empty(); ++target) {
    const std::vector<glm::vec<N, float>>& displacements = targets[target].*attribute;
    if (weights[target] == 0 || displacements.empty()) continue;
    sums.resize(values.size(), glm::vec<N, double>(0));
    for (size_t i = 0; i < sums.size(); ++i)
      sums[i] += glm::vec<N, double>(displacements[i]) * weights[target];
  }
  for (size_t i = 0; i < sums.size(); ++i) set(values[i], sums[i]);
}

}  // namespace

void apply_morph_targets(std::span<const MorphTarget> targets, std::span<const double> weights, Mesh& mesh) {
  displace(
      targets, weights, &MorphTarget::positions, mesh.positions,
      [](glm::vec3& position, const glm::dvec3& by) { position = glm::vec3(glm::dvec3(position) + by); });
  displace(targets, weights, &MorphTarget::normals, mesh.normals,
           [](glm::vec3& normal, const glm::dvec3& by) {
             normal = unit_or_same(glm::dvec3(normal) + by, normal);
           });
  displace(targets, weights, &MorphTarget::tangents, mesh.tangents,
           [](glm::vec4& tangent, const glm::dvec3& by) {
             const glm::vec3 direction(tangent);
             tangent = glm::vec4(unit_or_same(glm::dvec3(direction) + by, direction), tangent.w);
           });
  const auto add = [](glm::vec2& uv, const glm::dvec2& by) { uv = glm::vec2(glm::dvec2(uv) + by); };
  displace(targets, weights, &MorphTarget::uv0, mesh.uv0, add);
  displace(targets, weights, &MorphTarget::uv1, mesh.uv1, add);
  displace(targets, weights, &MorphTarget::colors, mesh.colors, [](glm::vec4& color, const glm::dvec4& by) {
    color = glm::clamp(glm::vec4(glm::dvec4(color) + by), 0.0f, 1.0f);
  });
}

void apply_skin(std::span<const glm::dmat4> joints, const SkinWeights& skin, bool mirrored, Mesh& mesh) {
  const glm::dmat4 object_from_world = winding_matrix(mirrored);
  for (size_t vertex = 0; vertex < mesh.positions.size(); ++vertex) {
    glm::dmat4 blend(0);
    double sum = 0;
    for (int k = 0; k < skin.sets * 4; ++k) {
      const size_t at = vertex * skin.sets + k / 4;
      const double weight = skin.weights[at][k % 4];
      if (weight == 0) continue;
      blend += joints[skin.joints[at][k % 4]] * weight;
      sum += weight;
    }
    if (!(sum > 0)) {
      blend = glm::dmat4(1);
      sum = 1;
    }
    blend = object_from_world * (blend / sum);
    mesh.positions[vertex] = glm::vec3(blend * glm::dvec4(mesh.positions[vertex], 1));
    const glm::dmat3 turn(blend);
    const double side = is_mirrored(blend) ? -1 : 1;
    if (!mesh.normals.empty()) {
      mesh.normals[vertex] =
          unit_or_same(cofactors(turn) * (side * glm::dvec3(mesh.normals[vertex])), mesh.normals[vertex]);
    }
    if (mesh.tangents.empty()) continue;
    const glm::vec3 tangent(mesh.tangents[vertex]);
    mesh.tangents[vertex] =
        glm::vec4(unit_or_same(turn * glm::dvec3(tangent), tangent), float(side) * mesh.tangents[vertex].w);
  }
}

TangentNeed tangent_need(const Material& material) {
  const TextureSlot& map =
      material.normal_map.texture >= 0 ? material.normal_map : material.clearcoat_normal_map;
  if (map.texture < 0) return TangentNeed::none;
  return map.uv_set == 0 ? TangentNeed::along_uv0 : TangentNeed::along_uv1;
}

void complete_mesh(TangentNeed tangents, Mesh& mesh) {
  if (mesh.normals.empty()) {
    make_flat_normals(mesh);
  } else {
    repair_normals(mesh);
  }
  if (tangents == TangentNeed::none) {
    mesh.tangents = {};
  } else if (mesh.tangents.empty()) {
    make_tangents(mesh, tangents == TangentNeed::along_uv0 ? mesh.uv0 : mesh.uv1);
  }
  for (glm::vec4& tangent : mesh.tangents) tangent.w = tangent.w < 0 ? -1.0f : 1.0f;
  measure(mesh);
}

// A sliver's height is below 1/16 of its longest edge, so twice its area is below 1/16 of the edge's square.
static void measure_edges(Mesh& mesh) {
  double longest = 0, sliver = 0;  // squared
  for (size_t triangle = 0; triangle * 3 < mesh.indices.size(); ++triangle) {
    const auto at = [&](size_t i) { return glm::dvec3(mesh.positions[mesh.indices[triangle * 3 + i % 3]]); };
    double edge = 0;
    for (size_t i = 0; i < 3; ++i) edge = std::max(edge, glm::dot(at(i + 1) - at(i), at(i + 1) - at(i)));
    longest = std::max(longest, edge);
    if (!(16 * glm::length(area_normal(mesh, triangle)) >= edge)) sliver = std::max(sliver, edge);
  }
  mesh.longest_edge = float(std::sqrt(longest) * (1 + 0x1p-20));
  mesh.longest_sliver = float(std::sqrt(sliver) * (1 + 0x1p-20));
}

void measure(Mesh& mesh) {
  mesh.bounds = {};
  for (const glm::vec3& position : mesh.positions) mesh.bounds.add(position);
  measure_edges(mesh);
}

void deform(const DeformingMesh& shape, std::span<const double> weights, std::span<const glm::dmat4> joints,
            bool mirrored, Mesh& mesh) {
  Mesh made = shape.base;
  made.name = mesh.name;
  made.material = mesh.material;
  apply_morph_targets(shape.targets, weights, made);
  if (shape.skin >= 0) apply_skin(joints, shape.skin_weights, mirrored, made);
  complete_mesh(shape.tangents, made);
  mesh = std::move(made);
}

std::optional<size_t> first_not_finite(const Mesh& mesh) {
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    const glm::vec3& p = mesh.positions[i];
    if (!std::isfinite(p.x + p.y + p.z)) return i;
  }
  return {};
}

}  // namespace lightgrid
