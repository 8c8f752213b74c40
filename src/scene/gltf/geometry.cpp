#include "scene/gltf/geometry.h"

#include <cmath>

namespace lightgrid::gltf {
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
    for (uint32_t vertex : {a, b, c}) along_u[vertex] += u * weight, along_v[vertex] += v * weight;
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

}  // namespace lightgrid::gltf
