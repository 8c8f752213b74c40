// Forward shading. The light loop is an included file: LIGHTS_GRID for the light grid's lists, LIGHTS_MASKS
// for its masks, LIGHTS_LIDR for light index images, LIGHTS_WORLD for the world grid, LIGHTS_OBJECT for
// lights of the object, LIGHTS_VOXELS for a voxel light buffer, LIGHTS_BUFFER for the sums of a light buffer,
// else every light.
// BLEND: output is multiplied by coverage, for blending over the image.
// PER_SAMPLE: runs once for each sample, with that sample's lights.
// FIRST_OF_DRAWS, ADDED: the first of an object's draws, and a further one that only adds light. For the use
// of alpha see src/engine/passes/shade_objects.cpp.

#include "shaders/common/surface.glsl"
#include "shaders/common/position.glsl"
#include "shared/shadow_bits.h"
#include "shared/light_table.h"
#include "shared/brdf.h"
#include "shared/volume_place.h"
#include "shaders/common/point_of_surface.glsl"
#if !defined(PER_SAMPLE) || defined(SAMPLES_IN_A_ROW)
#define AT_CENTRES
#endif
#include "shaders/common/per_sample.glsl"
#ifdef LIGHTS
#include "shaders/lights/punctual.glsl"
#include "shaders/lights/loops.glsl"
#if defined(LIGHTS_GRID) || defined(LIGHTS_MASKS) || defined(VOXEL_EXACT)
#include "shaders/lights/cell.glsl"
#include "shaders/lights/z_bins.glsl"
#endif
#if defined(LIGHTS_GRID)
#include "shaders/lights/grid.glsl"
#elif defined(LIGHTS_MASKS)
#include "shaders/lights/masks.glsl"
#elif defined(LIGHTS_LIDR)
#include "shaders/lights/lidr.glsl"
#elif defined(LIGHTS_WORLD)
#include "shaders/lights/world_grid.glsl"
#elif defined(LIGHTS_OBJECT)
#include "shaders/lights/object.glsl"
#elif defined(LIGHTS_VOXELS)
#include "shaders/lights/voxels.glsl"
#elif defined(LIGHTS_BUFFER)
#include "shaders/lights/buffer.glsl"
#else
#include "shaders/lights/all.glsl"
#endif
#ifdef LIGHT_ENTRIES
#include "shaders/lights/blocks.glsl"
#endif
#endif
#include "shaders/common/base_lighting.glsl"

layout(location = 0) out vec4 radiance;
#ifdef FIRST_OF_DRAWS
uniform float alpha;
#endif

void main() {
  Surface s = surface_here();
#ifdef MASK
  apply_mask(s.alpha);
#endif
#ifdef ADDED
  vec3 color = vec3(0.0);
#else
  vec3 color = s.base_color;
#endif
#ifdef UNLIT
  if (!s.unlit) {
#endif
    ShadingPoint p = point_of_surface(s);
#ifndef ADDED
    color = base_lighting(s, p);
#endif
#ifdef LIGHTS
    color += light_sum(p);
#endif
#ifdef UNLIT
  }
#endif
#ifdef BLEND
  if (s.alpha == 0.0) discard;  // invisible
  float coverage = min(s.alpha, 1.0);
  radiance = vec4(min(color, LARGEST_BLENDED) * coverage, coverage);
#elif defined(ADDED)
  radiance = vec4(color, 1.0);
#elif defined(FIRST_OF_DRAWS)
  radiance = vec4(color, alpha);
#else
  radiance = vec4(color, 1.0);
#endif
}
