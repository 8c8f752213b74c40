// The shadow maps of a view's lights, with the setting shadows=map: an approximation, in place of the rays of
// find_shadows (shadow_maps/shadow_maps.h). Each light whose shadows the plan calls for has its maps.
#pragma once

#include "plan/settings/shadows.h"
#include "renderer/moved_instances.h"
#include "renderer/pass_context.h"
#include "shadow_maps/shadow_maps.h"

namespace lightgrid {

class ViewShadowMaps {
 public:
  // With the settings of the view's plan, which stay as they are, but for `taps` and the most bytes.
  explicit ViewShadowMaps(PassContext& work)
      : ViewShadowMaps(work, work.plan.settings[setting::shadow_taps]) {}
  ViewShadowMaps(PassContext& work, int taps, size_t max_bytes = ~size_t(0));

  // When the view, lights or surfaces moved: which maps, and their sizes. shadowed: as FramePlan's, whether a
  // light has maps. Throws Error(input) where even the least sizes take more than the setting shadow-memory.
  // keeps: draw() then draws only those of which something changed since they were drawn.
  void look(const PassContext& work, const RayScene& rays, const std::vector<uint8_t>& shadowed,
            bool keeps = false);
  // All of them, unless they are kept. texels: of
  // atlas().bytes, for a reader besides kernels, into which all are drawn; null: its own.
  void draw(const RayScene& rays, const cl::Buffer& texels = {});
  size_t drawn_lights() const { return drawn_lights_; }  // of the last frame

  // Options of kernels that look them up: -DSHADOW_MAP, and those of ShadowMaps. Lights are in the order of
  // ShadowPlan::shadowed.
  std::string defines() const { return " -DSHADOW_MAP " + maps_.defines(); }
  ClArguments arguments() const { return maps_.arguments(); }

  const ShadowAtlas& atlas() const { return atlas_; }
  size_t memory_bytes() const { return maps_.memory_bytes(); }

 private:
  ShadowMapOptions options_;
  ShadowMaps maps_;
  ShadowAtlas atlas_;
  bool keeps_ = false;
  std::vector<uint8_t> kept_;  // faces of the atlas that are as they were drawn; empty: none
  MovedInstances moved_;
  size_t drawn_lights_ = 0;
};

}  // namespace lightgrid
