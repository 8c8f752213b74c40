// A culler in double with, optionally, one fault of naive code. Without one it is correct: the hard cases
// must pass on it. With one, the cases for that fault must fail; otherwise they would test nothing.
#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <utility>

#include "base/error.h"
#include "base/parallel.h"
#include "culling/cull_view.h"
#include "hard_cases/faults.h"
#include "hard_cases/naive_rasterizer.h"
#include "reference/cone_cell.h"
#include "reference/position.h"
#include "verify/cell_oracle.h"

namespace lightgrid::verify {

class NaiveCuller : public CullEngine {
 public:
  explicit NaiveCuller(Fault fault) : fault_(fault) {}
  std::string name() const override { return "naive"; }
  bool is_the_library() const override { return false; }

  HostGrid cull(const CullerOptions& o, const CullView& view, std::span<const CullLight> lights,
                std::span<const DepthInterval> bounds) override {
    check(o, view, lights.size());
    return cull_masked(o, view, lights, bounds, {});
  }

  std::vector<DepthInterval> depth_bounds(const CullerOptions& o, const CullView& view,
                                          const DepthImage& depth, bool blend) override {
    check(o, view, 0);
    std::vector<DepthInterval> bounds;
    for (size_t tile = 0; tile < tile_count(view, o.tile); ++tile)
      bounds.push_back(scan(o, view, depth, tile, blend));
    return bounds;
  }

  HostGrid cull_depth(const CullerOptions& o, const CullView& view, std::span<const CullLight> lights,
                      const DepthImage& depth, bool blend) override {
    std::vector<DepthInterval> bounds = depth_bounds(o, view, depth, blend);
    if (o.depth_bounds == DepthBoundsMode::none)
      std::fill(bounds.begin(), bounds.end(), DepthInterval{is_orthographic(view) ? -1e18f : 0.0f, 1e18f});
    std::vector<Mask> masks;
    const bool masked = fault_ == Fault::mask_bin_32 || fault_ == Fault::mask_of_stored_depth ||
                        fault_ == Fault::mask_in_float;
    check(o, view, lights.size());
    if (masked && o.depth_bounds == DepthBoundsMode::mask32) {
      for (size_t tile = 0; tile < bounds.size(); ++tile) masks.push_back(mask_of(o, view, depth, tile));
    }
    return cull_masked(o, view, lights, bounds, masks);
  }

  std::optional<RasterImage> rasterize(const RasterOptions&, const RasterInput& input) override {
    return naive_image(input, fault_);
  }

 private:
  static float down(double x) { return std::nextafter(float(x), -1e30f); }
  static float up(double x) { return std::nextafter(float(x), 1e30f); }

  // Projections other than the two kinds, and more list entries than 32 bits count.
  void check(const CullerOptions& o, const CullView& view, size_t lights) const {
    if (fault_ != Fault::totals_of_32_bits &&
        lights * tile_count(view, o.tile) * (view.slice_edges.size() + 1) >> 32)
      throw machine_error("more list entries than 32 bits count");
    if (fault_ == Fault::projections_unchecked) return;
    const bool orthographic = is_orthographic(view);
    for (int c = 0; c < 4; ++c) {
      for (int r = 0; r < 4; ++r) {
        const bool used = (c == r && c < 3) || (c == 3 && r == 2) || (r < 2 && c == (orthographic ? 3 : 2)) ||
                          (r == 3 && c == (orthographic ? 3 : 2));
        if (!used && view.clip_from_view[c][r] != 0)
          throw input_error("clip_from_view[{}][{}] is not 0", r, c);
      }
    }
  }

  struct DepthInterval64 {
    double near, far;
  };

  struct Mask {
    double near = no_end, far = -no_end;
    uint32_t bits = 0;
    double bin(double distance) const { return (distance - near) / (far - near) * 32; }
  };

  template <typename Body>
  void for_each_value(const CullerOptions& o, const CullView& view, const DepthImage& depth, size_t tile,
                      const Body& body) const {
    const int x0 = int(tile % tiles_x(view, o.tile)) * o.tile,
              y0 = int(tile / tiles_x(view, o.tile)) * o.tile;
    const int x1 = std::min(x0 + o.tile, view.width), y1 = std::min(y0 + o.tile, view.height);
    const int row = depth.row_pixels ? depth.row_pixels : view.width;
    const bool whole = fault_ == Fault::viewport_ignored;
    if (fault_ == Fault::partial_tiles_dropped && (x1 - x0 < o.tile || y1 - y0 < o.tile)) return;
    for (int y = y0; y < y1; ++y) {
      for (int x = x0; x < x1; ++x) {
        if (fault_ == Fault::last_pixel_forgotten && x == x0 + o.tile - 1 && y == y0 + o.tile - 1) continue;
        for (int s = 0; s < (fault_ == Fault::first_sample_only ? 1 : depth.samples); ++s)
          body(depth.values[((size_t(y) + (whole ? 0 : depth.y)) * row + x + (whole ? 0 : depth.x)) *
                                depth.samples +
                            s]);
      }
    }
  }

  DepthInterval scan(const CullerOptions& o, const CullView& view, const DepthImage& depth, size_t tile,
                     bool blend) const {
    double near = no_end, far = -no_end, farthest = 0;
    bool invalid = false, sky = false;
    int32_t least = std::numeric_limits<int32_t>::max();
    for_each_value(o, view, depth, tile, [&](float value) {
      int32_t bits;
      std::memcpy(&bits, &value, 4);
      if (!(value >= 0 && value <= 1)) {
        invalid |= fault_ != Fault::invalid_depth_ignored;
        if (fault_ == Fault::signed_minimum) least = std::min(least, bits);
      } else if (value == depth_of_nothing(view)) {
        sky = true;
        if (fault_ == Fault::signed_minimum && std::signbit(value)) least = std::min(least, bits);
      } else {
        widen(o, view, value, near, far);
        farthest = std::max(farthest, distance_at(view, value));
        least = std::min(least, bits);
      }
    });
    if (fault_ == Fault::signed_minimum && least < 0) return {down(near), down(near)};
    if (invalid || farthest > 1e15) return {is_orthographic(view) ? -1e18f : 0.0f, 1e18f};
    if (sky && fault_ == Fault::sky_in_maximum) far = 1e18, near = std::min(near, 1e18);
    if (blend) return {0, sky || near > far ? 1e18f : up(std::min(far, 1e18))};
    if (near > far) return {1e18f, -1e18f};
    if (fault_ == Fault::standard_depth_as_reversed && has_standard_depth(view)) std::swap(near, far);
    return {down(near), up(std::min(far, 1e18))};
  }

  // By half a step of the format, the largest change by rounding to it; for D32F too, because the surface's
  // own depth was rounded.
  void widen(const CullerOptions& o, const CullView& view, float value, double& near, double& far) const {
    double step = 0.5 * (std::nextafter(value, 2.0f) - value);
    if (o.depth_format == DepthFormat::d16) step = 0.5 / 65535;
    if (o.depth_format == DepthFormat::d24) step = 0.5 / 16777215 + 0x1p-25;
    if (fault_ == Fault::format_ignored) step = 0;
    for (const double v : {value - step, value + step}) {
      double d = distance_at(view, v);
      if (!is_orthographic(view) && !(d > 0)) d = 1e18;
      near = std::min(near, d), far = std::max(far, d);
    }
  }

  Mask mask_of(const CullerOptions& o, const CullView& view, const DepthImage& depth, size_t tile) const {
    Mask mask;
    std::vector<double> distances;
    for_each_value(o, view, depth, tile, [&](float value) {
      if (!(value >= 0 && value <= 1) || value == depth_of_nothing(view)) return;
      const glm::dmat4& clip = view.clip_from_view;
      const bool in_float = fault_ == Fault::mask_in_float && is_orthographic(view);
      const float a = float(1 / clip[2][2]), b = float(clip[3][2] / clip[2][2]);
      distances.push_back(in_float ? double(b - value * a) : distance_at(view, value));
      if (fault_ == Fault::mask_of_stored_depth) widen(o, view, value, mask.near, mask.far);
      mask.near = std::min(mask.near, distances.back()), mask.far = std::max(mask.far, distances.back());
    });
    for (const double d : distances) {
      const double bin = fault_ == Fault::mask_bin_32 ? mask.bin(d) : std::min(mask.bin(d), 31.0);
      if (bin >= 0 && bin < 32) mask.bits |= 1u << int(bin);
    }
    return mask;
  }

  std::vector<OracleLight> view_lights(const CullView& view, std::span<const CullLight> lights) const {
    std::vector<OracleLight> all = oracle_lights(view, lights);
    const glm::dvec3 middle = median_light(lights);
    for (size_t i = 0; i < all.size(); ++i) {
      OracleLight& light = all[i];
      if (fault_ == Fault::float_world)
        light.position =
            glm::mat3(view.view_from_world) * (glm::vec3(lights[i].position) - glm::vec3(view.eye));
      if (fault_ == Fault::radius_squared) light.radius = std::abs(light.radius), light.lists_nothing = false;
      if (fault_ == Fault::world_direction) light.axis = lights[i].direction;
      const glm::dvec3 from_middle = lights[i].position - middle;
      if (fault_ == Fault::cones_without_position_error) {
        light.position = to_view(view, middle + glm::dvec3(glm::vec3(from_middle)));
        light.radius += 2 * light.position_error;
      }
      const double far = glm::length(from_middle);
      if (fault_ == Fault::dropped_by_the_median && far > 1e18 && light.radius < far / 4)
        light.lists_nothing = true;
    }
    return all;
  }

  // The distances that a slice's edge may represent: shading compares depths with the edge's rounded depth,
  // and the surface's own depth was rounded to the format.
  DepthInterval64 edge_range(const CullerOptions& o, const CullView& view, double edge) const {
    DepthInterval64 range{edge, edge};
    if (fault_ != Fault::edges_not_widened)
      widen(o, view, float(depth_at(view, edge)), range.near, range.far);
    return range;
  }

  Cell cell(const CullerOptions& o, CullView view, size_t index, DepthInterval b) const {
    if (fault_ == Fault::empty_interval_as_range && b.near > b.far) std::swap(b.near, b.far);
    if (fault_ == Fault::symmetric_frustum)
      for (const int i : {0, 1}) view.clip_from_view[2][i] = view.clip_from_view[3][i] = 0;
    const std::vector<float> edges = std::exchange(view.slice_edges, {});
    const size_t tiles = tile_count(view, o.tile), slice = index / tiles;
    Cell c = cell_of(view, o.tile, index % tiles, b, o.pixel_centres);
    if (slice > 0) c.near = std::max(c.near, edge_range(o, view, edges[slice - 1]).near);
    if (slice < edges.size()) c.far = std::min(c.far, edge_range(o, view, edges[slice]).far);
    if (fault_ == Fault::slopes_in_float) round_slopes(o, view, index % tiles, c);
    if (fault_ == Fault::last_slice_closed && slice && slice == edges.size())
      c.far = std::min(c.far, 2.0 * edges.back());
    if (fault_ == Fault::first_slice_from_near && !edges.empty() && slice == 0)
      c.near = std::max(c.near, edges[0] / 2.0);
    return c;
  }

  static void round_slopes(const CullerOptions& o, const CullView& view, size_t tile, Cell& c) {
    const ViewParams p = view_params(view, o.tile);
    const float inset = o.pixel_centres ? 0.5f : 0.0f;
    const int x = int(tile % tiles_x(view, o.tile)) * o.tile, y = int(tile / tiles_x(view, o.tile)) * o.tile;
    const auto slope = [](float scale, float pixel, float offset) { return float(scale * pixel) + offset; };
    c.x0 = slope(p.slope_x_scale, float(x) + inset, p.slope_x_offset);
    c.x1 = slope(p.slope_x_scale, float(std::min(x + o.tile, view.width)) - inset, p.slope_x_offset);
    c.y0 = slope(p.slope_y_scale, float(y) + inset, p.slope_y_offset);
    c.y1 = slope(p.slope_y_scale, float(std::min(y + o.tile, view.height)) - inset, p.slope_y_offset);
  }

  static double with_slack(const OracleLight& l) {
    return l.radius +
           24 * 0x1p-24 *
               (std::abs(l.position.x) + std::abs(l.position.y) + std::abs(l.position.z) + l.radius);
  }

  // The squared distance to the cell's box against the squared radius, in float.
  static bool box_in_float(const Cell& c, const OracleLight& l) {
    const double s0 = c.scale_at(c.near), s1 = c.scale_at(std::min(c.far, 1e18));
    const glm::dvec3& p = l.position;
    const float bx =
        float(std::max({std::min(c.x0 * s0, c.x0 * s1) - p.x, p.x - std::max(c.x1 * s0, c.x1 * s1), 0.0}));
    const float by =
        float(std::max({std::min(c.y0 * s0, c.y0 * s1) - p.y, p.y - std::max(c.y1 * s0, c.y1 * s1), 0.0}));
    const float bz = float(std::max({c.near + p.z, -p.z - c.far, 0.0})), r = float(with_slack(l));
    return bx * bx + by * by + bz * bz <= r * r;
  }

  // Planes and box in float, as in the kernels but without slack.
  static bool float_test(const Cell& c, const OracleLight& l, bool cross_products) {
    const float x = float(l.position.x), y = float(l.position.y), d = float(-l.position.z),
                r = float(l.radius);
    const float x0 = float(c.x0), x1 = float(c.x1), y0 = float(c.y0), y1 = float(c.y1);
    const float n = float(c.near), f = float(std::min(c.far, 1e18)), s0 = c.orthographic ? 1 : n,
                s1 = c.orthographic ? 1 : f;
    if (cross_products && !c.orthographic) {
      const glm::vec3 corners[4] = {{x0, y0, 1}, {x1, y0, 1}, {x1, y1, 1}, {x0, y1, 1}}, p(x, y, d);
      for (int i = 0; i < 4; ++i)
        if (glm::dot(glm::normalize(glm::cross(corners[i], corners[(i + 1) % 4])), p) < -r) return false;
      return d + r >= n && d - r <= f;
    }
    const float bx = std::max({std::min(x0 * s0, x0 * s1) - x, x - std::max(x1 * s0, x1 * s1), 0.0f});
    const float by = std::max({std::min(y0 * s0, y0 * s1) - y, y - std::max(y1 * s0, y1 * s1), 0.0f});
    const float bz = std::max({n - d, d - f, 0.0f});
    const float e = c.orthographic ? 1 : d, t = c.orthographic ? 0 : 1;
    const auto side = [&](float value, float slope) {
      return value >= -r * std::sqrt(1 + t * slope * slope);
    };
    return bx * bx + by * by + bz * bz <= r * r && side(x - x0 * e, x0) && side(x1 * e - x, x1) &&
           side(y - y0 * e, y0) && side(y1 * e - y, y1);
  }

  bool cone_sphere(const Cell& c, const OracleLight& l) const {
    const double far = std::min(c.far, 1e6), near = std::max(c.near, -1e6), s = c.scale_at((near + far) / 2);
    const glm::dvec3 centre((c.x0 + c.x1) / 2 * s, (c.y0 + c.y1) / 2 * s, -(near + far) / 2);
    const double sf = c.scale_at(far);
    const double reach = glm::length(glm::dvec3((c.x1 - c.x0) * sf, (c.y1 - c.y0) * sf, far - near)) / 2;
    const glm::dvec3 v = centre - l.position;
    const double along = glm::dot(v, l.axis), across = glm::length(glm::cross(v, l.axis));
    const double sine = std::sqrt(std::max(0.0, 1 - l.cos_outer * l.cos_outer));
    return across * l.cos_outer - along * sine <= reach && along >= -reach;
  }

  bool listed(const CullView& view, const Cell& c, const OracleLight& l) const {
    if (l.lists_nothing || !(c.near <= c.far)) return false;
    if (fault_ == Fault::centres_only && (-l.position.z < 0 || -l.position.z > 100)) return false;
    if (fault_ == Fault::float_without_slack || fault_ == Fault::cross_product_planes) {
      if (!float_test(c, l, fault_ == Fault::cross_product_planes)) return false;
    } else if (fault_ == Fault::projected_rectangle && !c.orthographic) {
      const double d = -l.position.z, x = l.position.x / d, y = l.position.y / d, r = l.radius / d;
      if (x + r < c.x0 || x - r > c.x1 || y + r < c.y0 || y - r > c.y1 || d + l.radius < c.near ||
          d - l.radius > c.far)
        return false;
    } else if (fault_ == Fault::box_ends_swapped) {
      const double s0 = c.scale_at(c.near), s1 = c.scale_at(std::min(c.far, 1e18));
      const glm::dvec3& p = l.position;
      const double bx = std::max({c.x0 * s1 - p.x, p.x - c.x1 * s1, 0.0}),
                   by = std::max({c.y0 * s0 - p.y, p.y - c.y1 * s0, 0.0});
      if (std::hypot(bx, by) > l.radius || !sphere_touches_cell(c, p, l.radius)) return false;
    } else if (fault_ == Fault::squares_underflow) {
      if (!sphere_touches_cell(c, l.position, with_slack(l)) || !box_in_float(c, l)) return false;
    } else if (!sphere_touches_cell(c, l.position,
                                    fault_ == Fault::slopes_in_float ? with_slack(l) : l.radius)) {
      return false;
    }
    if (fault_ == Fault::no_cones_past_90 && l.cos_outer > -1) return cone_sphere(c, l);
    (void)view;
    return l.cos_outer <= -1 || cone_touches_cell(c, l.position, l.axis, l.cos_outer, l.radius) != Touch::no;
  }

  std::vector<uint32_t> z_bins(const CullerOptions& o, const CullView& view,
                               const std::vector<OracleLight>& lights) const {
    const std::vector<float>& edges = view.z_bin_edges;
    std::vector<double> nearest, farthest;  // that each edge may represent
    for (const float edge : edges) {
      const DepthInterval64 range = edge_range(o, view, edge);
      nearest.push_back(range.near), farthest.push_back(range.far);
    }
    const auto reached = [](const std::vector<double>& ends, double to) {
      return uint32_t(std::upper_bound(ends.begin(), ends.end(), to) - ends.begin());
    };
    std::vector<uint32_t> words;
    for (const OracleLight& l : lights) {
      const double d = -l.position.z, reach = fault_ == Fault::z_bin_of_centre ? 0 : l.radius;
      uint32_t end = reached(nearest, d + reach) + 1;
      if (fault_ == Fault::last_z_bin_closed && d - reach > 2 * edges.back()) end = 0;
      words.push_back(l.lists_nothing ? 0 : reached(farthest, d - reach) | end << 16);
    }
    return words;
  }

  HostGrid cull_masked(const CullerOptions& o, const CullView& view, std::span<const CullLight> lights,
                       std::span<const DepthInterval> bounds, const std::vector<Mask>& masks) {
    const std::vector<OracleLight> all = view_lights(view, lights);
    HostGrid grid;
    grid.cells_x = tiles_x(view, o.tile), grid.cells_y = int(bounds.size()) / grid.cells_x;
    grid.slices = int(view.slice_edges.size()) + 1;
    if (lights.size() * bounds.size() * grid.slices >> 32) {  // overflow: nothing remains
      grid.cells.resize(bounds.size() * grid.slices);
      return grid;
    }
    std::vector<std::vector<uint32_t>> lists(bounds.size() * grid.slices);
    parallel_for(int(lists.size()), [&](int i) {
      const DepthInterval& b = bounds[size_t(i) % bounds.size()];
      const Cell c = cell(o, view, size_t(i), b);
      for (uint32_t light = 0; light < all.size(); ++light) {
        if (fault_ == Fault::zero_means_none && light == 0) continue;
        if (clearly_apart(c, all[light]) && fault_ == Fault::none) continue;
        if (!listed(view, c, all[light])) continue;
        if (!masks.empty()) {
          const Mask& mask = masks[size_t(i) % bounds.size()];
          const double d = -all[light].position.z, from = mask.bin(d - all[light].radius),
                       to = mask.bin(d + all[light].radius);
          uint32_t bits = 0;
          for (int bin = 0; bin < 32; ++bin) bits |= bin + 1 >= from && bin <= to ? 1u << bin : 0;
          if (!(bits & mask.bits)) continue;
        }
        if (fault_ == Fault::capacity_of_256 && lists[i].size() == 256) continue;
        lists[i].push_back(fault_ == Fault::sixteen_bit_indices ? light & 0xffff : light);
      }
      if (fault_ == Fault::eight_bit_counts) lists[i].resize(lists[i].size() & 0xff);
      if (fault_ == Fault::order_by_chance && lists[i].size() > 1 && runs_++ % 2)
        std::swap(lists[i][0], lists[i][1]);
    });
    for (const auto& list : lists) {
      grid.cells.emplace_back(grid.indices.size(), list.size());
      grid.indices.insert(grid.indices.end(), list.begin(), list.end());
    }
    if (!view.z_bin_edges.empty()) grid.z_bins = z_bins(o, view, all);
    return grid;
  }

  Fault fault_;
  std::atomic<uint64_t> runs_ = 0;
};

}  // namespace lightgrid::verify
