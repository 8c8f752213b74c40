// Depth bounds by a plain scan of each tile, value by value.
#include "verify/twin/opencl_c.h"

#define DEPTH_MODE 1  // the layout is chosen at run time

namespace lightgrid::lab::verify {
namespace {
#include "kernels/culling/depth_interval.h"

#ifdef STANDARD_DEPTH
constexpr bool standard = true;
#else
constexpr bool standard = false;
#endif

std::vector<uint> keys_of_tile(const CullParams& p, uint tx, uint ty, int samples, const float* depth) {
  std::vector<uint> keys;
  const uint size = p.tile_size;
  for (uint y = ty * size; y < min((ty + 1) * size, p.height); ++y) {
    const float* row = depth + p.depth_first + size_t(y) * p.depth_row;
    for (uint x = tx * size * samples; x < min((tx + 1) * size, p.width) * samples; ++x)
      keys.push_back(KEY(as_uint(row[x])));
  }
  return keys;
}

// Greatest, least and least nonzero of those below `end`; 0 and all ones if there is none.
struct Extremes {
  uint low = 0xffffffffu, high = 0, lowest = 0xffffffffu;
};
Extremes extremes_of(const std::vector<uint>& keys, uint begin, uint end) {
  Extremes e;
  for (const uint key : keys) {
    e.lowest = min(e.lowest, key);
    if (key < begin || key >= end || key == 0) continue;
    e.low = min(e.low, key);
    e.high = max(e.high, key);
  }
  return e;
}

Interval interval_of(const Extremes& e, const CullParams& p) { return opaque_interval(e.low, e.high, &p); }

void bounds_of_tile(const std::vector<uint>& keys, int mode, const CullParams& p, float planes[4]) {
  const Extremes all = extremes_of(keys, 0, 0xffffffffu);
  const Interval whole_tile = interval_of(all, p);
  const bool depths = all.high != 0 && all.high <= ONE_BITS;
  const float middle = 0.5f * (whole_tile.near + whole_tile.far);
  planes[0] = whole_tile.near;
  planes[1] = whole_tile.far;
  planes[2] = FAR_AWAY;
  planes[3] = -FAR_AWAY;
  if (mode == DEPTH_HALFZ && all.high != 0) {
    planes[1] = planes[2] = middle;
    planes[3] = whole_tile.far;
  }
  if (mode == DEPTH_HALFZ_MODIFIED && depths) {
    const uint cut = KEY(as_uint(depth_of_distance(middle, &p)));
    const Interval nearer = interval_of(extremes_of(keys, cut, 0xffffffffu), p),
                   farther = interval_of(extremes_of(keys, 0, cut), p);
    planes[0] = nearer.near;
    planes[1] = nearer.far;
    planes[2] = farther.near;
    planes[3] = farther.far;
  }
  if (mode == DEPTH_MASK32) {
    const bool bounded = depths && whole_tile.far != FAR_AWAY;
    uint slots = bounded ? 0u : 0xffffffffu;
    for (const uint key : keys) {
      if (bounded && key != 0) slots |= mask_of_key(key, whole_tile.near, whole_tile.far, &p);
    }
    planes[2] = as_float(slots);
  }
}

void blend_bounds_of_tile(const std::vector<uint>& keys, const CullParams& p, float planes[4]) {
  const Extremes all = extremes_of(keys, 0, 0xffffffffu);
  const Interval i = blend_interval(all.lowest, all.high, &p);
  planes[0] = i.near;
  planes[1] = i.far;
}

int planes_of(int mode) {
  return mode == DEPTH_MASK32 ? 3 : mode == DEPTH_HALFZ || mode == DEPTH_HALFZ_MODIFIED ? 4 : 2;
}

}  // namespace

template <>
std::vector<float> bounds_of_depth<standard>(const CullParams& p, int mode, bool blend, int samples,
                                             const float* depth) {
  const int count = blend ? 2 : planes_of(mode);
  std::vector<float> values(size_t(p.bins_x) * p.bins_y * count * BIN_SIZE);
  for (size_t i = 0; i < values.size(); ++i) values[i] = i / BIN_SIZE % count % 2 == 0 ? FAR_AWAY : -FAR_AWAY;
  for (uint ty = 0; ty < p.tiles_y; ++ty) {
    for (uint tx = 0; tx < p.tiles_x; ++tx) {
      float planes[4] = {p.orthographic ? -FAR_AWAY : 0.0f, FAR_AWAY};
      if (mode != DEPTH_NONE) {
        const std::vector<uint> keys = keys_of_tile(p, tx, ty, samples, depth);
        if (blend)
          blend_bounds_of_tile(keys, p, planes);
        else
          bounds_of_tile(keys, mode, p, planes);
      }
      const size_t bin = size_t(ty / BIN_TILES) * p.bins_x + tx / BIN_TILES;
      for (int i = 0; i < count; ++i)
        values[(bin * count + i) * BIN_SIZE + slot_of_tile(tx % BIN_TILES, ty % BIN_TILES)] = planes[i];
    }
  }
  return values;
}

}  // namespace lightgrid::lab::verify
