#include "renderer/drawing/draw_list.h"

#include <meshoptimizer.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>

#include "base/facing.h"

namespace lightgrid {
namespace {

// Bounds the float rounding of vertices, depth and intervals together: under 1e-5 of the distance.
constexpr double rounding = 1e-5;

bool faces_away(const TriangleCluster& cluster, const glm::dvec3& eye_in_object) {
  if (cluster.cone_cutoff >= 1) return false;
  const glm::dvec3 from_eye = glm::dvec3(cluster.cone_apex) - eye_in_object;
  return glm::dot(from_eye, glm::dvec3(cluster.cone_axis)) >=
         (cluster.cone_cutoff + rounding) * glm::length(from_eye);
}

// True if the box is behind the farthest surface of every tile that it may cover.
bool hidden(const Aabb& box, const glm::dmat4& view_from_object, const ViewParams& view,
            const TileDistances& tiles) {
  double nearest = std::numeric_limits<double>::infinity();
  glm::dvec2 low(nearest), high(-nearest);
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec4 object(corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                            corner & 4 ? box.max.z : box.min.z, 1);
    const glm::dvec3 p(view_from_object * object);
    const double distance = -p.z;
    if (distance <= view.near_distance) return false;
    const double scale = view.orthographic ? 1 : 1 / distance;
    const glm::dvec2 pixel((p.x * scale - view.slope_x_offset) / view.slope_x_scale,
                           (p.y * scale - view.slope_y_offset) / view.slope_y_scale);
    low = glm::min(low, pixel);
    high = glm::max(high, pixel);
    nearest = std::min(nearest, distance);
  }
  nearest *= 1 - rounding;
  const auto tile_of = [&](double pixel, uint tiles_on_axis) {
    return int(std::clamp(std::floor(pixel / view.tile_size), 0.0, double(tiles_on_axis) - 1));
  };
  const int x0 = tile_of(low.x - 1, view.tiles_x), x1 = tile_of(high.x + 1, view.tiles_x);
  const int y0 = tile_of(low.y - 1, view.tiles_y), y1 = tile_of(high.y + 1, view.tiles_y);
  for (int y = y0; y <= y1; ++y) {
    for (int x = x0; x <= x1; ++x) {
      if (tiles.intervals[size_t(y) * view.tiles_x + x].far >= nearest) return false;
    }
  }
  return true;
}

// Layers of distance from the eye, nearest first: drawing in their order is mostly front to back.
constexpr int distance_layers = 5;

// Each layer ends at twice the distance of the previous one; the last has no end.
int layer_of(const Aabb& box, const glm::dmat4& view_from_object, double far_m) {
  const glm::dvec3 middle = 0.5 * (glm::dvec3(box.min) + glm::dvec3(box.max));
  const double distance = -(view_from_object * glm::dvec4(middle, 1)).z;
  int layer = distance_layers - 1;
  for (double end = far_m / 2; layer > 0 && distance < end; end /= 2) --layer;
  return layer;
}

using Layers = std::array<std::vector<uint32_t>, distance_layers>;

// The visible clusters of one instance, by layer; a cluster belongs to the layer of its centre.
Layers visible_clusters(const GlScene& gpu, const View& view, const Frustum& frustum, int instance,
                        const glm::dmat4& view_from_object, double far_m) {
  const Scene& scene = gpu.scene();
  const int mesh_index = scene.instances[instance].mesh;
  const GlMesh& mesh = gpu.mesh(mesh_index);
  const bool one_sided = !scene.materials[scene.meshes[mesh_index].material].double_sided &&
                         !view.orthographic && !is_singular(glm::dmat3(view_from_object));
  const glm::dvec3 eye = one_sided ? glm::dvec3(glm::inverse(view_from_object)[3]) : glm::dvec3(0);
  Layers layers;
  for (uint32_t i = 0; i < mesh.clusters.size(); ++i) {
    const TriangleCluster& cluster = mesh.clusters[i];
    if (one_sided && faces_away(cluster, eye)) continue;
    if (!may_see_box(frustum, view_from_object, cluster.bounds)) continue;
    layers[layer_of(cluster.bounds, view_from_object, far_m)].push_back(i);
  }
  return layers;
}

}  // namespace

InstanceTransform instance_transform(const View& view, const Instance& instance) {
  InstanceTransform t;
  t.view_from_object = view_from_object(view, instance.world_from_object);
  t.clip_from_object = glm::mat4(view.clip_from_view * t.view_from_object);
  t.directions = glm::mat3(t.view_from_object);
  t.mirrored = is_mirroring(glm::dmat3(instance.world_from_object));
  t.normals = glm::mat3(normal_matrix(glm::dmat3(t.view_from_object), t.mirrored));
  return t;
}

DrawList make_draw_list(const GlScene& gpu, const View& view, const std::vector<int>& instances,
                        const std::vector<InstanceTransform>& transforms, double far_m, DrawOrder order) {
  const Frustum frustum = frustum_of(view);
  std::array<DrawList, distance_layers> items;
  for (int index : instances) {
    Layers layers = visible_clusters(gpu, view, frustum, index, transforms[index].view_from_object, far_m);
    const GlMesh& mesh = gpu.mesh(gpu.scene().instances[index].mesh);
    for (int layer = 0; layer < distance_layers; ++layer) {
      if (layers[layer].empty()) continue;
      IndexRanges ranges = index_ranges(mesh, layers[layer]);
      items[order == DrawOrder::front_to_back ? layer : 0].push_back(
          {index, std::move(layers[layer]), std::move(ranges)});
    }
  }
  for (int layer = 1; layer < distance_layers; ++layer) {
    std::move(items[layer].begin(), items[layer].end(), std::back_inserter(items[0]));
  }
  return std::move(items[0]);
}

DrawList without_hidden(const DrawList& list, const GlScene& gpu,
                        const std::vector<InstanceTransform>& transforms, const ViewParams& view,
                        const TileDistances& distances) {
  if (distances.intervals.empty()) return list;
  DrawList seen;
  for (const DrawItem& item : list) {
    const GlMesh& mesh = gpu.mesh(gpu.scene().instances[item.instance].mesh);
    const glm::dmat4& view_from_object = transforms[item.instance].view_from_object;
    DrawItem kept{item.instance, {}, {}};
    for (const uint32_t i : item.clusters) {
      if (!hidden(mesh.clusters[i].bounds, view_from_object, view, distances)) kept.clusters.push_back(i);
    }
    if (kept.clusters.empty()) continue;
    kept.ranges =
        kept.clusters.size() == item.clusters.size() ? item.ranges : index_ranges(mesh, kept.clusters);
    seen.push_back(std::move(kept));
  }
  return seen;
}

IndexRanges index_ranges(const GlMesh& mesh, std::span<const uint32_t> clusters) {
  IndexRanges ranges;
  uint32_t end = ~0u;
  for (const uint32_t i : clusters) {
    const TriangleCluster& cluster = mesh.clusters[i];
    if (cluster.first_index == end) {
      ranges.counts.back() += GLsizei(cluster.index_count);
    } else {
      ranges.counts.push_back(GLsizei(cluster.index_count));
      ranges.offsets.push_back(reinterpret_cast<const void*>(size_t(cluster.first_index) * sizeof(uint32_t)));
      ranges.base_vertices.push_back(mesh.base_vertex);
    }
    end = cluster.first_index + cluster.index_count;
  }
  return ranges;
}

IndexRanges in_reverse(const IndexRanges& ranges, const GlScene& gpu) {
  IndexRanges reversed;
  for (size_t i = ranges.counts.size(); i-- > 0;) {
    const size_t end = size_t(ranges.offsets[i]) + size_t(ranges.counts[i]) * sizeof(uint32_t);
    const size_t first = 2 * size_t(gpu.index_count()) * sizeof(uint32_t) - end;
    reversed.counts.push_back(ranges.counts[i]);
    reversed.offsets.push_back(reinterpret_cast<const void*>(first));
    reversed.base_vertices.push_back(ranges.base_vertices[i]);
  }
  return reversed;
}

namespace {

// Large enough that triangles dominate the cost of a draw, small enough that most clusters are either in view
// or outside.
constexpr size_t max_vertices = 128, max_triangles = 128;
// Weight by which meshlets prefer triangles that face one way, so that whole clusters are back-facing.
constexpr float cone_weight = 0.5f;

}  // namespace

std::vector<TriangleCluster> append_clusters(const Mesh& mesh, bool keep_order,
                                             std::vector<uint32_t>& indices) {
  std::vector<TriangleCluster> clusters;
  if (keep_order || mesh.indices.size() <= 3 * max_triangles) {
    clusters.push_back({uint32_t(indices.size()), uint32_t(mesh.indices.size()), mesh.bounds});
    indices.insert(indices.end(), mesh.indices.begin(), mesh.indices.end());
    return clusters;
  }
  const float* positions = &mesh.positions[0].x;
  const size_t bound = meshopt_buildMeshletsBound(mesh.indices.size(), max_vertices, max_triangles);
  std::vector<meshopt_Meshlet> meshlets(bound);
  std::vector<unsigned> vertices(bound * max_vertices);
  std::vector<unsigned char> corners(bound * max_triangles * 3);
  meshlets.resize(meshopt_buildMeshlets(meshlets.data(), vertices.data(), corners.data(), mesh.indices.data(),
                                        mesh.indices.size(), positions, mesh.positions.size(),
                                        sizeof(glm::vec3), max_vertices, max_triangles, cone_weight));
  for (const meshopt_Meshlet& meshlet : meshlets) {
    TriangleCluster& cluster = clusters.emplace_back();
    cluster.first_index = uint32_t(indices.size());
    cluster.index_count = meshlet.triangle_count * 3;
    const unsigned* vertex = &vertices[meshlet.vertex_offset];
    const unsigned char* corner = &corners[meshlet.triangle_offset];
    for (size_t i = 0; i < cluster.index_count; ++i) indices.push_back(vertex[corner[i]]);
    for (size_t i = 0; i < meshlet.vertex_count; ++i) cluster.bounds.add(mesh.positions[vertex[i]]);
    const meshopt_Bounds b = meshopt_computeMeshletBounds(vertex, corner, meshlet.triangle_count, positions,
                                                          mesh.positions.size(), sizeof(glm::vec3));
    cluster.cone_apex = {b.cone_apex[0], b.cone_apex[1], b.cone_apex[2]};
    cluster.cone_axis = {b.cone_axis[0], b.cone_axis[1], b.cone_axis[2]};
    cluster.cone_cutoff = b.cone_cutoff;
  }
  return clusters;
}

void refresh_clusters(const Mesh& mesh, std::span<const uint32_t> indices,
                      std::vector<TriangleCluster>& clusters) {
  if (clusters.size() == 1) {
    clusters[0].bounds = mesh.bounds;
    clusters[0].cone_cutoff = 2;
    return;
  }
  for (TriangleCluster& cluster : clusters) {
    const auto own = indices.subspan(cluster.first_index - clusters[0].first_index, cluster.index_count);
    cluster.bounds = {};
    for (const uint32_t i : own) cluster.bounds.add(mesh.positions[i]);
    const meshopt_Bounds b = meshopt_computeClusterBounds(own.data(), own.size(), &mesh.positions[0].x,
                                                          mesh.positions.size(), sizeof(glm::vec3));
    cluster.cone_apex = {b.cone_apex[0], b.cone_apex[1], b.cone_apex[2]};
    cluster.cone_axis = {b.cone_axis[0], b.cone_axis[1], b.cone_axis[2]};
    cluster.cone_cutoff = b.cone_cutoff;
  }
}

}  // namespace lightgrid
