// Which shadow maps a view's lights have, and how large: pure functions.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "scene/camera.h"
#include "shared/cull_settings.h"
#include "shared/shadow_face.h"

namespace lightgrid {

struct ShadowMapOptions {
  int size = 256;  // texels a side of a face of the light with the largest share of the screen; a power of 2
  int bits = 32;   // per texel: 16, 24 (which take 4 bytes) or 32 (float)
  int taps = 1;    // texels a side that a point asks: 1, or 3 or 5 with a filter
  int cascades = 4;  // per directional light: 1 to 4
  size_t max_bytes = size_t(256) << 20;
  KernelShape shape = KernelShape::automatic;  // lanes on a CPU, group elsewhere; the same bits
};

constexpr int min_shadow_size = 16;

struct ShadowAtlas {
  std::vector<ShadowFace> faces;
  // By light, in the order given: first face, and number of faces. A point light has six (+x, -x, +y, -y, +z,
  // -z), as has a spot that is wider than 150 degrees; a spot one; a directional light its cascades, nearest
  // first.
  std::vector<std::array<uint32_t, 2>> lights;
  size_t texels = 0, bytes = 0;
  int halvings = 0;  // how often all sizes were halved to fit into max_bytes
};

// A light's size is the option's, times the root of its share of the screen (of its range's sphere, at most
// the whole) over the largest share, rounded to a power of two, at least 16. Every light gets its maps: if
// they take more than max_bytes, the sizes of all are halved until they fit or all are 16.
//
// A cascade is a square around the sphere around a part of the view's frustum, moved by whole texels only, so
// that shadows do not swim: Valient, "Stable Rendering of Cascaded Shadow Maps" (ShaderX6, 2007). The parts
// end where the diagonal of the scene's box does, or the view; Zhang et al., "Parallel-Split Shadow Maps"
// (2006), has the splits.
//
// origin: of the RayScene. box: of all that casts or receives. radius_m of the lights is their range; where
// it is infinite, its face reaches the box's farthest corner, and its size is that of a range of the box's
// diagonal.
ShadowAtlas plan_shadow_atlas(std::span<const Light> lights, const View& view, const glm::dvec3& origin,
                              const WorldBox& box, const ShadowMapOptions& options);

// The faces of a directional light, without ShadowFace::first.
std::vector<ShadowFace> cascades_of(const Light& light, const View& view, const glm::dvec3& origin,
                                    const WorldBox& box, int size, const ShadowMapOptions& options);

namespace shadow_face {
// Looks along `ahead`; `extent` is without the border that the option's taps reach into.
ShadowFace towards(const glm::dvec3& ahead, double extent, int size, const ShadowMapOptions& options);
void set(float (&to)[3], const glm::dvec3& v);
}  // namespace shadow_face

}  // namespace lightgrid
