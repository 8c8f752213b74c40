#include "passes/frame/visible_clusters.h"

#include <array>
#include <cmath>
#include <iterator>

namespace lightgrid {
namespace {

// Float rounding of vertices, depth and intervals, all told under a part in 10^5 of the distance.
constexpr double rounding = 1e-5;

bool faces_away(const TriangleCluster& cluster, const glm::dvec3& eye_in_object) {
  if (cluster.cone_cutoff >= 1) return false;
  const glm::dvec3 from_eye = glm::dvec3(cluster.cone_apex) - eye_in_object;
  return glm::dot(from_eye, glm::dvec3(cluster.cone_axis)) >=
         (cluster.cone_cutoff + rounding) * glm::length(from_eye);
}

// Is the box behind the farthest surface of every tile that it may cover?
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
    low = glm::min(low, pixel), high = glm::max(high, pixel), nearest = std::min(nearest, distance);
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

// Layers of distance from the eye, nearest first: what is drawn in their order is mostly drawn front to back.
constexpr int distance_layers = 5;

// Each layer ends at twice the distance of the one before it; the last holds all beyond.
int layer_of(const Frame& f, const Aabb& box, const glm::dmat4& view_from_object) {
  const glm::dvec3 middle = 0.5 * (glm::dvec3(box.min) + glm::dvec3(box.max));
  const double distance = -(view_from_object * glm::dvec4(middle, 1)).z;
  int layer = distance_layers - 1;
  for (double end = f.plan.slice_far_m / 2; layer > 0 && distance < end; end /= 2) --layer;
  return layer;
}

using Layers = std::array<std::vector<uint32_t>, distance_layers>;

// Of one instance, by layer; a cluster is in the layer of its middle.
Layers visible_clusters(const Frame& f, const Frustum& frustum, const TileDistances* distances, int instance,
                        const glm::dmat4& view_from_object) {
  const GpuMesh& mesh = f.gpu.mesh(f.scene.instances[instance].mesh);
  const Mesh& source = f.scene.meshes[f.scene.instances[instance].mesh];
  const bool one_sided = !f.scene.materials[source.material].double_sided && !f.view.orthographic;
  const glm::dvec3 eye = one_sided ? glm::dvec3(glm::inverse(view_from_object)[3]) : glm::dvec3(0);
  Layers layers;
  for (uint32_t i = 0; i < mesh.clusters.size(); ++i) {
    const TriangleCluster& cluster = mesh.clusters[i];
    if (one_sided && faces_away(cluster, eye)) continue;
    if (!may_see_box(frustum, view_from_object, cluster.bounds)) continue;
    if (distances && !distances->intervals.empty() && hidden(cluster.bounds, view_from_object, f.params, *distances)) continue;
    layers[layer_of(f, cluster.bounds, view_from_object)].push_back(i);
  }
  return layers;
}

}  // namespace

std::vector<VisiblePart> visible_parts(const Frame& f, const std::vector<int>& instances, DrawOrder order,
                                       const TileDistances* distances) {
  const Frustum frustum = frustum_of(f.view);
  std::array<std::vector<VisiblePart>, distance_layers> parts;
  for (int index : instances) {
    const glm::dmat4 exact = view_from_object(f.view, f.scene.instances[index].world_from_object);
    Layers layers = visible_clusters(f, frustum, distances, index, exact);
    for (int layer = 0; layer < distance_layers; ++layer) {
      if (layers[layer].empty()) continue;
      parts[order == DrawOrder::front_to_back ? layer : 0].push_back({index, exact, std::move(layers[layer])});
    }
  }
  for (int layer = 1; layer < distance_layers; ++layer) {
    std::move(parts[layer].begin(), parts[layer].end(), std::back_inserter(parts[0]));
  }
  return std::move(parts[0]);
}

IndexRanges index_ranges(const GpuMesh& mesh, std::span<const uint32_t> clusters) {
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

IndexRanges in_reverse(const IndexRanges& ranges, const GpuScene& gpu) {
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

}  // namespace lightgrid
