// Draws shadow maps (Williams, "Casting Curved Shadows on Curved Surfaces", SIGGRAPH 1978): for each texel
// the distance of the nearest triangle that its centre sees. A work-item draws a tile of a face.
//
// RAYS_ARGUMENTS  the triangles, in a tree that leaves out what the tile does not see
// faces           ShadowFace each
// tiles           of each face that is drawn: its first tile, and the face
// face_count, tile_count
// texels          of all faces; those that are drawn are written whole
//
// -DSHADOW_BITS, -DLANES  face_tile.h
//
// A triangle covers a texel if its centre's direction r lies on the inner side of the planes through the
// light and each edge: no clipping, no near plane (Olano, Greer, "Triangle Scan Conversion using 2D
// Homogeneous Coordinates", 1997). Its distance there is n.a / n.r, of its normal n and a corner a. Swapping
// the ends of an edge turns all signs, so that neighbours leave no gap. Of a directional light's face the
// corners' last coordinate is 1 in the edges' planes, which makes them the edges' lines on the image.
#include "kernels/rays/rays.h"
#include "kernels/shadow_maps/draw_triangles.h"

// The tile's face: the last drawn one whose tiles begin at this one or before.
static inline uint2 face_of_tile(global const uint2* tiles, uint face_count, uint tile) {
  uint low = 0, high = face_count;
  while (high - low > 1) {
    const uint middle = (low + high) / 2;
    if (tiles[middle].x <= tile)
      low = middle;
    else
      high = middle;
  }
  return tiles[low];
}

static inline void store_tile(const FaceTile* t, global Texel* texels) {
  OVER_FEW for (int y = 0; y <= LAST_OF(t->side - 1); ++y) {
    OVER_FEW for (int x = 0; x <= LAST_OF((t->side - 1) / LANES); ++x)
        store_texels(t->texels[y * PACKETS + x], texels + (t->y + y) * t->size + t->x + x * LANES);
  }
}

// A child of a node. nearest: all that it holds is at least this far ahead.
typedef struct Waiting {
  int child, count;
  float nearest;
} Waiting;

kernel void draw_faces(RAYS_ARGUMENTS, global const ShadowFace* faces, global const uint2* tiles,
                       uint face_count, uint tile_count, global Texel* texels) {
  const RayScene scene = RAYS_SCENE;
  const uint number = (uint)get_global_id(0);
  if (number >= tile_count) return;
  const uint2 of = face_of_tile(tiles, face_count, number);
  global const ShadowFace* face = faces + of.y;
  FaceTile tile;
  set_tile(&tile, face, number - of.x);
  Waiting stack[RAY_STACK + 1];
  int height = 0, places[LANES], waiting = 0;  // triangles that are drawn together
  const Waiting root = {0, 0, 0.0f};
  stack[height++] = root;
  while (height > 0) {
    const Waiting next = stack[--height];
    if (!(float_texel_value(&tile, next.nearest) < tile.farthest)) continue;
    for (int i = 0; i < next.count; ++i) {
      places[waiting++] = next.child + i;
      if (waiting < LANES) continue;
      draw_triangles(&scene, places, waiting, &tile);
      waiting = 0;
    }
    if (next.count != 0) continue;
    global const RayNode* n = scene.nodes + next.child;
    Waiting a = {n->child_0, n->count_0, 0}, b = {n->child_1, n->count_1, 0};
    const bool to_a = a.count != RAY_NOTHING && may_change(&tile, n->low_0, n->high_0, &a.nearest);
    const bool to_b = b.count != RAY_NOTHING && may_change(&tile, n->low_1, n->high_1, &b.nearest);
    // The nearer one is drawn first.
    const bool a_first = a.nearest <= b.nearest;
    if (a_first ? to_b : to_a) stack[height++] = a_first ? b : a;
    if (a_first ? to_a : to_b) stack[height++] = a_first ? a : b;
  }
  if (LANES > 1 && waiting != 0) draw_triangles(&scene, places, waiting, &tile);
  store_tile(&tile, texels + face->first);
}
