// How much of a light a shadow map hides from a point: percentage-closer filtering (Reeves, Salesin, Cook,
// "Rendering Antialiased Shadows with Depth Maps", SIGGRAPH 1987) with the receiver's plane (Isidoro, "Shadow
// Mapping: GPU-based Tips and Techniques", GDC 2006). docs/shadow_maps.md derives the bias.
//
// -DSHADOW_BITS   of a texel (shadow_texels.h)
// -DSHADOW_TAPS   texels a side that are asked: 1, 3 or 5
#pragma once

#include "kernels/shadow_maps/shadow_texels.h"
#include "shared/shadow_face.h"

#ifndef SHADOW_TAPS
#define SHADOW_TAPS 1
#endif

#define SHADOW_MAPS_ARGUMENTS \
  global const uint2 *shadow_lights, global const ShadowFace *shadow_faces, global const Texel *shadow_texels
#define SHADOW_MAPS \
  { shadow_lights, shadow_faces, shadow_texels }

typedef struct ShadowMaps {
  global const uint2* lights;  // first face, and number of faces: 0, 1 or 6
  global const ShadowFace* faces;
  global const Texel* texels;
} ShadowMaps;

static inline float length3(float3 v) { return sqrt(v.x * v.x + v.y * v.y + v.z * v.z); }
static inline float3 vector3(global const float* p) { return (float3)(p[0], p[1], p[2]); }

// Of the taps, those that see something nearer than the receiver: 0 to SHADOW_TAPS^2. `point` lies on the
// triangle with these corners, all relative to the scene's origin.
static inline uint shadow_taps(const ShadowMaps* maps, uint light, float3 point, const float corners[9],
                               float gap) {
  const uint2 of = maps->lights[light];
  if (of.y == 0) return 0;
  const float3 source = vector3(maps->faces[of.x].light), to = point - source, size = fabs(to);
  uint number = of.x;
  if (of.y == 6) {  // +x, -x, +y, -y, +z, -z
    const uint axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    number += 2 * axis + ((axis == 0 ? to.x : axis == 1 ? to.y : to.z) < 0 ? 1 : 0);
  }
  global const ShadowFace* f = maps->faces + number;
  const float3 right = vector3(f->right), up = vector3(f->up), ahead = vector3(f->ahead);
  const float3 p = (float3)(dot(right, to), dot(up, to), dot(ahead, to));
  if (!(p.z > 0)) return 0;
  const float3 a = (float3)(corners[0], corners[1], corners[2]), b = (float3)(corners[3], corners[4], corners[5]),
               c = (float3)(corners[6], corners[7], corners[8]);
  const float3 across = cross(b - a, c - a);
  const float3 world_normal = across / length3(across);
  const float3 n = (float3)(dot(right, world_normal), dot(up, world_normal), dot(ahead, world_normal));
  const float plane = dot(n, p), turn = plane < 0 ? -1.0f : 1.0f;
  const float furthest = max(max(max(dot(ahead, a - source), dot(ahead, b - source)), dot(ahead, c - source)), p.z);
  const float rounding = 0x1p-21f * (length3(source) + length3(point));
  const float in_front = gap * p.z / length3(p);
  const float half_size = 0.5f * (float)f->size, step = f->tangent / half_size;
  const float scale = 1.0f / texel_scale(f->range_m);
  const int x = (int)floor(p.x / p.z / step + half_size), y = (int)floor(p.y / p.z / step + half_size);
  uint hidden = 0;
  for (int j = -(SHADOW_TAPS / 2); j <= SHADOW_TAPS / 2; ++j) {
    for (int i = -(SHADOW_TAPS / 2); i <= SHADOW_TAPS / 2; ++i) {
      const int tx = clamp(x + i, 0, (int)f->size - 1), ty = clamp(y + j, 0, (int)f->size - 1);
      const float3 r = (float3)(((float)tx + 0.5f - half_size) * step, ((float)ty + 0.5f - half_size) * step, 1.0f);
      const float facing = turn * dot(n, r);
      // Where the texel's centre sees the receiver's plane, but no further than the triangle goes.
      const float expected = facing > 0 ? min(turn * plane / facing, furthest) : furthest;
      const float bias = in_front + texel_step(f->range_m, expected) +
                         rounding * length3(r) / max(facing, 0x1p-10f);
      hidden += (float)maps->texels[f->first + ty * f->size + tx] * scale < expected - bias;
    }
  }
  return hidden;
}
