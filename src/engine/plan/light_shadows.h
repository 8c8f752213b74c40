// Whose shadows a frame must find: for each light that casts, whether rays are traced for it, or why none
// are. A light is left out only if no pixel that it lights can be hidden from it: the image then has the same
// bits as with its rays. From the boxes of whole instances, in double; no triangle is read.
//
// A pixel's point P lies on an instance in view, within the frustum and the light's bounds (LightBounds). So
// do all points between light and P lie within these bounds, since a ball or a cone with its apex at the
// light holds them, and they are nearer to the light than P. P is hidden by what meets this segment, less its
// last millimetre, or by its own triangle, if light and eye lie on different sides of it.
#pragma once

#include <string>
#include <vector>

#include "scene/blended_casters.h"
#include "scene/camera.h"
#include "scene/view_lights.h"

namespace lightgrid {

enum class ShadowNeed {
  rays,
  no_caster,       // no instance of the scene that hides light meets the light's bounds
  no_receiver,     // the bounds are out of view, or no instance in view meets them
  casters_behind,  // of all receivers: light_shadows.cpp
  left_out,        // the technique shows fewer shadows: ShadowPlan::own_shadowed
  too_dim,         // plan/dim_lights.h
};

// Why no rays are traced. Empty: they are.
const char* reason_of(ShadowNeed need);

// The reason for a light whose shadows are those of the frame before (the setting shadow-reuse).
inline constexpr const char* unchanged_reason = "unchanged since the last frame";

struct LightShadow {
  int light = 0;  // number in the scene
  ShadowNeed need = ShadowNeed::rays;
  int caster = -1;  // rays, too_dim: the first instance that may cast within the light's bounds
};

// `reaches node 3 "wall"`, or the reason.
std::string words_of(const LightShadow& light, const Scene& scene);

// As `lightgrid plan` prints them: a line for each need, with its number of lights and the first of them.
// found_by: "rays", "maps" or "shadow volumes". Empty if no light casts.
std::string describe_shadows(const std::vector<LightShadow>& casting, const Scene& scene,
                             const char* found_by = "rays");

// The radius of the sphere that soft shadows of a light see, where lights without one of their own have this.
// 0: none is soft.
inline double source_of(const Light& light, double source_m) {
  return source_m > 0 && light.source_m >= 0 ? double(light.source_m) : source_m;
}

// All lights that cast, in the scene's order. `opaque` (masked ones too) and `blended`: the instances in
// view. source_m: as source_of has it; what hides any part of a light's sphere counts. by_blended: what
// blended instances hide.
std::vector<LightShadow> plan_light_shadows(const Scene& scene, const View& view, const LightRanges& ranges,
                                            const std::vector<int>& opaque, const std::vector<int>& blended,
                                            double source_m = 0,
                                            BlendedCasters by_blended = BlendedCasters::none);

// Returns whether a blended instance may cast, and hides as much as its alpha says.
bool has_veils(const Scene& scene, BlendedCasters by_blended);

}  // namespace lightgrid
