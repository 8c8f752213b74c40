// The triangles that a view draws: clusters in its frustum that face it, in drawing order.
#pragma once

#include <span>
#include <vector>

#include "culling/light_culler.h"
#include "plan/frame_plan.h"
#include "plan/visibility.h"
#include "renderer/gl_scene.h"
#include "shared/view_params.h"

namespace lightgrid {

// An instance's matrices in a view, computed once for all passes.
struct InstanceTransform {
  glm::dmat4 view_from_object;
  glm::mat4 clip_from_object;
  glm::mat3 directions, normals;  // view from object, for directions and for normals (base/facing.h)
  bool mirrored = false;          // front faces are clockwise
};

InstanceTransform instance_transform(const View& view, const Instance& instance);

// For glMultiDrawElementsBaseVertex; neighbouring clusters are joined.
struct IndexRanges {
  std::vector<GLsizei> counts;
  std::vector<const void*> offsets;
  std::vector<GLint> base_vertices;
};

IndexRanges index_ranges(const GlMesh& mesh, std::span<const uint32_t> clusters);

// The triangles of `ranges`, last to first. Requires reversed triangles (GlScene).
IndexRanges in_reverse(const IndexRanges& ranges, const GlScene& gpu);

// Clusters of one instance that are drawn together.
struct DrawItem {
  int instance;
  std::vector<uint32_t> clusters;  // clusters of its mesh, ascending
  IndexRanges ranges;              // index ranges of these clusters
};

using DrawList = std::vector<DrawItem>;

// front_to_back: by layers of distance, and within each layer as given. Passes that draw the same list agree
// on the visible surface where depths are equal: the last one.
enum class DrawOrder { front_to_back, as_given };

// The visible clusters of `instances`. transforms: one for each instance of the scene. far_m: the farthest
// distance of anything in view; it determines the layers. Conservative: what is left out changes no pixel.
DrawList make_draw_list(const GlScene& gpu, const View& view, const std::vector<int>& instances,
                        const std::vector<InstanceTransform>& transforms, double far_m, DrawOrder order);

// The depth prepass' result for each tile, on the host: nothing behind its greatest distance is visible.
struct TileDistances {
  std::vector<DepthInterval> intervals;  // least and greatest distance; empty: unknown
};

// The list without clusters that are behind every tile they may cover. Conservative.
DrawList without_hidden(const DrawList& list, const GlScene& gpu,
                        const std::vector<InstanceTransform>& transforms, const ViewParams& view,
                        const TileDistances& distances);

// Appends the mesh's indices to `indices`, cluster by cluster (meshoptimizer's meshlets), and returns the
// clusters. keep_order: one cluster with the triangles in the given order, for blended meshes, where the
// order is visible.
std::vector<TriangleCluster> append_clusters(const Mesh& mesh, bool keep_order,
                                             std::vector<uint32_t>& indices);

// Updates bounds and cones of the same clusters after vertices moved. `indices`: all that append_clusters
// appended.
void refresh_clusters(const Mesh& mesh, std::span<const uint32_t> indices,
                      std::vector<TriangleCluster>& clusters);

}  // namespace lightgrid
