#include "scene/deform.h"

#include <cmath>

#include "scene/gltf/geometry.h"

namespace lightgrid {
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

void apply_skin(std::span<const glm::dmat4> joints, const SkinWeights& skin, Mesh& mesh) {
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
    blend /= sum;
    mesh.positions[vertex] = glm::vec3(blend * glm::dvec4(mesh.positions[vertex], 1));
    const glm::dmat3 turn(blend);
    if (!mesh.normals.empty()) {
      mesh.normals[vertex] =
          unit_or_same(cofactors(turn) * glm::dvec3(mesh.normals[vertex]), mesh.normals[vertex]);
    }
    if (mesh.tangents.empty()) continue;
    const glm::vec3 tangent(mesh.tangents[vertex]);
    mesh.tangents[vertex] =
        glm::vec4(unit_or_same(turn * glm::dvec3(tangent), tangent), mesh.tangents[vertex].w);
  }
}

void complete_mesh(TangentNeed tangents, Mesh& mesh) {
  if (mesh.normals.empty()) {
    gltf::make_flat_normals(mesh);
  } else {
    gltf::repair_normals(mesh);
  }
  if (tangents == TangentNeed::none) {
    mesh.tangents = {};
  } else if (mesh.tangents.empty()) {
    gltf::make_tangents(mesh, tangents == TangentNeed::along_uv0 ? mesh.uv0 : mesh.uv1);
  }
  for (glm::vec4& tangent : mesh.tangents) tangent.w = tangent.w < 0 ? -1.0f : 1.0f;
  mesh.bounds = {};
  for (const glm::vec3& position : mesh.positions) mesh.bounds.add(position);
}

void deform(const DeformingMesh& shape, std::span<const double> weights, std::span<const glm::dmat4> joints,
            Mesh& mesh) {
  Mesh made = shape.base;
  made.name = mesh.name;
  made.material = mesh.material;
  apply_morph_targets(shape.targets, weights, made);
  if (shape.skin >= 0) apply_skin(joints, shape.skin_weights, made);
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
