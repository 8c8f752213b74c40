// The shadow maps of a view's lights, with the setting shadows=map: an approximation, in place of the rays of
// find_shadows (shadow_maps/shadow_maps.h). Each light whose shadows the plan calls for has its maps.
#pragma once

#include "renderer/work.h"
#include "shadow_maps/shadow_maps.h"

namespace lightgrid {

class ViewShadowMaps {
 public:
  // With the settings of the view's plan, which stay as they are.
  explicit ViewShadowMaps(Work& work);

  // When the view, lights or surfaces moved: which maps, and their sizes. Throws Error(input) where even the
  // least sizes take more than the setting shadow-memory.
  void look(const Work& work, const glm::dvec3& origin);
  // All of them, in each frame.
  void draw(const RayScene& rays) { maps_.draw(rays, atlas_); }

  // What kernels need to look them up: -DSHADOW_MAP, and what ShadowMaps has. Lights are in
  // the order of FramePlan::shadowed.
  std::string defines() const { return " -DSHADOW_MAP " + maps_.defines(); }
  ClArguments arguments() const { return maps_.arguments(); }

  const ShadowAtlas& atlas() const { return atlas_; }
  size_t memory_bytes() const { return maps_.memory_bytes(); }

 private:
  ShadowMapOptions options_;
  ShadowMaps maps_;
  ShadowAtlas atlas_;
};

}  // namespace lightgrid
