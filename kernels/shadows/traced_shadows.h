// Shadows for a light loop that shades other points than pixels' centres, of which there are no bits: each
// light that reaches one of LANES points takes a ray then and there. Included after the light loop.
//
// -DSHADOWS_TRACED  shared/shadow_bits.h
#pragma once

#include "kernels/shadows/shadow_test.h"

// Before a kernel's other arguments. number_offsets: kernels/shadows/receivers.h. shadow_lights: of those
// without shadows none is in reach.
#define TRACED_ARGUMENTS                                                  \
  SHADOW_TEST_ARGUMENTS RAYS_ARGUMENTS, global const int *number_offsets, \
      global const ShadowLight *shadow_lights, constant ShadowView *shadow_view,
#define TRACED_SHADOWS                                                                                   \
  {                                                                                                      \
    .test = SHADOW_TEST, .scene = RAYS_SCENE, .number_offsets = number_offsets, .lights = shadow_lights, \
    .view = shadow_view                                                                                  \
  }

typedef struct TracedShadows {
  RayScene scene;
  global const int* number_offsets;
  global const ShadowLight* lights;
  constant ShadowView* view;
  Receivers receivers;
  ShadowTest test;
} TracedShadows;

// Points of opaque surfaces, for the light loop; their triangles follow. x, y: on the screen, as pixels'
// centres.
static inline void trace_from(TracedShadows* t, mask_t covered, real x, real y, real depth,
                              constant ViewParams* view) {
  t->receivers = receivers_at(covered, x, y, depth, 1, t->view, view);
}

// Into the lanes that are `here` their triangle, by the rasteriser's number.
static inline void trace_from_triangle(TracedShadows* t, uint triangle, global const uint* triangle_instance,
                                       mask_t here) {
  const uint number = ray_number(triangle, triangle_instance, t->number_offsets);
  add_plane(&t->receivers, t->scene.triangles + t->scene.places[number], here, t->view);
}

static real seen_share(const ShadowsHere* here, uint light) {
  TracedShadows* t = here->traced;
  const whole hidden = hidden_share(&t->test, &t->scene, &t->receivers, 0, light, t->lights, t->view, 0, 0);
  return 1.0f - TO_REAL(hidden) * (1.0f / 255.0f);
}
