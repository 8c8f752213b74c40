// Draws shadow volumes into a stencil image, from which shaders read whether a light is hidden. It is not the
// depth image's stencil: that one counts the free slots of light indices.
#pragma once

#include "passes/light_volumes/light_volumes.h"
#include "passes/shadows/caster_volumes.h"

namespace lightgrid {

// light: an index into LightPlan::local.
inline bool has_own_shadow(const FramePlan& plan, size_t light) {
  return !plan.shadows.own_shadowed.empty() && plan.shadows.own_shadowed[light];
}

class CasterDraws {
 public:
  explicit CasterDraws(PassContext& work);
  size_t memory_bytes() const { return index_bytes_; }

  // Once a frame: makes volumes again if a light, an instance or a mesh moved, and copies the depth image.
  void begin_frame(PassContext& work, const RayScene& rays);

  // A stencil value for each pixel in the rectangles of these light volumes, which share no pixel: not 0
  // where a triangle is between light and surface. Counts faces behind the surface ("Carmack's reverse":
  // Everitt, Kilgard, "Practical and Robust Stenciled Shadow Volumes", 2002), modulo 256. Leaves another
  // framebuffer bound; the textures of IndexShadows::input are bound.
  void draw(PassContext& work, std::span<const LightVolume> lights) const;

  GLuint stencil() const { return stencil_; }  // to be sampled

 private:
  void make_volumes(PassContext& work, const RayScene& rays);

  std::vector<CasterVolumes::Range> of_light_;
  GlBuffer indices_;
  GlVertexArray array_;
  size_t index_bytes_ = 0;
  int shape_ = -1, instances_ = -1, lights_ = -1;  // versions of the scene that the volumes have
  std::optional<LightRanges> ranges_;
  GLuint stencil_ = 0, framebuffer_ = 0;  // the frame's
  glm::mat4 clip_from_rays_{1};
};

}  // namespace lightgrid
