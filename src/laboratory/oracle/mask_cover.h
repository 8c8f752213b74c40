// Where a masked triangle lets light through, in double.
#pragma once

#include <map>

#include "oracle/scene_surfaces.h"

namespace lightgrid::lab {

enum class Cover { opaque, clear, either };

// Alpha at a point of a triangle against its material's cutoff: base colour, vertex colours and the texture's
// base level, filtered as where it is magnified. Below the cutoff it is clear.
class MaskCover {
 public:
  explicit MaskCover(const Scene& scene);  // outlives it

  // weights: of the triangle's corners, with a sum of 1; error: each is known to within this. Opaque
  // materials are opaque everywhere. May be called from several threads.
  Cover at(int instance, uint32_t triangle, const glm::dvec3& weights, const glm::dvec3& error) const;

  struct Range {
    double least = 0, most = 0;
  };
  // Alpha there, of masked and blended materials; not limited to 0 to 1.
  Range alpha(int instance, uint32_t triangle, const glm::dvec3& weights, const glm::dvec3& error) const;

 private:
  Range alpha_of_map(const TextureSlot& slot, const glm::dvec2& uv, const glm::dvec2& error) const;

  const Scene& scene_;
  mutable std::map<int, TextureSampler> samplers_;  // by texture; reading the base level changes none
};

}  // namespace lightgrid::lab
