// Which clusters of triangles a view may see: in its frustum, turned towards it, and not behind what is nearer.
#pragma once

#include <array>
#include <vector>

#include "passes/frame/frame.h"
#include "plan/visibility.h"

namespace lightgrid {

// What the depth prepass knows of each tile on the host: nothing behind its greatest distance is seen.
struct TileDistances {
  std::vector<DepthInterval> intervals;  // least and greatest distance; empty: nothing is known
};

// Index ranges for glMultiDrawElementsBaseVertex; neighbours are joined.
struct IndexRanges {
  std::vector<GLsizei> counts;
  std::vector<const void*> offsets;
  std::vector<GLint> base_vertices;
  uint32_t end_index = ~0u;  // of the last range
};

// Layers of distance from the eye, nearest first: what is drawn in their order is mostly drawn front to back.
constexpr int distance_layers = 5;

// Of one instance, by layer; a cluster is in the layer of its middle. Conservative: what is left out changes no pixel.
std::array<IndexRanges, distance_layers> visible_clusters(const Frame& f, const Frustum& frustum,
                                                          const TileDistances* distances, int instance,
                                                          const glm::dmat4& view_from_object);

}  // namespace lightgrid
