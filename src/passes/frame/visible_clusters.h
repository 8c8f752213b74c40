// Which clusters of triangles a view may see: in its frustum, turned towards it, and not behind what is nearer.
#pragma once

#include <span>
#include <vector>

#include "passes/frame/frame.h"
#include "plan/visibility.h"

namespace lightgrid {

// What the depth prepass knows of each tile on the host: nothing behind its greatest distance is seen.
struct TileDistances {
  std::vector<DepthInterval> intervals;  // least and greatest distance; empty: nothing is known
};

// front_to_back: by layers of distance, and within each as given. Passes over the same instances in the same order agree
// on what is seen where surfaces share a depth: what comes last.
enum class DrawOrder { front_to_back, as_given };

// What is drawn of an instance at once.
struct VisiblePart {
  int instance;
  glm::dmat4 view_from_object;
  std::vector<uint32_t> clusters;  // of its mesh, ascending
};

// Conservative: what is left out changes no pixel.
std::vector<VisiblePart> visible_parts(const Frame& f, const std::vector<int>& instances, DrawOrder order,
                                       const TileDistances* distances);

// For glMultiDrawElementsBaseVertex; neighbours are joined.
struct IndexRanges {
  std::vector<GLsizei> counts;
  std::vector<const void*> offsets;
  std::vector<GLint> base_vertices;
};

IndexRanges index_ranges(const GpuMesh& mesh, std::span<const uint32_t> clusters);

// The same triangles, last to first. For plans with reversed triangles.
IndexRanges in_reverse(const IndexRanges& ranges, const GpuScene& gpu);

}  // namespace lightgrid
