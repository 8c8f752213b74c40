// Lights as structures of arrays.
#pragma once

#include "kernels/culling/light_cell_tests.h"

// World lights, light_stride floats each: x, y, z relative to the lights' origin, radius; with
// cones x, y, z of the unit axis and the outer half-angle's cosine (2 where there is none).
// Readable up to a multiple of 16 lights.

// Lights in view space, an array each: centre and radius with slack; the tiles they can
// be seen in; the index; the cone; with -DSURFACE_MASKS the light's masks.
#define VIEW_X 0
#define VIEW_Y 1
#define VIEW_D 2
#define VIEW_R 3
#define VIEW_TILES 4  // the tiles in one bin: bits 0-7 columns, 8-15 rows
#define VIEW_ID 5
#define VIEW_CONE 6  // four arrays
#ifdef SPOTS
#define VIEW_MASKS (VIEW_CONE + 4)
#else
#define VIEW_MASKS VIEW_CONE
#endif
#ifdef SURFACE_MASKS
#define VIEW_ARRAYS (VIEW_MASKS + 1)
#else
#define VIEW_ARRAYS VIEW_MASKS
#endif

#if LANES == 16
#define LOAD(p) vload16(0, p)
#else
#define LOAD(p) (*(p))
#endif

static inline ViewSphere load_sphere(global const float* lights, size_t stride) {
  const ViewSphere s = {LOAD(lights), LOAD(lights + stride), LOAD(lights + 2 * stride),
                        LOAD(lights + 3 * stride)};
  return s;
}

#ifdef SPOTS
static inline ViewCone load_cone(global const float* cones, size_t stride) {
  const ViewCone k = {LOAD(cones), LOAD(cones + stride), LOAD(cones + 2 * stride), LOAD(cones + 3 * stride)};
  return k;
}

// The axis is made a unit vector again: view_from_world may stretch it by MAX_STRETCH.
static inline ViewCone view_cone(global const float* lights, size_t stride, constant CullParams* p) {
  const ViewCone w = load_cone(lights + 4 * stride, stride);
  const real x = p->x_axis_x * w.x + p->x_axis_y * w.y + p->x_axis_z * w.d,
             y = p->y_axis_x * w.x + p->y_axis_y * w.y + p->y_axis_z * w.d,
             d = p->d_axis_x * w.x + p->d_axis_y * w.y + p->d_axis_z * w.d;
  const real length = sqrt(x * x + y * y + d * d);
  const ViewCone k = {x / length, y / length, d / length, w.cosine};
  return k;
}
#endif
