#include "oracle/cell.h"

#include <algorithm>
#include <cmath>

#include "oracle/position.h"
#include "shared/cull_tests.h"

namespace lightgrid::lab {
namespace {

double outside(double value, double low, double high) { return std::max({low - value, value - high, 0.0}); }

// To the cell's cross-section at one depth, which is a rectangle.
double distance_at_depth(const Cell& cell, const glm::dvec3& p, double depth) {
  const double scale = cell.scale_at(depth);
  return std::hypot(outside(p.x, cell.x0 * scale, cell.x1 * scale),
                    outside(p.y, cell.y0 * scale, cell.y1 * scale), -p.z - depth);
}

constexpr double u = 0x1p-24;  // one rounding in float
constexpr double no_end = std::numeric_limits<double>::infinity();
constexpr double far_away = 1e17;       // the kernels' infinity is 1e18
constexpr double farthest = 1e30;       // end of the boxes of endless cells, past all lights and surfaces
constexpr double min_radius = 2e-18;    // metres, the least uploaded radius
constexpr double gentle_slope = 2;      // up to this slope the exact test converges in its three Newton steps
constexpr double endless_near = -1e12;  // near of orthographic cells: the oracle's cones need a finite one

double steepest_slope(const View& v) {
  return std::max({std::abs(view_x_of_pixel(v, 0)), std::abs(view_x_of_pixel(v, v.width)),
                   std::abs(view_y_of_pixel(v, 0)), std::abs(view_y_of_pixel(v, v.height))});
}

double tile_slope(const View& view, int tile) {
  return tile * 2 *
         std::max(1 / (view.clip_from_view[0][0] * view.width),
                  1 / (view.clip_from_view[1][1] * view.height));
}

// The cone against the sphere around the box, its cosine wider by 1e-6.
bool cone_possibly_touches(const CellBox& b, const OracleLight& light, double margin) {
  const double reach = b.radius() + margin;
  if (!(reach < far_away)) return true;
  const double cosine = std::max(-1.0, light.cos_outer - 1e-6),
               sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
  const glm::dvec3 v = b.centre() - light.position;
  const double along = glm::dot(v, light.axis), across = glm::length(glm::cross(v, light.axis));
  const double more = margin + 64 * u * (std::abs(v.x) + std::abs(v.y) + std::abs(v.z));
  return across * cosine - along * sine <= reach + more && along >= -reach - more;
}

}  // namespace

Cell cell_of_pixels(const View& view, double px0, double py0, double px1, double py1, double near,
                    double far) {
  return {view_x_of_pixel(view, px0),
          view_x_of_pixel(view, px1),
          view_y_of_pixel(view, py0),
          view_y_of_pixel(view, py1),
          near,
          far,
          view.orthographic};
}

// The squared distance as a function of depth is convex, has a continuous slope and consists of parabolas:
// one for each choice of the sides that the point is outside of. Its minimum is at the vertex of one of the
// parabolas or at an end, so testing the nine vertices, clamped to the ends, finds it.
double distance_to_cell(const Cell& cell, const glm::dvec3& p) {
  if (cell.orthographic) return distance_at_depth(cell, p, std::clamp(-p.z, cell.near, cell.far));
  double nearest = std::numeric_limits<double>::infinity();
  for (double slope_x : {0.0, cell.x0, cell.x1}) {
    for (double slope_y : {0.0, cell.y0, cell.y1}) {
      // Vertex of (x - slope_x d)^2 [if outside in x] + (y - slope_y d)^2 [if outside in y] + (-z - d)^2. A
      // side of slope 0 adds a constant, and so does the absence of a side.
      const double bottom =
          (p.x * slope_x + p.y * slope_y - p.z) / (slope_x * slope_x + slope_y * slope_y + 1);
      nearest = std::min(nearest, distance_at_depth(cell, p, std::clamp(bottom, cell.near, cell.far)));
    }
  }
  return nearest;
}

bool sphere_touches_cell(const Cell& cell, const glm::dvec3& centre, double radius) {
  return distance_to_cell(cell, centre) <= radius;
}

double outside_of_sides(const Cell& c, const glm::dvec3& p) {
  const double d = c.scale_at(-p.z), tip = c.orthographic ? 0 : 1;
  const auto side = [&](double beyond, double slope) { return beyond / std::sqrt(1 + tip * slope * slope); };
  return std::max({side(c.x0 * d - p.x, c.x0), side(p.x - c.x1 * d, c.x1), side(c.y0 * d - p.y, c.y0),
                   side(p.y - c.y1 * d, c.y1)});
}

glm::dvec3 CellBox::centre() const { return {(x0 + x1) / 2, (y0 + y1) / 2, -(d0 + d1) / 2}; }

double CellBox::radius() const { return 0.5 * glm::length(glm::dvec3(x1 - x0, y1 - y0, d1 - d0)); }

double CellBox::distance(const glm::dvec3& p) const {
  return std::hypot(outside(p.x, x0, x1), outside(p.y, y0, y1), outside(-p.z, d0, d1));
}

CellBox box_around(const Cell& c) {
  const double s0 = c.scale_at(c.near), s1 = c.scale_at(std::min(c.far, farthest));
  return {std::min(c.x0 * s0, c.x0 * s1),
          std::max(c.x1 * s0, c.x1 * s1),
          std::min(c.y0 * s0, c.y0 * s1),
          std::max(c.y1 * s0, c.y1 * s1),
          c.near,
          c.far};
}

Cell cell_of_grid(const View& v, int tile, std::span<const float> slice_edges, size_t index, double near,
                  double far, bool pixel_centres) {
  const size_t across = size_t((v.width + tile - 1) / tile), tiles = across * ((v.height + tile - 1) / tile);
  const size_t at = index % tiles, slice = index / tiles;
  const int tx = int(at % across), ty = int(at / across);
  const double inset = pixel_centres ? 0.5 : 0;
  Cell cell =
      cell_of_pixels(v, tx * tile + inset, ty * tile + inset, std::min((tx + 1) * tile, v.width) - inset,
                     std::min((ty + 1) * tile, v.height) - inset, near, far);
  if (far >= far_away && near <= far) cell.far = no_end;
  if (v.orthographic && near <= -far_away) cell.near = endless_near;
  if (slice > 0) cell.near = std::max(cell.near, double(slice_edges[slice - 1]));
  if (slice < slice_edges.size()) cell.far = std::min(cell.far, double(slice_edges[slice]));
  return cell;
}

bool clearly_apart(const Cell& cell, const OracleLight& light) {
  if (light.lists_nothing || !(cell.near <= cell.far)) return true;
  if (light.radius > far_away) return false;
  return box_around(cell).distance(light.position) > light.radius * (1 + 1e-12);
}

bool certainly_touches(const Cell& cell, const OracleLight& light) {
  if (clearly_apart(cell, light)) return false;
  if (light.cos_outer <= -1) return sphere_touches_cell(cell, light.position, light.radius);
  return cone_touches_cell(cell, light.position, light.axis, light.cos_outer, light.radius) == Touch::yes;
}

bool possibly_touches(const View& view, int tile, const Cell& cell, const OracleLight& light, CullTest test) {
  if (light.lists_nothing || !(cell.near <= cell.far)) return false;
  const glm::dvec3& p = light.position;
  const double r = light.radius + light.position_error;
  if (r > far_away) return true;
  // 24 u of slack and 8 u of rounding; plus 32 u for the sides' slopes, and for the tangents and tile
  // coordinates. Both slopes of the image's corner, at most the steepest, have 12 u of slack.
  const double sum = std::abs(p.x) + std::abs(p.y) + std::abs(p.z) + r, steep = steepest_slope(view);
  const double reach_of_slopes = cell.orthographic ? 1 : std::abs(p.z) + r;
  const double margin =
      min_radius + 64 * u * sum + 44 * u * (2 * steep + tile_slope(view, tile)) * reach_of_slopes;
  const double near = cell.near == endless_near ? 0 : std::abs(cell.near);
  const bool endless = cell.far > far_away || cell.near == endless_near;
  const double ends =
      cell.far > far_away ? (cell.orthographic ? near : far_away) : std::max(near, std::abs(cell.far));
  const double box_margin = min_radius + 32 * u * sum + u * (16 + 24 * steep) * (ends + reach_of_slopes);
  const CellBox box = box_around(cell);
  if (outside(-p.z, cell.near, cell.far) > r + box_margin) return false;
  const CullTestRow& parts = row_of(test);
  if (parts.planes && outside_of_sides(cell, p) > r + margin) return false;
  if (parts.box && box.distance(p) > r + box_margin) return false;
  if (parts.distance && steep <= gentle_slope && distance_to_cell(cell, p) > r + box_margin) return false;
  if (parts.sphere && !endless) {
    if (glm::length(p - box.centre()) > box.radius() * (1 + 40 * u) + r + box_margin) return false;
  }
  return light.cos_outer < 0 || endless ||
         cone_possibly_touches(box, light, light.cone_error + box_margin + 64 * u * (1 + steep) * sum);
}

}  // namespace lightgrid::lab
