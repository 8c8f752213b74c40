// Which lights are hidden from which pixels, for GPUs: a work-group takes a tile and some of its lights, a
// work-item a pixel. Bytes as kernels/shadows/cpu/find_shadows.cl has them, from the same arguments.
#define LANES 1
#include "kernels/shadows/shadow_test.h"

#define GROUP (SHADOW_TILE * SHADOW_TILE)

kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void find_shadows(
    SHADOW_TEST_ARGUMENTS SHADOW_PASS_ARGUMENTS) {
  local uint words[GROUP / 32 * 33];  // 33: items that read different rows meet different banks
  local volatile uint traced_here;
  const RayScene scene = RAYS_SCENE;
  const uint item = (uint)get_local_id(0), row = (uint)get_group_id(0), rows = (uint)get_num_groups(0),
             part = (uint)get_group_id(1), parts = (uint)get_num_groups(1), width = view->width,
             height = view->height, tile = FIRST_TILE + row;
  const uint across = (width + SHADOW_TILE - 1) / SHADOW_TILE;
  // Pixels in the order of their bits.
  const uint block = item / 16, x = tile % across * SHADOW_TILE + block % 4 * 4 + item % 4,
             y = tile / across * SHADOW_TILE + block / 4 * 4 + item % 16 / 4;
  const uint2 range = cells[tile];
  const uint own_tile = image * across * ((height + SHADOW_TILE - 1) / SHADOW_TILE) + tile,
             own_entry = FIRST_ENTRY(own_tile, range);
  // The first part lists the lights. Not in a branch: PoCL 3.1 writes out of bounds after a barrier in one. In
  // words, since a compiler may write both of a uint2 where one is set.
  const uint words_a_tile = 2 * shadow_view->words;
  global uint *all = (global uint*)tiles, *listed = all + 2 + (size_t)(1 + image * rows + row) * words_a_tile;
  const uint words_here = part == 0 ? words_a_tile : 0, lights_here = part == 0 ? range.y : 0,
             empty_words = row == 0 && image == 0 ? words_here : 0;
  for (uint i = item; i < words_here; i += GROUP) listed[i] = 0;
  for (uint i = item; i < empty_words; i += GROUP) all[2 + i] = 0;
  if (item < (empty_words != 0 ? 2 : 0)) all[item] = item == 0 ? FIRST_TILE : rows;
  barrier(CLK_GLOBAL_MEM_FENCE);
  for (uint i = range.x + item; i < range.x + lights_here; i += GROUP) {
    const uint index = indices[i];
    atomic_or((global volatile uint*)(listed + index / 32 * 2), 1u << (index & 31u));
    if (i == range.x || indices[i - 1] / 32 != index / 32)
      listed[index / 32 * 2 + 1] = i - range.x + own_entry;
  }
  const bool inside = x < width && y < height;
  const size_t at = inside ? (size_t)y * width + x : 0;
  const uint triangle = inside ? triangles[at] : NO_TRIANGLE;
  const KeptRow kept_row = KEPT_ROW(tile, 1 + image * rows + row, shadow_view->words);
  const bool finds = finds_any(&kept_row, indices, range);
  if (item == 0 && part == 0) {
    STORE_KEPT(own_tile, range.y == 0 ? TILE_HAS_NO_PAIR : finds ? TILE_IS_FOUND : TILE_IS_KEPT);
  }
  const bool covered = triangle != NO_TRIANGLE && part < range.y && finds;
  Receivers r =
      receivers_at(covered, (float)x + 0.5f, (float)y + 0.5f, depths[at], own_hides, shadow_view, view);
  if (covered) {
    const uint number = ray_number(triangle, triangle_instance, number_offsets);
    add_plane(&r, scene.triangles + scene.places[number], 1, shadow_view);
#ifdef SHADOW_MAP
    add_corners(&r, &scene);
#endif
  }
  ShadowTest test = SHADOW_TEST;
  if (item == 0) traced_here = 0;
#ifdef SHADOW_PICK  // one part a tile
  test.picked[0] = picked_share(&test, &scene, &r, lights, indices, range, x, y);
#endif
#ifdef SHADOW_BYTES
  for (uint i = part; i < range.y; i += parts) {
    global uchar* entry = (global uchar*)(bits + (size_t)(i + own_entry) * SHADOW_WORDS);
    const uint light = indices[range.x + i];
    global const uchar* from = (global const uchar*)kept_entry(&kept_row, light);
    entry[item] =
        from ? from[item] : (uchar)hidden_share(&test, &scene, &r, 0, light, lights, shadow_view, x, y);
  }
#else
  // 32 lights at a time, so that items wait for each other once for all of them. Each item has a word, a bit
  // per light; each light then gets words of a bit per item.
  for (uint first = part; first < range.y; first += 32 * parts) {
    const uint count = min((range.y - first + parts - 1) / parts, 32u);
    uint hidden = 0;
    for (uint k = 0; k < count; ++k) {
      const uint light = indices[range.x + first + k * parts];
      global const uint* from = kept_entry(&kept_row, light);
      const bool is_hidden = from ? (from[item / 32] >> item % 32 & 1u) != 0
                                  : hidden_share(&test, &scene, &r, 0, light, lights, shadow_view, x, y) != 0;
      if (is_hidden) hidden |= 1u << k;
    }
    words[item / 32 * 33 + item % 32] = hidden;
    barrier(CLK_LOCAL_MEM_FENCE);
    const uint k = item / SHADOW_WORDS, word = item % SHADOW_WORDS;
    uint of_light = 0;
    for (uint i = 0; i < 32 && k < count; ++i) of_light |= (words[word * 33 + i] >> k & 1u) << i;
    if (k < count) bits[(size_t)(first + k * parts + own_entry) * SHADOW_WORDS + word] = of_light;
    barrier(CLK_LOCAL_MEM_FENCE);
  }
#endif
  barrier(CLK_LOCAL_MEM_FENCE);
  atomic_add(&traced_here, rays_of_test(&test));
  barrier(CLK_LOCAL_MEM_FENCE);
  if (item == 0) rays[own_tile * parts + part] = traced_here;
}
