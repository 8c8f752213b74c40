// Which clusters may be in view, and how near they are.
#pragma once

#include "shared/raster_params.h"

// Rounding of a sum of products in these tests, of the sum of their magnitudes: 2^-20, four times what the
// transform and the test together lose.
#define CLUSTER_SLACK 9.5367431640625e-7f

// The greatest value of row . (p, 1) in the cluster's box is below zero for certain. Not so where a number is
// none.
static inline bool box_is_outside(const float* row, const float* size, const RasterCluster* c) {
  const float value = row[0] * c->center_x + row[1] * c->center_y + row[2] * c->center_z + row[3];
  const float reach = fabs(row[0]) * c->half_x + fabs(row[1]) * c->half_y + fabs(row[2]) * c->half_z;
  const float magnitude = size[0] * (fabs(c->center_x) + c->half_x) +
                          size[1] * (fabs(c->center_y) + c->half_y) +
                          size[2] * (fabs(c->center_z) + c->half_z) + size[3];
  return value + reach + CLUSTER_SLACK * magnitude < 0.0f;
}

// All of its triangles face away from every point that the eye may be at: the cone of normals, moved by the
// cluster's radius (Shirman, Abi-Ezzi, "The Cone of Normals Technique for Fast Processing of Curved Patches",
// Eurographics 1993).
static inline bool faces_away(const RasterCluster* c, global const RasterFrameInstance* frame) {
  if (frame->eye_is_point == RASTER_NONE || c->sine >= RASTER_NO_CONE) return false;
  const bool point = frame->eye_is_point != 0;
  const float x = point ? c->center_x - frame->eye_x : frame->eye_x,
              y = point ? c->center_y - frame->eye_y : frame->eye_y;
  const float z = point ? c->center_z - frame->eye_z : frame->eye_z;
  const float along = x * c->axis_x + y * c->axis_y + z * c->axis_z, distance = sqrt(x * x + y * y + z * z);
  const float magnitude = fabs(frame->eye_x) + fabs(frame->eye_y) + fabs(frame->eye_z) + fabs(c->center_x) +
                          fabs(c->center_y) + fabs(c->center_z);
  return along > c->sine * distance + (point ? c->radius : 0.0f) + 8.0f * CLUSTER_SLACK * magnitude;
}

// RASTER_HIDDEN, or its place in an order of nearest depth, 16 places an octave.
static inline uchar bucket_of(const RasterCluster* c, global const RasterFrameInstance* frame, bool cones) {
  if (frame->eye_is_point == RASTER_NOT_DRAWN) return RASTER_HIDDEN;
  global const float* m = frame->clip_from_object;
  // w - x, w + x, w - y, w + y, w - z, z
  const float of_w[6] = {1, 1, 1, 1, 1, 0}, of_other[6] = {-1, 1, -1, 1, -1, 1};
  const int other[6] = {0, 0, 1, 1, 2, 2};
  for (int side = 0; side < 6; ++side) {
    float row[4], size[4];
    for (int i = 0; i < 4; ++i) {
      const float a = of_w[side] * m[12 + i], b = of_other[side] * m[4 * other[side] + i];
      row[i] = a + b;
      size[i] = fabs(a) + fabs(b);
    }
    if (box_is_outside(row, size, c)) return RASTER_HIDDEN;
  }
  if (cones && faces_away(c, frame)) return RASTER_HIDDEN;
  const float w = m[12] * c->center_x + m[13] * c->center_y + m[14] * c->center_z + m[15] -
                  (fabs(m[12]) * c->half_x + fabs(m[13]) * c->half_y + fabs(m[14]) * c->half_z);
  const float z = m[8] * c->center_x + m[9] * c->center_y + m[10] * c->center_z + m[11] +
                  (fabs(m[8]) * c->half_x + fabs(m[9]) * c->half_y + fabs(m[10]) * c->half_z);
  if (!(w > z)) return 0;
  const int steps = (int)(as_uint(1.0f) >> 19) - (int)(as_uint(z / w) >> 19);
  return (uchar)clamp(steps, 0, RASTER_HIDDEN - 1);
}
