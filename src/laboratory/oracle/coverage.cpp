#include "oracle/coverage.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace lightgrid::lab {
namespace {

constexpr double min_depth = 0x1p-126;  // less is not drawn
constexpr double guard_units = 16368 * 256;
constexpr int units_a_pixel = 256;  // a pixel

bool finite_corner(const glm::vec4& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && std::isfinite(v.w);
}

// The five half-spaces that a triangle is cut to, in turn: 0 or more inside. Each is one float operation on
// float values.
using CutPlane = float (*)(const glm::vec4& v, float guard_x, float guard_y);
constexpr CutPlane cut_planes[] = {
    [](const glm::vec4& v, float, float) { return v.w - v.z; },
    [](const glm::vec4& v, float guard_x, float) { return std::fma(guard_x, v.w, -v.x); },
    [](const glm::vec4& v, float guard_x, float) { return std::fma(guard_x, v.w, v.x); },
    [](const glm::vec4& v, float, float guard_y) { return std::fma(guard_y, v.w, -v.y); },
    [](const glm::vec4& v, float, float guard_y) { return std::fma(guard_y, v.w, v.y); },
};

// Where the segment from a point inside to one outside leaves the half-space.
glm::vec4 cut_point(const glm::vec4& inside, float d_inside, const glm::vec4& outside, float d_outside) {
  const float t = d_inside / (d_inside - d_outside);
  glm::vec4 point;
  for (int i = 0; i < 4; ++i) point[i] = std::fma(t, outside[i] - inside[i], inside[i]);
  return point;
}

std::vector<glm::vec4> cut_polygon(const std::vector<glm::vec4>& polygon, CutPlane plane, float guard_x,
                                   float guard_y) {
  std::vector<glm::vec4> kept;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const glm::vec4 &here = polygon[i], &next = polygon[(i + 1) % polygon.size()];
    const float d_here = plane(here, guard_x, guard_y), d_next = plane(next, guard_x, guard_y);
    const bool in = d_here >= 0, next_in = d_next >= 0;
    if (in) kept.push_back(here);
    if (in && !next_in) kept.push_back(cut_point(here, d_here, next, d_next));
    if (!in && next_in) kept.push_back(cut_point(next, d_next, here, d_here));
  }
  return kept;
}

// Twice the signed area, in units squared: below 2^49.
int64_t twice_area_of(const SnappedPoint& a, const SnappedPoint& b, const SnappedPoint& c) {
  return (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
}

}  // namespace

int winding_at(const std::array<SnappedPoint, 3>& triangle, const SnappedPoint& sample) {
  const auto [sample_x, sample_y] = sample;
  int winding = 0;
  for (int i = 0; i < 3; ++i) {
    const SnappedPoint &from = triangle[i], &to = triangle[(i + 1) % 3];
    // The sample lies just below its row: a corner on the row is above.
    const bool from_above = from.y >= sample_y, to_above = to.y >= sample_y;
    if (from_above == to_above) continue;
    // It also lies just right of its column: the half-line towards the right misses a crossing on the column.
    const SnappedPoint &low = from_above ? to : from, &high = from_above ? from : to;
    const bool crossed = (high.x - low.x) * (sample_y - low.y) > (sample_x - low.x) * (high.y - low.y);
    if (crossed) winding += to_above ? 1 : -1;
  }
  return winding;
}

SnappedPoint snapped(const glm::vec4& clip, const PixelGrid& grid) {
  // The quotient of two floats in double, rounded to float, is the float quotient.
  const float per_w = float(1.0 / double(clip.w));
  const auto units = [&](float ndc_w, int size) {
    const float ndc = ndc_w * per_w, half = float(size * (units_a_pixel / 2));
    return int64_t(std::llrint(double(std::fma(ndc, half, half))));
  };
  return {units(clip.x, grid.width), units(clip.y, grid.height)};
}

std::optional<std::vector<glm::vec4>> cut_triangle(const std::array<glm::vec4, 3>& clip,
                                                   const PixelGrid& grid) {
  const float guard_x = float(guard_units / (units_a_pixel / 2)) / float(grid.width);
  const float guard_y = float(guard_units / (units_a_pixel / 2)) / float(grid.height);
  std::vector<glm::vec4> polygon(clip.begin(), clip.end());
  if (!std::all_of(polygon.begin(), polygon.end(), finite_corner)) return {};
  for (const CutPlane plane : cut_planes) polygon = cut_polygon(polygon, plane, guard_x, guard_y);
  for (const glm::vec4& v : polygon) {
    if (!finite_corner(v) || !(v.w >= 0x1p-126f)) return {};
  }
  return polygon;
}

void CoverageOracle::add(const CoverageTriangle& triangle) {
  const auto polygon = cut_triangle(triangle.clip, grid_);
  if (!polygon) ++invalid_;
  if (polygon) {
    for (size_t i = 2; i < polygon->size(); ++i)
      add_part({(*polygon)[0], (*polygon)[i - 1], (*polygon)[i]}, triangle);
  }
  ++count_;
}

void CoverageOracle::add_part(const std::array<glm::vec4, 3>& clip, const CoverageTriangle& triangle) {
  std::array<SnappedPoint, 3> p;
  for (int i = 0; i < 3; ++i) p[i] = snapped(clip[i], grid_);
  const int64_t twice_area = twice_area_of(p[0], p[1], p[2]);
  const bool front = triangle.mirrored ? twice_area < 0 : twice_area > 0;
  if (twice_area == 0 || (!front && !triangle.two_sided)) return;
  const auto corners = std::bit_cast<std::array<uint32_t, 12>>(triangle.clip);
  const uint32_t alike = first_of_corners_.try_emplace(corners, count_).first->second;

  const auto [left, right] = std::minmax({p[0].x, p[1].x, p[2].x});
  const auto [bottom, top] = std::minmax({p[0].y, p[1].y, p[2].y});
  const auto pixel = [](int64_t units, int most) {
    return int(std::clamp<int64_t>(units / units_a_pixel, 0, most));
  };
  const TriangleDepth depth(triangle.clip, clip, p, grid_);
  for (int y = pixel(bottom, grid_.height - 1); y <= pixel(top, grid_.height - 1); ++y) {
    for (int x = pixel(left, grid_.width - 1); x <= pixel(right, grid_.width - 1); ++x) {
      const SnappedPoint sample{int64_t(x) * units_a_pixel + sample_.x,
                                int64_t(y) * units_a_pixel + sample_.y};
      if (winding_at(p, sample) == 0) continue;
      const DepthAt at = depth.at(sample);
      const CoveredPixel covered{count_, at.depth, at.bound, alike};
      std::vector<CoveredPixel>& here = pixels_[grid_.index(x, y)];
      if (here.empty() || here.back().triangle != count_) {
        here.push_back(covered);
      } else if (covered.depth > here.back().depth) {
        here.back() = covered;
      }
    }
  }
}

std::string wrong_at(const std::vector<CoveredPixel>& covered, uint32_t triangle, float depth) {
  const CoveredPixel* shown = nullptr;
  for (const CoveredPixel& c : covered) {
    if (c.triangle == triangle) shown = &c;
    if (c.depth - c.bound > std::max<double>(depth, min_depth)) {
      return fmt::format("triangle {} at depth {} lies in front of triangle {} at {}", c.triangle, c.depth,
                         int32_t(triangle), depth);
    }
  }
  if (triangle == 0xffffffffu) return depth == 0 ? "" : fmt::format("no triangle, but depth {}", depth);
  if (!shown) return fmt::format("triangle {} does not cover the pixel", triangle);
  for (const CoveredPixel& c : covered) {
    if (c.alike == shown->alike && c.alike != 0xffffffffu && c.triangle > triangle)
      return fmt::format("triangle {} has the corners of triangle {} and comes later", c.triangle, triangle);
  }
  if (std::abs(depth - shown->depth) > shown->bound) {
    return fmt::format("triangle {} has depth {}, {} off {} where {} is allowed", triangle, depth,
                       std::abs(depth - shown->depth), shown->depth, shown->bound);
  }
  return {};
}

}  // namespace lightgrid::lab
