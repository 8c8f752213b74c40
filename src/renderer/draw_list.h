// What a view draws of its scene: clusters of triangles in its frustum, turned towards it, in drawing order.
#pragma once

#include <span>
#include <vector>

#include "culling/light_culler.h"
#include "plan/frame_plan.h"
#include "plan/visibility.h"
#include "renderer/gpu_scene.h"
#include "shared/view_params.h"

namespace lightgrid {

// An instance's matrices in a view, computed once for all passes.
struct InstanceTransform {
  glm::dmat4 view_from_object;
  glm::mat4 clip_from_object;
  glm::mat3 directions, normals;  // view from object: of directions, and of normals (its inverse transpose)
  bool mirrored = false;          // a negative determinant: front faces turn clockwise
};

InstanceTransform instance_transform(const View& view, const Instance& instance);

// For glMultiDrawElementsBaseVertex; neighbouring clusters are joined.
struct IndexRanges {
  std::vector<GLsizei> counts;
  std::vector<const void*> offsets;
  std::vector<GLint> base_vertices;
};

IndexRanges index_ranges(const GpuMesh& mesh, std::span<const uint32_t> clusters);

// The same triangles, last to first. For scenes with reversed triangles.
IndexRanges in_reverse(const IndexRanges& ranges, const GpuScene& gpu);

// Clusters of one instance that are drawn together.
struct DrawItem {
  int instance;
  std::vector<uint32_t> clusters;  // of its mesh, ascending
  IndexRanges ranges;              // of these clusters
};

using DrawList = std::vector<DrawItem>;

// front_to_back: by layers of distance, and within each as given. Passes that draw the same list agree on what is seen where
// surfaces share a depth: what comes last.
enum class DrawOrder { front_to_back, as_given };

// The visible clusters of `instances`. transforms: one for each instance of the scene. far_m: the farthest distance of
// anything in view, by which layers are cut. Conservative: what is left out changes no pixel.
DrawList make_draw_list(const GpuScene& gpu, const View& view, const std::vector<int>& instances,
                        const std::vector<InstanceTransform>& transforms, double far_m, DrawOrder order);

// What the depth prepass knows of each tile on the host: nothing behind its greatest distance is seen.
struct TileDistances {
  std::vector<DepthInterval> intervals;  // least and greatest distance; empty: nothing is known
};

// The list without clusters that lie behind every tile they may cover. Conservative.
DrawList without_hidden(const DrawList& list, const GpuScene& gpu, const std::vector<InstanceTransform>& transforms,
                        const ViewParams& view, const TileDistances& distances);

}  // namespace lightgrid
