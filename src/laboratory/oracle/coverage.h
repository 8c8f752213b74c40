// The oracle of rasterising: which triangles cover a pixel's sample, in exact integers, and their depths
// there in extended precision. What is to be drawn is written down in docs/raster.md; this shares no code
// with the kernels.
//
// Given are positions in clip space as the transform left them. Snapping to 1/256 pixel and cutting at the
// near plane and the guard band are done again here. Coverage counts the crossings of a half-line with the
// outline, where kernels take signs of edge functions: the top-left rule is the limit of a sample moved right
// and, far less, down. Depth is triangle_depth.h's.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/pixel_grid.h"
#include "oracle/triangle_depth.h"

namespace lightgrid::lab {

struct CoverageTriangle {
  std::array<glm::vec4, 3> clip;  // counter-clockwise from the front
  bool two_sided = false;
  bool mirrored = false;  // clockwise from the front instead
};

// One triangle at one pixel.
struct CoveredPixel {
  uint32_t triangle = 0;
  double depth = 0;  // exact to 2^-60 or so
  double bound = 0;  // how far from it a float depth as docs/raster.md has it may lie
  // The first triangle whose corners have the same bits in the same order, so that both have the same float
  // depth. 0xffffffff: unknown.
  uint32_t alike = 0xffffffffu;
};

// The winding of the triangle's outline around a point: 1 counter-clockwise, -1 clockwise, 0 not around it.
int winding_at(const std::array<SnappedPoint, 3>& triangle, const SnappedPoint& sample);

// Where a vertex in front of the eye and within the guard band is snapped to.
SnappedPoint snapped(const glm::vec4& clip, const PixelGrid& grid);

// The part of a triangle that cutting leaves: 0 corners, or 3 and more; nothing where a corner is not finite,
// before or after.
std::optional<std::vector<glm::vec4>> cut_triangle(const std::array<glm::vec4, 3>& clip,
                                                   const PixelGrid& grid);

class CoverageOracle {
 public:
  // Judges one sample of each pixel, which lies at `sample` from its lower left corner; less than a pixel.
  explicit CoverageOracle(const PixelGrid& grid, const SnappedPoint& sample = {128, 128})
      : grid_{grid.width, grid.height}, sample_(sample), pixels_(grid.pixels()) {}
  // Triangles are numbered in the order of these calls.
  void add(const CoverageTriangle& triangle);

  // All that cover the pixel, in the order of their numbers; a triangle once, with its nearest part where it
  // was cut.
  const std::vector<CoveredPixel>& at(int x, int y) const { return pixels_[grid_.index(x, y)]; }
  uint32_t invalid_triangles() const { return invalid_; }

 private:
  void add_part(const std::array<glm::vec4, 3>& clip, const CoverageTriangle& triangle);

  PixelGrid grid_;
  SnappedPoint sample_;
  uint32_t count_ = 0, invalid_ = 0;
  std::vector<std::vector<CoveredPixel>> pixels_;
  std::map<std::array<uint32_t, 12>, uint32_t> first_of_corners_;
};

// Describes the fault of a pixel that shows `triangle` (0xffffffff: none) at `depth`; empty: none. It may
// show the nearest triangle, or one that may be nearest within the bounds of the depths; of triangles with
// the same corners the last.
std::string wrong_at(const std::vector<CoveredPixel>& covered, uint32_t triangle, float depth);

}  // namespace lightgrid::lab
