// Draws shadow maps (Williams, "Casting Curved Shadows on Curved Surfaces", SIGGRAPH 1978): for each texel
// the distance of the nearest triangle that its centre sees. A work-item a face.
//
// RAYS_ARGUMENTS  the triangles, in a tree that leaves out what the face does not see
// faces           ShadowFace each
// texels          of all faces, written whole
//
// -DSHADOW_BITS  of a texel (shadow_texels.h)
// -DLANES        16 texels of a row at once, or 1
//
// A triangle covers a texel if its centre's direction r lies on the inner side of the planes through the
// light and each edge: no clipping, no near plane (Olano, Greer, "Triangle Scan Conversion using 2D
// Homogeneous Coordinates", 1997). Its distance there is n.a / n.r, of its normal n and a corner a. Swapping
// the ends of an edge turns all signs, so that neighbours leave no gap. Of a directional light's face the
// corners' last coordinate is 1 in the edges' planes, which makes them the edges' lines on the image.
#include "kernels/rays/rays.h"
#include "kernels/shadow_maps/shadow_texels.h"
#include "shared/shadow_face.h"

#if LANES == 16
#define LANE_OFFSETS convert_float16(LANE_INDEX)
#define load_texels(p) convert_float16(vload16(0, p))
#if SHADOW_BITS == 32
#define store_texels(v, p) vstore16(v, 0, p)
#elif SHADOW_BITS == 24
#define store_texels(v, p) vstore16(convert_uint16(v), 0, p)
#else
#define store_texels(v, p) vstore16(convert_ushort16(v), 0, p)
#endif
#else
#define LANE_OFFSETS 0.0f
#define load_texels(p) ((float)*(p))
#define store_texels(v, p) (*(p) = (Texel)(v))
#endif

typedef struct Face {
  float3 from, right, up, ahead;
  float extent, range;
  int size;
  bool parallel;
  global Texel* texels;
} Face;

static inline float3 at3(global const float* p) { return (float3)(p[0], p[1], p[2]); }

static inline float3 in_face(const Face* f, global const float* corner) {
  const float3 p = at3(corner) - f->from;
  return (float3)(dot(f->right, p), dot(f->up, p), dot(f->ahead, p));
}

// Whether a box lies out of the light's range, or behind one of the four planes that bound what the face
// sees.
static bool out_of_face(const Face* f, global const float* low, global const float* high) {
  const float3 a = at3(low) - f->from, b = at3(high) - f->from;
  const float3 off = max(max(a, -b), (float3)(0.0f));
  if (!f->parallel && dot(off, off) > f->range * f->range * 1.00001f) return true;
  for (int i = 0; i < 4; ++i) {
    const float3 across = i < 2 ? f->right : f->up, turned = i & 1 ? -across : across;
    const float3 n = f->parallel ? turned : f->ahead * f->extent + turned, most = max(n * a, n * b);
    if (most.x + most.y + most.z < (f->parallel ? -f->extent : 0.0f)) return true;
  }
  return false;
}

// The first or last texel whose centre may lie at u.
static inline int texel_at(const Face* f, float u, float rounding) {
  const float s = (u / f->extent * 0.5f + 0.5f) * (float)f->size - 0.5f + rounding;
  return (int)clamp(s, -1.0f, (float)f->size);
}

static void draw_triangle(const RayScene* scene, int place, const Face* f) {
  global const RayTriangle* t = scene->triangles + place;
  const float3 a = in_face(f, t->corners), b = in_face(f, t->corners + 3), c = in_face(f, t->corners + 6);
  const float nearest = min(min(a.z, b.z), c.z), furthest = max(max(a.z, b.z), c.z);
  if (!(furthest > 0) || nearest > f->range) return;
  int left = 0, right = f->size - 1, low = 0, high = f->size - 1;
  if (nearest > 0 || f->parallel) {
    const float3 depth = f->parallel ? (float3)(1.0f) : (float3)(a.z, b.z, c.z);
    const float3 x = (float3)(a.x, b.x, c.x) / depth, y = (float3)(a.y, b.y, c.y) / depth;
    left = max(left, texel_at(f, min(min(x.x, x.y), x.z), -0.01f));
    right = min(right, texel_at(f, max(max(x.x, x.y), x.z), 0.01f));
    low = max(low, texel_at(f, min(min(y.x, y.y), y.z), -0.01f));
    high = min(high, texel_at(f, max(max(y.x, y.y), y.z), 0.01f));
  }
  if (left > right || low > high) return;
  const float3 normal = cross(b - a, c - a);
  const float offset = dot(normal, a), facing = f->parallel ? normal.z : offset;
  if (!(facing > 0 || facing < 0)) return;  // the light lies in its plane and sees nothing of it
  const float turn = facing < 0 ? -1.0f : 1.0f;
  const float3 n = normal * turn;
  float3 ea = a, eb = b, ec = c;
  if (f->parallel) ea.z = eb.z = ec.z = 1;
  const float3 p = cross(eb, ec) * turn, q = cross(ec, ea) * turn, r = cross(ea, eb) * turn;
  const float step = 2 * f->extent / (float)f->size, first = (0.5f - 0.5f * (float)f->size) * step;
  const float scale = texel_scale(f->range);
  for (int y = low; y <= high; ++y) {
    const float v = first + step * (float)y;
    global Texel* row = f->texels + y * f->size;
    for (int x = left & ~(LANES - 1); x <= right; x += LANES) {
      const real u = first + step * ((float)x + LANE_OFFSETS);
      const real e0 = p.x * u + (p.y * v + p.z), e1 = q.x * u + (q.y * v + q.z),
                 e2 = r.x * u + (r.y * v + r.z);
      mask_t inside = lane_min(lane_min(e0, e1), e2) >= 0.0f;
      if (!any_lane(inside)) continue;
#ifdef RAYS_MASKS
      if (t->number & RAY_MASKED) inside &= hides_by_mask(&scene->masks, place, e0, e1, e2);
#endif
      const real at_plane = f->parallel ? (turn * offset - n.x * u - n.y * v) / n.z
                                        : turn * offset / (n.x * u + (n.y * v + n.z));
      const real distance = clamp(at_plane, max(nearest, 0.0f), furthest);
      real value = distance * scale;
#if SHADOW_BITS != 32
      value = floor(value + 0.5f);
#endif
      const real old = load_texels(row + x);
      inside &= (distance <= f->range) & (value < old);
      store_texels(inside ? value : old, row + x);
    }
  }
}

kernel void draw_faces(RAYS_ARGUMENTS, global const ShadowFace* faces, global Texel* texels) {
  const RayScene scene = RAYS_SCENE;
  global const ShadowFace* s = faces + get_global_id(0);
  const Face f = {at3(s->from), at3(s->right), at3(s->up),       at3(s->ahead),    s->extent,
                  s->range_m,   (int)s->size,  s->parallel != 0, texels + s->first};
  for (int i = 0; i < f.size * f.size; i += LANES) store_texels((real)(TEXEL_NOTHING), f.texels + i);
  int stack[RAY_STACK], height = 0;
  stack[height++] = 0;
  while (height > 0) {
    global const RayNode* n = scene.nodes + stack[--height];
    for (int side = 0; side < 2; ++side) {
      const int count = side ? n->count_1 : n->count_0, child = side ? n->child_1 : n->child_0;
      if (count == RAY_NOTHING) continue;
      if (out_of_face(&f, side ? n->low_1 : n->low_0, side ? n->high_1 : n->high_0)) continue;
      if (count == 0) stack[height++] = child;
      for (int i = child; i < child + count; ++i) draw_triangle(&scene, i, &f);
    }
  }
}
