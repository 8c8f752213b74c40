// Where the surface area heuristic cuts a range of boxes in two.
#pragma once

#include <cstdint>
#include <limits>
#include <span>

namespace lightgrid {

// A box in four lanes, of which the last is spare, with its number.
struct RayItem {
  float low[4], high[4];
  uint32_t number;
};

struct RayItemBounds {
  float low[4], high[4];
  RayItemBounds() {
    for (int k = 0; k < 4; ++k) {
      low[k] = std::numeric_limits<float>::infinity();
      high[k] = -std::numeric_limits<float>::infinity();
    }
  }
  void add(const float (&l)[4], const float (&h)[4]) {
    for (int k = 0; k < 4; ++k) low[k] = l[k] < low[k] ? l[k] : low[k];
    for (int k = 0; k < 4; ++k) high[k] = h[k] > high[k] ? h[k] : high[k];
  }
  // Half its surface; 0 where it is empty.
  float area() const {
    const float x = high[0] - low[0], y = high[1] - low[1], z = high[2] - low[2];
    return x < 0 ? 0 : x * y + y * z + z * x;
  }
};

struct RaySplit {
  int axis = -1;  // below 0: none
  int last_bin = 0;
  float low = 0, scale = 0;
  float cost = std::numeric_limits<float>::infinity();
};

inline int bin_of(const RayItem& item, int axis, float low, float scale) {
  return int((item.low[axis] + item.high[axis] - low) * scale);
}

// In one of 16 bins along an axis. No axis where all centres are the same.
RaySplit best_ray_split(std::span<const RayItem> items);

}  // namespace lightgrid
