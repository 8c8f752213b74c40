// The walk of a packet of 16 segments through the wide tree. A node's 16 boxes are tested together against
// the beam around the segments, and each box that the beam meets against the segments themselves.
//
// The beam meets what a segment meets, so that no answer depends on it: `reach` is twice that of a segment,
// and BEAM_SLACK is above SLACK by more than what the six operations round.
#pragma once

#define BEAM_SLACK 1.00001f

// Bounds of the shares at which segments cross planes of one axis at p: of p + before times the least or the
// greatest inverse, plus after.
typedef struct BeamAxis {
  float least, greatest, before_in, before_out, after_in, after_out;
} BeamAxis;

typedef struct Beam {
  BeamAxis x, y, z;
} Beam;

static inline float min_of(real v) {
  const float8 a = fmin(v.lo, v.hi);
  const float4 b = fmin(a.lo, a.hi);
  return min_of_3(b.x, b.y, fmin(b.z, b.w));
}
static inline float max_of(real v) { return -min_of(-v); }

// inverse, enter, leave: of the segments of the packet that are `live`, which go the same way.
static inline BeamAxis beam_axis(const bool point, float light, float reach, mask_t live, real inverse,
                                 real enter, real leave) {
  BeamAxis b = {
      min_of(live ? inverse : REAL(INFINITY)), max_of(live ? inverse : REAL(-INFINITY)), 0, 0, 0, 0};
  const float to_in = b.least < 0.0f ? -reach : reach;
  if (point) {
    b.before_in = -(light + to_in);
    b.before_out = -(light - to_in);
  } else {
    b.after_in = min_of(live ? enter : REAL(INFINITY));
    b.after_out = max_of(live ? leave : REAL(-INFINITY));
  }
  return b;
}

static inline Beam beam_of(const RayPacket* p, const bool point, mask_t live) {
  const float x = (float)p->light.x, y = (float)p->light.y, z = (float)p->light.z;
  const float reach = 0x1p-21f * (fabs(x) + fabs(y) + fabs(z));
  const Beam beam = {beam_axis(point, x, reach, live, p->inverse_x, p->enter_x, p->leave_x),
                     beam_axis(point, y, reach, live, p->inverse_y, p->enter_y, p->leave_y),
                     beam_axis(point, z, reach, live, p->inverse_z, p->enter_z, p->leave_z)};
  return beam;
}

static inline real first_in(const BeamAxis* b, global const float* planes) {
  const real at = vload16(0, planes) + b->before_in;
  return lane_min(fma(at, REAL(b->least), REAL(b->after_in)), fma(at, REAL(b->greatest), REAL(b->after_in)));
}
static inline real last_out(const BeamAxis* b, global const float* planes) {
  const real at = vload16(0, planes) + b->before_out;
  return lane_max(fma(at, REAL(b->least), REAL(b->after_out)),
                  fma(at, REAL(b->greatest), REAL(b->after_out)));
}

// Walks the tree for the lanes that trace() names.
static inline __attribute__((always_inline)) void walk_tree(const RayScene* scene, RayPacket* p,
                                                            const bool point, whole own, uint live,
                                                            mask_t* hidden, int* last_blocker) {
  const int in_x = p->down & 1 ? 3 : 0, in_y = p->down & 2 ? 4 : 1, in_z = p->down & 4 ? 5 : 2;
  const int out_x = 3 - in_x, out_y = 5 - in_y, out_z = 7 - in_z;
  const Beam beam = beam_of(p, point, lanes_of(live));
  int nodes_above[RAY_STACK], height = 0, at = 0;
  uint left_above[RAY_STACK];  // of their children
  for (;;) {
    global const RayWideNode* n = scene->wide_nodes + at;
    const real enter =
        lane_max(lane_max(first_in(&beam.x, n->planes[in_x]), first_in(&beam.y, n->planes[in_y])),
                 lane_max(first_in(&beam.z, n->planes[in_z]), REAL(0.0f)));
    const real leave =
        lane_min(lane_min(last_out(&beam.x, n->planes[out_x]), last_out(&beam.y, n->planes[out_y])),
                 lane_min(last_out(&beam.z, n->planes[out_z]), REAL(1.0f)));
    uint left = lane_bits(enter <= leave * BEAM_SLACK);
    for (;;) {
      while (left == 0) {
        if (height == 0) return;
        at = nodes_above[--height];
        left = left_above[height];
        n = scene->wide_nodes + at;
      }
      const uint k = lowest_bit(left);
      left &= left - 1;
      if (!any_lane(meets_box(p, n->planes[in_x][k], n->planes[in_y][k], n->planes[in_z][k],
                              n->planes[out_x][k], n->planes[out_y][k], n->planes[out_z][k])))
        continue;
      if (n->count[k] == 0) {
        if (left != 0) {
          nodes_above[height] = at;
          left_above[height++] = left;
        }
        at = n->child[k];
        break;
      }
      if (leaf_blocked(scene, p, point, n->child[k], n->count[k], own, live, hidden, last_blocker)) return;
    }
  }
}
