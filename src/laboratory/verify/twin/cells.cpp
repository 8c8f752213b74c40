// Every light against every cell: no regions, bins, blocks or candidates, and no counting pass.
#include "verify/twin/opencl_c.h"

#define SPOTS   // a cosine of 2 means no cone
#define SLICES  // one slice without ends cuts nothing

namespace lightgrid::lab::verify {
namespace {
#include "kernels/culling/bin_cells.h"

struct Projected {
  std::vector<float> values;  // a light's sphere and cone, as light_may_touch reads them
  std::vector<TileRect> tiles;
};

Projected project(const TwinInputs& in) {
  const CullParams* p = in.params;
  const size_t stride = p->light_stride;
  Projected lights{std::vector<float>(VIEW_ARRAYS * stride), {}};
  for (uint i = 0; i < p->light_count; ++i) {
    const float* l = in.lights + i;
    const ViewSphere s = view_sphere(l[0], l[stride], l[2 * stride], l[3 * stride], p);
    const ViewCone k = view_cone(l, stride, p);
    float* v = lights.values.data() + i;
    v[VIEW_X * stride] = s.x;
    v[VIEW_Y * stride] = s.y;
    v[VIEW_D * stride] = s.d;
    v[VIEW_R * stride] = s.r;
    v[VIEW_CONE * stride] = k.x;
    v[(VIEW_CONE + 1) * stride] = k.y;
    v[(VIEW_CONE + 2) * stride] = k.d;
    v[(VIEW_CONE + 3) * stride] = k.cosine;
    lights.tiles.push_back(tile_rect(s, l[3 * stride], p));
  }
  return lights;
}

std::vector<uint32_t> lights_of_cell(const Projected& lights, uint tx, uint ty, const TestCell& cell,
                                     const CullParams* p) {
  std::vector<uint32_t> list;
  const int tile = int(tx | ty << 16);
  for (uint i = 0; i < p->light_count; ++i) {
    if (rect_meets(lights.tiles[i], tile, tile) &&
        light_may_touch(lights.values.data() + i, p->light_stride, &cell, p))
      list.push_back(i);
  }
  return list;
}

}  // namespace

template <>
std::vector<std::vector<uint32_t>> lights_of_cells<CULL_TEST, DEPTH_MODE>(const TwinInputs& in) {
  const CullParams* p = in.params;
  const Projected lights = project(in);
  std::vector<float2> slices;
  for (uint i = 0; i < p->slices; ++i) slices.push_back({in.slices[2 * i], in.slices[2 * i + 1]});
  std::vector<std::vector<uint32_t>> lists;
  for (uint slice = 0; slice < p->slices; ++slice) {
    for (uint ty = 0; ty < p->tiles_y; ++ty) {
      for (uint tx = 0; tx < p->tiles_x; ++tx) {
        const uint bx = tx / BIN_TILES, by = ty / BIN_TILES,
                   slot = slot_of_tile(tx % BIN_TILES, ty % BIN_TILES);
        const float* bounds = in.bounds + size_t(by * p->bins_x + bx) * BOUND_PLANES * BIN_SIZE;
        TestCell cell;
        const bool some = make_test_cell(bounds, bx, by, slot, slice, slices.data(), &cell, p);
        lists.push_back(some ? lights_of_cell(lights, tx, ty, cell, p) : std::vector<uint32_t>());
      }
    }
  }
  return lists;
}

}  // namespace lightgrid::lab::verify
