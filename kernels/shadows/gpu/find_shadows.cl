// Which lights are hidden from which pixels, for GPUs: a work-group takes a tile and some of its lights, a
// work-item a pixel. Bytes as kernels/shadows/cpu/find_shadows.cl has them, from the same arguments.
#define LANES 1
#include "kernels/shadows/receivers.h"
#if defined(SHADOW_RAYS) || defined(SHADOW_PICK)
#include "kernels/shadows/soft_shadows.h"
#endif
#ifdef SHADOW_PICK
#include "kernels/shadows/picked_shadows.h"
#endif

#define GROUP (SHADOW_TILE * SHADOW_TILE)

kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void find_shadows(SHADOW_PASS_ARGUMENTS) {
  local volatile uint words[2][SHADOW_WORDS];
  local volatile uint traced_here;
  const RayScene scene = RAYS_SCENE;
  const uint item = (uint)get_local_id(0), tile = (uint)get_group_id(0), part = (uint)get_group_id(1),
             parts = (uint)get_num_groups(1), width = view->width, height = view->height;
  const uint across = (width + SHADOW_TILE - 1) / SHADOW_TILE;
  // Pixels in the order of their bits.
  const uint block = item / 16, x = tile % across * SHADOW_TILE + block % 4 * 4 + item % 4,
             y = tile / across * SHADOW_TILE + block / 4 * 4 + item % 16 / 4;
  const uint2 range = cells[tile];
  if (part == 0) {
    global uint2* listed = tiles + (size_t)tile * shadow_view->words;
    for (uint i = range.x + item; i < range.x + range.y; i += GROUP) {
      const uint index = indices[i];
      atomic_or((global volatile uint*)(listed + index / 32), 1u << (index & 31u));
      if (i == range.x || indices[i - 1] / 32 != index / 32) listed[index / 32].y = i;
    }
  }
  const bool inside = x < width && y < height;
  const size_t at = inside ? (size_t)y * width + x : 0;
  const uint triangle = inside ? triangles[at] : NO_TRIANGLE;
  const Receivers r =
      receivers_at(&scene, triangle, triangle != NO_TRIANGLE, (float)x + 0.5f, (float)y + 0.5f, depths[at],
                   triangle_instance, number_offsets, shadow_view, view);
  uint traced = 0, turn = 0;
  int last_blocker = -1;
  if (item == 0) traced_here = 0;
#ifdef SHADOW_PICK  // one part a tile
  const whole share = picked_share(&scene, &r, lights, indices, range, x, y, &traced, &last_blocker);
#endif
  for (uint i = range.x + part; i < range.x + range.y; i += parts, turn ^= 1) {
    global uint* entry = bits + (size_t)i * SHADOW_WORDS;
#if defined(SHADOW_PICK)
    ((global uchar*)entry)[item] = (uchar)picked_or_away(&scene, &r, lights + indices[i], share, shadow_view);
#elif defined(SHADOW_RAYS)
    const uint light = indices[i];
    ((global uchar*)entry)[item] =
        (uchar)hidden_share(&scene, &r, lights + light, x, y, light, &traced, &last_blocker);
#elif defined(SHADOW_BYTES)
    const mask_t hidden =
        hidden_from(&scene, &r, lights + indices[i], shadow_view, &traced, &last_blocker);
    ((global uchar*)entry)[item] = hidden ? 255 : 0;
#else
    if (item < SHADOW_WORDS) words[turn][item] = 0;
    barrier(CLK_LOCAL_MEM_FENCE);
    if (hidden_from(&scene, &r, lights + indices[i], shadow_view, &traced, &last_blocker))
      atomic_or(&words[turn][item / 32], 1u << (item & 31u));
    barrier(CLK_LOCAL_MEM_FENCE);
    if (item < SHADOW_WORDS) entry[item] = words[turn][item];
#endif
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  atomic_add(&traced_here, traced);
  barrier(CLK_LOCAL_MEM_FENCE);
  if (item == 0) rays[tile * parts + part] = traced_here;
}
