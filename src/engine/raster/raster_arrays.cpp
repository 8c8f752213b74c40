#include "raster/raster_arrays.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/error.h"
#include "base/facing.h"

namespace lightgrid {
namespace {

constexpr size_t max_indices = 0xffffffffu - 64;
constexpr size_t max_triangles = 0x7fffffffu;  // kernels compare their numbers as signed ones
constexpr double min_cosine = 0.1;             // wider cones face away from next to nothing

using Corners = std::array<glm::dvec3, 3>;

bool all_finite(const glm::dvec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// The cone around the triangles' normals.
void add_cone(const std::vector<Corners>& triangles, RasterCluster& cluster) {
  std::vector<glm::dvec3> normals;
  glm::dvec3 sum{0};
  for (const Corners& t : triangles) {
    const glm::dvec3 normal = glm::cross(t[1] - t[0], t[2] - t[0]);
    const double length = glm::length(normal);
    if (!(length > 0)) continue;  // it covers nothing
    normals.push_back(normal / length);
    sum += normals.back();
  }
  cluster.sine = RASTER_NO_CONE;
  if (!(glm::length(sum) > 0)) return;
  const glm::vec3 axis(glm::normalize(sum));
  double cosine = 1;
  for (const glm::dvec3& normal : normals) cosine = std::min(cosine, glm::dot(normal, glm::dvec3(axis)));
  if (!(cosine > min_cosine)) return;
  cluster.axis_x = axis.x;
  cluster.axis_y = axis.y;
  cluster.axis_z = axis.z;
  cluster.sine = float(std::sqrt(std::max(0.0, 1 - cosine * cosine)) + 1e-5);
}

RasterCluster cluster_of(const std::vector<Corners>& triangles) {
  RasterCluster cluster{};
  cluster.sine = RASTER_NO_CONE;
  glm::dvec3 low{HUGE_VAL}, high{-HUGE_VAL};
  for (const Corners& t : triangles) {
    for (const glm::dvec3& p : t) {
      if (!all_finite(p)) {
        cluster.half_x = cluster.half_y = cluster.half_z = cluster.radius = HUGE_VALF;
        return cluster;
      }
      low = glm::min(low, p);
      high = glm::max(high, p);
    }
  }
  const glm::dvec3 center(glm::vec3((low + high) * 0.5));
  // Rounded up, from the center as it was rounded.
  const glm::dvec3 half = glm::max(high - center, center - low);
  const auto up = [](double v) { return std::nextafter(float(v), HUGE_VALF); };
  double radius = 0;
  for (const Corners& t : triangles) {
    for (const glm::dvec3& p : t) radius = std::max(radius, glm::length(p - center));
  }
  cluster.center_x = float(center.x);
  cluster.center_y = float(center.y);
  cluster.center_z = float(center.z);
  cluster.half_x = up(half.x);
  cluster.half_y = up(half.y);
  cluster.half_z = up(half.z);
  cluster.radius = up(radius);
  add_cone(triangles, cluster);
  return cluster;
}

// In clip space, of an instance: whole blocks of 16.
size_t clip_room(const RasterMeshPlace& mesh) { return (size_t(mesh.vertices) + 15) / 16 * 16; }

std::vector<uint32_t> mesh_order(const RasterMesh& mesh) {
  std::vector<uint32_t> order(mesh.indices.size() / 3);
  std::iota(order.begin(), order.end(), 0u);
  return order;
}

void append_clusters(const RasterMesh& mesh, RasterMeshes& all) {
  const std::vector<uint32_t> order = mesh.drawing_order ? mesh_order(mesh) : cluster_order(mesh);
  std::vector<Corners> triangles;
  for (size_t first = 0; first < order.size(); first += RASTER_CLUSTER) {
    const size_t end = std::min(order.size(), first + RASTER_CLUSTER), place = all.cluster_triangles.size();
    triangles.clear();
    for (size_t i = first; i < end; ++i) {
      const uint32_t* corners = &mesh.indices[3 * size_t(order[i])];
      all.cluster_triangles.push_back(order[i]);
      all.cluster_indices.insert(all.cluster_indices.end(), corners, corners + 3);
      triangles.push_back(
          {mesh.positions[corners[0]], mesh.positions[corners[1]], mesh.positions[corners[2]]});
    }
    RasterCluster& cluster = all.clusters.emplace_back(cluster_of(triangles));
    cluster.first = uint32_t(place);
    cluster.count = uint32_t(end - first);
  }
}

void append_positions(std::span<const glm::vec3> positions, std::vector<float>& to) {
  for (size_t first = 0; first < positions.size(); first += 16) {
    for (int axis = 0; axis < 3; ++axis) {
      for (size_t i = first; i < first + 16; ++i)
        to.push_back(i < positions.size() ? positions[i][axis] : 0.0f);
    }
  }
}

// Before any memory is taken: meshes may share their arrays.
void check_meshes(std::span<const RasterMesh> meshes) {
  size_t indices = 0, vertices = 0;
  for (const RasterMesh& mesh : meshes) {
    indices += mesh.indices.size();
    vertices += mesh.positions.size() + 15;
  }
  if (std::max(indices, vertices) > max_indices)
    throw machine_error("rasterizer: meshes have 2^32 indices or vertices or more");
  for (size_t m = 0; m < meshes.size(); ++m) {
    const RasterMesh& mesh = meshes[m];
    if (mesh.indices.size() % 3 != 0)
      throw input_error("rasterizer: mesh {}: {} indices are no triangles", m, mesh.indices.size());
    const auto largest = std::max_element(mesh.indices.begin(), mesh.indices.end());
    if (largest != mesh.indices.end() && *largest >= mesh.positions.size()) {
      throw input_error("rasterizer: mesh {}: index {} is past its {} positions", m, *largest,
                        mesh.positions.size());
    }
  }
}

// Before any memory is taken: instances share their meshes.
void check_instance_numbers(std::span<const RasterInstance> instances,
                            std::span<const RasterMeshPlace> meshes) {
  size_t triangles = 0, vertices = 0;
  for (const RasterInstance& instance : instances) {
    const RasterMeshPlace& mesh = meshes[instance.mesh];
    triangles += mesh.triangles;
    vertices += clip_room(mesh);
  }
  // Clusters are no more than triangles.
  if (triangles > max_triangles || vertices > max_indices)
    throw machine_error("rasterizer: instances have 2^31 triangles or 2^32 vertices or more");
}

constexpr int levels = 10;                // levels of the curve: it has 2^levels cells per side
constexpr size_t triangles_a_cell = 512;  // for the coarse cells: some clusters for each of six directions

glm::dvec3 corner_of(const RasterMesh& mesh, size_t triangle, int k) {
  return mesh.positions[mesh.indices[3 * triangle + k]];
}

// Place on the Z-order curve (Morton 1966) of a point in the unit cube.
uint64_t morton(const glm::dvec3& p) {
  uint64_t code = 0;
  for (int bit = levels - 1; bit >= 0; --bit) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto cell = uint32_t(std::clamp(p[axis], 0.0, 1.0) * ((1 << levels) - 1));
      code = code << 1 | (cell >> bit & 1);
    }
  }
  return code;
}

// The side of a cube that the triangle faces: 0 to 5.
uint64_t facing(const RasterMesh& mesh, size_t triangle) {
  const glm::dvec3 a = corner_of(mesh, triangle, 0);
  const glm::dvec3 normal = glm::cross(corner_of(mesh, triangle, 1) - a, corner_of(mesh, triangle, 2) - a);
  int axis = 0;
  for (int k = 1; k < 3; ++k) {
    if (std::abs(normal[k]) > std::abs(normal[axis])) axis = k;
  }
  return uint64_t(2 * axis + (normal[axis] < 0));
}

// Levels that coarse cells have: a surface meets about 4 to the power of that many.
int coarse_levels(size_t triangles) {
  int n = 0;
  while (n < levels && triangles > triangles_a_cell << 2 * n) ++n;
  return n;
}

}  // namespace

std::vector<uint32_t> cluster_order(const RasterMesh& mesh) {
  const size_t count = mesh.indices.size() / 3;
  glm::dvec3 low{HUGE_VAL}, high{-HUGE_VAL};
  for (const uint32_t i : mesh.indices) {
    const glm::dvec3 p = mesh.positions[i];
    if (!std::isfinite(p.x + p.y + p.z)) continue;
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  const double extent = std::max({high.x - low.x, high.y - low.y, high.z - low.z, 1e-300});
  const int fine_bits = 3 * (levels - coarse_levels(count));
  std::vector<uint64_t> keys(count);
  for (size_t t = 0; t < count; ++t) {
    const glm::dvec3 center = (corner_of(mesh, t, 0) + corner_of(mesh, t, 1) + corner_of(mesh, t, 2)) / 3.0;
    const bool finite = std::isfinite(center.x + center.y + center.z);
    const uint64_t code = finite ? morton((center - low) / extent) : 0;
    const uint64_t fine = code & ((uint64_t(1) << fine_bits) - 1);
    keys[t] = (code >> fine_bits) << (fine_bits + 3) | (finite ? facing(mesh, t) : 7) << fine_bits | fine;
  }
  std::vector<uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return keys[a] < keys[b]; });
  return order;
}

RasterMeshes raster_meshes(std::span<const RasterMesh> meshes) {
  check_meshes(meshes);
  RasterMeshes all;
  for (const RasterMesh& mesh : meshes) {
    RasterMeshPlace place;
    place.first_index = uint32_t(all.indices.size());
    place.triangles = uint32_t(mesh.indices.size() / 3);
    place.first_vertex = all.places.empty() ? 0 : all.places.back().first_vertex + all.places.back().vertices;
    place.vertices = uint32_t(mesh.positions.size());
    place.first_position = uint32_t(all.positions.size() / 3);
    place.first_cluster = uint32_t(all.clusters.size());
    place.clusters = (place.triangles + RASTER_CLUSTER - 1) / RASTER_CLUSTER;
    place.drawing_order = mesh.drawing_order;
    all.places.push_back(place);
    all.indices.insert(all.indices.end(), mesh.indices.begin(), mesh.indices.end());
    append_positions(mesh.positions, all.positions);
    append_clusters(mesh, all);
  }
  return all;
}

void check_raster_instances(std::span<const RasterInstance> instances,
                            std::span<const RasterMeshPlace> meshes, bool drawing_order) {
  for (size_t i = 0; i < instances.size(); ++i) {
    const RasterInstance& instance = instances[i];
    if (instance.mesh < 0 || size_t(instance.mesh) >= meshes.size()) {
      throw input_error("rasterizer: instance {}: there is no mesh {} of {}", i, instance.mesh,
                        meshes.size());
    }
    if (drawing_order && !meshes[instance.mesh].drawing_order) {
      throw input_error(
          "rasterizer: instance {}: mesh {} has no drawing_order, which the view's options need", i,
          instance.mesh);
    }
    const glm::dmat4& m = instance.world_from_object;
    for (int column = 0; column < 4; ++column) {
      for (int row = 0; row < 4; ++row) {
        if (!std::isfinite(m[column][row]))
          throw input_error("rasterizer: instance {}: its matrix holds {}", i, m[column][row]);
      }
      if (m[column][3] != (column == 3 ? 1 : 0))
        throw input_error("rasterizer: instance {}: its matrix is not affine", i);
    }
  }
}

RasterInstances raster_instances(std::span<const RasterInstance> instances,
                                 std::span<const RasterMeshPlace> meshes) {
  check_instance_numbers(instances, meshes);
  RasterInstances all;
  size_t triangles = 0;
  for (size_t i = 0; i < instances.size(); ++i) {
    const RasterInstance& instance = instances[i];
    const RasterMeshPlace& mesh = meshes[instance.mesh];
    triangles += mesh.triangles;
    RasterInstanceRecord record{};
    record.first_triangle = uint32_t(triangles - mesh.triangles);
    record.triangle_count = mesh.triangles;
    record.first_index = mesh.first_index;
    record.first_vertex = mesh.first_vertex;
    record.vertex_count = mesh.vertices;
    record.first_position = mesh.first_position;
    record.first_clip_vertex = uint32_t(all.clip_vertices);
    const bool mirrored = is_mirroring(glm::dmat3(instance.world_from_object));
    record.flags = (instance.two_sided ? RASTER_TWO_SIDED : 0) | (mirrored ? RASTER_MIRRORED : 0);
    record.alpha_material = instance.alpha_material;
    all.records.push_back(record);
    all.clip_vertices += clip_room(mesh);
    all.triangle_instance.insert(all.triangle_instance.end(), mesh.triangles, uint32_t(i));
    for (uint32_t v = 0; v < mesh.vertices; v += RASTER_VERTEX_RUN)
      all.vertex_runs.push_back({uint32_t(i), v});
    for (uint32_t c = 0; c < mesh.clusters; ++c) all.pairs.push_back({uint32_t(i), mesh.first_cluster + c});
  }
  return all;
}

}  // namespace lightgrid
