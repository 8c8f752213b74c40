// The depth of a triangle on the screen in extended precision, and how far from it a float depth as
// docs/raster.md has it may lie. Part of the coverage oracle (coverage.h).
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>

#include "base/pixel_grid.h"

namespace lightgrid::lab {

// 1/256 pixel from the image's lower left corner.
struct SnappedPoint {
  int64_t x = 0, y = 0;
  bool operator==(const SnappedPoint&) const = default;
};

struct DepthAt {
  double depth = 0;
  double bound = 0;
};

// Depth of a part of a triangle: what cutting left, or all of it.
class TriangleDepth {
 public:
  // clip: the triangle's corners as the transform left them; part: the part's, and where they are snapped to.
  TriangleDepth(const std::array<glm::vec4, 3>& clip, const std::array<glm::vec4, 3>& part,
                const std::array<SnappedPoint, 3>& snapped, const PixelGrid& grid);

  DepthAt at(const SnappedPoint& sample) const;

 private:
  using Real = long double;
  // A plane on the screen: depth at a point (pixels), what it gains per pixel, and how far a float gradient
  // may be from that.
  struct Plane {
    Real at_x = 0, at_y = 0, depth = 0;
    Real right = 0, up = 0, right_bound = 0, up_bound = 0;
    Real size = 0;  // size of the depths that are rounded
  };
  enum class Shown { exact, snapped, either };

  void find_box(const std::array<SnappedPoint, 3>& snapped, const PixelGrid& grid);
  void find_exact(const std::array<glm::vec4, 3>& clip, const PixelGrid& grid);
  void find_snapped(const std::array<glm::vec4, 3>& part, const std::array<SnappedPoint, 3>& snapped);
  DepthAt in_plane(const Plane& plane, const SnappedPoint& sample) const;

  glm::ivec2 box_low_, box_high_;  // the first and the last pixel whose centre the part may cover
  Real least_ = 0, greatest_ = 0;  // depths of the triangle in view
  Plane exact_, snapped_;
  Shown shown_ = Shown::snapped;
};

}  // namespace lightgrid::lab
