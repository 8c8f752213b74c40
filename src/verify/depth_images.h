// Depth images of hard cases, and the options that they run under.
#pragma once

#include "shared/cull_settings.h"
#include "verify/check.h"
#include "verify/tangent_lights.h"

namespace lightgrid::verify {

constexpr double sky = no_end;

// distance(x, y) in metres; sky: background.
template <typename Distance>
DepthImage depth_of(const CullView& view, const Distance& distance) {
  DepthImage depth;
  for (int y = 0; y < view.height; ++y) {
    for (int x = 0; x < view.width; ++x) {
      const double d = distance(x, y);
      depth.values.push_back(d == sky ? depth_of_nothing(view) : float(depth_at(view, d)));
    }
  }
  return depth;
}

// The default first.
inline std::vector<CullerOptions> every_mode(int tile = 16) {
  std::vector<CullerOptions> settings;
  for (const DepthBoundsRow& row : depth_bounds_modes) {
    CullerOptions options;
    options.depth_bounds = row.mode;
    options.tile = tile;
    settings.insert(row.mode == CullerOptions().depth_bounds ? settings.begin() : settings.end(), options);
  }
  return settings;
}

inline CullerOptions tile_of(int tile) {
  CullerOptions options;
  options.tile = tile;
  return options;
}

inline const CullView& sixty_degrees() {
  static const CullView view = field_of_view(60, 64, 48);
  return view;
}

inline uint64_t listed(const HostGrid& grid) { return grid.indices.size(); }

}  // namespace lightgrid::verify
