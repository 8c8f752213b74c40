// The state of a RayScene.
#pragma once

#include <map>
#include <optional>

#include "cl/buffers.h"
#include "rays/ray_refit.h"

namespace lightgrid {

struct RayScene::State {
  ClDevice& device;
  ProgramCache& programs;
  RayOptions options;
  std::vector<RayMeshData> meshes{};
  std::vector<bool> changed{};  // meshes, since the instances were set
  std::vector<RayInstance> instances{};
  std::vector<uint32_t> first_triangles{};
  uint32_t triangle_count = 0, invalid = 0;
  int builds = 0;
  glm::dvec3 origin{0};
  bool has_instances = false, masked = false;
  RayMasks masks{};
  GrowingBuffer nodes{}, wide_nodes{}, wide_slots{}, triangles{}, places{}, mask_records{};
  std::optional<RayRefit> refit{};                 // of the tree; none: it has to be built
  std::map<std::string, NamedKernel> occlusion{};  // by defines

  void build(std::span<const RayInstance> instances, const RayBounds& bounds);
  void check() const;
  bool has_masks() const { return masked && masks.alphas() != nullptr; }
  bool lanes() const {
    return options.shape == KernelShape::automatic ? device.info().cpu : options.shape == KernelShape::lanes;
  }
};

}  // namespace lightgrid
