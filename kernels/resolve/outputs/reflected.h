// The light that surfaces in a light's view reflect diffusely: the pixels of a reflective shadow map
// (Dachsbacher, Stamminger, "Reflective Shadow Maps", I3D 2005), with flux and area in place of colours.
//
// light   in the light table; the view's eye is at its position. No light grid is read
// flux    out: RGB flux and area per pixel
// places  out: normal and distance ahead per pixel
#pragma once

#include "kernels/resolve/resolve_light.h"

#define OUTPUT_LIST(X) X(uint, light) X(global float*, flux) X(global float*, places)
DECLARE_OUTPUT;
#define READS_DEPTH(output) true
#define NEEDS_EVERY_PIXEL true

typedef struct ReflectedLight {
  Real3 flux;    // intensity times sr
  real area;     // of the pixel's surface, m^2
  Real3 normal;  // unit, view space, towards the light
  real ahead;    // along the view's axis, m
} ReflectedLight;

// Into the lanes that are `here` the normal of the triangle's plane, not yet unit.
static inline void add_plane(Real3* normal, const ResolveScene* s, uint triangle, mask_t here,
                             constant ViewParams* view) {
  global const RasterInstanceRecord* r = s->instances + s->triangle_instance[triangle];
  global const uint* index = s->indices + r->first_index + 3 * (size_t)(triangle - r->first_triangle);
  global const float4* clip = s->clip + r->first_clip_vertex;
  // From clip space to view space: a perspective whose w is -z.
  const float half_x = 0.5f * (float)view->width * view->slope_x_scale;
  const float half_y = 0.5f * (float)view->height * view->slope_y_scale;
  const float4 a = clip[index[0]], b = clip[index[1]] - a, c = clip[index[2]] - a;
  const Real3 n = cross3(real3(REAL(b.x * half_x), REAL(b.y * half_y), REAL(-b.w)),
                         real3(REAL(c.x * half_x), REAL(c.y * half_y), REAL(-c.w)));
  KEEP3((*normal), n);
}

// plane: of add_plane. The view's eye is at the light.
static inline ReflectedLight reflected_light(ShadingPoint p, mask_t unlit, Real3 plane, mask_t covered,
                                             PunctualLight light, constant ViewParams* view) {
  Arrival arrival = arrival_at(p.position, light);
  const real squared = dot3(p.position, p.position);
  const real plane_squared = dot3(plane, plane);
  const real scale = inverse_sqrt_real(max_real(plane_squared, REAL(FLT_MIN)));
  const real facing = dot3(plane, arrival.to_light) * scale;
  const real towards = facing < REAL(0.0f) ? -scale : scale;
  ReflectedLight r;
  r.normal = scale3(plane, towards);
  r.ahead = -p.position.z;
  // A pixel on the plane at distance 1 fills its area times the cube of the cosine there.
  const real cosine = r.ahead * inverse_sqrt_real(max_real(squared, REAL(FLT_MIN)));
  const real solid_angle = (view->slope_x_scale * view->slope_y_scale) * (cosine * cosine * cosine);
  const real across = max_real(max_real(facing, -facing), REAL(1e-3f));
  r.area = solid_angle * squared / across;
  // The light that arrives on the shading normal, over the area of the triangle itself.
  const real n_dot_l = min_real(max_real(dot3(p.normal, arrival.to_light), REAL(0.0f)), REAL(1.0f));
  const real arriving =
      arrival.attenuation * light_reaches(light, p.position, arrival.to_light, VALUES_AT(p));
  TINT(arrival, light, p.position, VALUES_AT(p))
  const real received = arriving * n_dot_l * r.area;
  const Real3 diffuse = DIFFUSE_INTEGRAL(p, SHADING_PI);
  const Real3 albedo = UNDER_COAT(p, diffuse);
  const mask_t lit = covered & (unlit == 0) & (plane_squared > REAL(FLT_MIN)) & (received > REAL(0.0f));
  const real none = 0.0f;
  r.flux = real3(lit ? albedo.x * light.color.x TINTED(arrival, x) * received : none,
                 lit ? albedo.y * light.color.y TINTED(arrival, y) * received : none,
                 lit ? albedo.z * light.color.z TINTED(arrival, z) * received : none);
  r.area = lit ? r.area : none;
  r.ahead = lit ? r.ahead : none;
  r.normal = real3(lit ? r.normal.x : none, lit ? r.normal.y : none, lit ? r.normal.z : none);
  return r;
}

STORE_RESOLVED {
  Real3 plane = real3(REAL(0.0f), REAL(0.0f), REAL(0.0f));
#if LANES == 16
  const uint16 triangle = load_block(where->triangles, where->x, where->y, view->width, view->height);
  for (uint left = mask_bits(resolved->covered); left != 0;) {
    const uint one = ((const uint*)&triangle)[lowest_bit(left)];
    const mask_t here = resolved->covered & (triangle == (uint16)(one));
    left &= ~mask_bits(here);
    add_plane(&plane, scene, one, here, view);
  }
#else
  if (resolved->covered) add_plane(&plane, scene, where->triangle, 1, view);
#endif
  const ReflectedLight r = reflected_light(resolved_point(resolved, view), resolved->surface->unlit, plane,
                                           resolved->covered, light_at(&lights->lights, output->light), view);
#if LANES == 16
  store_block(output->flux, r.flux, r.area, where->x, where->y, view->width, view->height);
  store_block(output->places, r.normal, r.ahead, where->x, where->y, view->width, view->height);
#else
  const size_t at = where->texels.pixel;
  ((global float4*)output->flux)[at] = (float4)(r.flux.x, r.flux.y, r.flux.z, r.area);
  ((global float4*)output->places)[at] = (float4)(r.normal.x, r.normal.y, r.normal.z, r.ahead);
#endif
}
