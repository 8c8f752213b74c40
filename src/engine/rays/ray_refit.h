// Moves triangles and boxes on the device, in a tree that stays.
#pragma once

#include <vector>

#include "cl/buffers.h"
#include "cl/launch.h"
#include "rays/ray_arrays.h"

namespace lightgrid {

// wide_nodes, slots: null without a wide tree (rays/wide_tree.h).
struct RayTreeBuffers {
  const cl::Buffer &nodes, &wide_nodes, &slots, &triangles, &places;
};

class RayRefit {
 public:
  // Takes a tree as it was built. Uploads the meshes and builds its kernels at the first refit.
  RayRefit(ClDevice& device, ProgramCache& programs, const RayArrays& arrays);

  // The instances of these numbers moved, or their meshes did. Enqueues, and waits for uploads alone.
  void refit(std::span<const size_t> moved, std::span<const RayInstance> instances,
             std::span<const RayMeshData> meshes, std::span<const uint32_t> first_triangles,
             const glm::dvec3& origin, const RayTreeBuffers& tree);
  void positions_changed() { has_positions_ = false; }
  size_t memory_bytes() const;

 private:
  // Some nodes of a list, by `a_work_item` each.
  struct Launch {
    uint32_t first, count, a_work_item;
  };
  void upload_meshes(std::span<const RayMeshData> meshes);
  void find_nodes(std::span<const RayMoved> moved);

  ClDevice& device_;
  ProgramCache& programs_;
  NamedKernel triangles_kernel_, nodes_kernel_;
  std::vector<uint32_t> places_;       // as RayArrays has them
  std::vector<int> parents_, levels_;  // of nodes; the root's parent is -1
  std::vector<int> node_of_place_;     // whose leaf the triangle is in; -1: none
  std::vector<size_t> moved_;          // that list_ is of
  std::vector<Launch> launches_;
  bool has_meshes_ = false, has_positions_ = false;
  GrowingBuffer positions_, indices_, records_, runs_, list_;
};

}  // namespace lightgrid
