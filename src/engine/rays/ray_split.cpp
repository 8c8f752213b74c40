#include "rays/ray_split.h"

#include <cmath>

namespace lightgrid {
namespace {

constexpr int bins = 16;

}  // namespace

RaySplit best_ray_split(std::span<const RayItem> items) {
  RayItemBounds centers;  // twice the centre
  for (const RayItem& item : items) {
    float c[4];
    for (int k = 0; k < 4; ++k) c[k] = item.low[k] + item.high[k];
    centers.add(c, c);
  }
  RayItemBounds in_bin[3][bins];
  uint32_t counts[3][bins] = {};
  float scale[3];
  for (int axis = 0; axis < 3; ++axis) {
    const float width = centers.high[axis] - centers.low[axis];
    scale[axis] = width > 0 ? bins * 0.9999f / width : 0;
    if (!std::isfinite(scale[axis])) scale[axis] = 0;
  }
  for (const RayItem& item : items) {
    for (int axis = 0; axis < 3; ++axis) {
      const int bin = bin_of(item, axis, centers.low[axis], scale[axis]);
      in_bin[axis][bin].add(item.low, item.high);
      ++counts[axis][bin];
    }
  }
  RaySplit best;
  for (int axis = 0; axis < 3; ++axis) {
    float right_cost[bins];
    RayItemBounds right, left;
    uint32_t count = 0;
    for (int bin = bins - 1; bin > 0; --bin) {
      right.add(in_bin[axis][bin].low, in_bin[axis][bin].high);
      count += counts[axis][bin];
      right_cost[bin] = float(count) * right.area();
    }
    count = 0;
    for (int bin = 0; bin + 1 < bins; ++bin) {
      left.add(in_bin[axis][bin].low, in_bin[axis][bin].high);
      count += counts[axis][bin];
      const float cost = float(count) * left.area() + right_cost[bin + 1];
      if (count != 0 && count != items.size() && cost < best.cost)
        best = {axis, bin, centers.low[axis], scale[axis], cost};
    }
  }
  return best;
}

}  // namespace lightgrid
