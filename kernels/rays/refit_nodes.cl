// Boxes of nodes whose triangles moved, children before their parents: nodes of one level by a work-item
// each, or several levels of few nodes by one work-item after the other.
//
// wide_nodes  the wide tree, or null
// slots       where the two boxes of each node stand in it (rays/wide_tree.h)
// list        nodes, the deepest first
// first       of the list, for this launch
// count       in this launch
// a_work_item  how many a work-item takes, one after the other
#include "shared/ray_records.h"

typedef struct Box {
  float low[3], high[3];
} Box;

static inline void add(Box* box, global const float* low, global const float* high) {
  for (int k = 0; k < 3; ++k) {
    box->low[k] = low[k] < box->low[k] ? low[k] : box->low[k];
    box->high[k] = high[k] > box->high[k] ? high[k] : box->high[k];
  }
}

static inline Box box_of(global const RayNode* nodes, global const RayTriangle* triangles, int child,
                         int count) {
  Box box = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
  if (count == 0) {
    global const RayNode* n = nodes + child;
    add(&box, n->low_0, n->high_0);
    add(&box, n->low_1, n->high_1);
  }
  for (int i = child; i < child + count; ++i) {
    for (int corner = 0; corner < 9; corner += 3)
      add(&box, triangles[i].corners + corner, triangles[i].corners + corner);
  }
  return box;
}

static inline void put_wide(global RayWideNode* wide_nodes, int slot, const Box* box) {
  if (slot < 0) return;
  global RayWideNode* n = wide_nodes + slot / RAY_WIDTH;
  for (int k = 0; k < 3; ++k) {
    n->planes[k][slot % RAY_WIDTH] = box->low[k];
    n->planes[3 + k][slot % RAY_WIDTH] = box->high[k];
  }
}

kernel void refit_nodes(global RayNode* nodes, global const RayTriangle* triangles,
                        global RayWideNode* wide_nodes, global const int2* slots, global const uint* list,
                        uint first, uint count, uint a_work_item) {
  const uint begin = (uint)get_global_id(0) * a_work_item, end = min(begin + a_work_item, count);
  for (uint i = begin; i < end; ++i) {
    global RayNode* n = nodes + list[first + i];
    const Box one = box_of(nodes, triangles, n->child_0, n->count_0),
              other = box_of(nodes, triangles, n->child_1, n->count_1);
    for (int k = 0; k < 3; ++k) {
      n->low_0[k] = one.low[k];
      n->high_0[k] = one.high[k];
      n->low_1[k] = other.low[k];
      n->high_1[k] = other.high[k];
    }
    if (!slots) continue;
    put_wide(wide_nodes, slots[list[first + i]].x, &one);
    put_wide(wide_nodes, slots[list[first + i]].y, &other);
  }
}
