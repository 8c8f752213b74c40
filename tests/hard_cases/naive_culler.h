// A culler in double with, when asked, one fault that naive code has. Without one it is right: the hard cases must pass
// on it. With one, the cases made for that fault must fail; else they test nothing.
#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>

#include "base/parallel.h"
#include "reference/cone_cell.h"
#include "reference/position.h"
#include "study/verify/truth.h"

namespace lightgrid::verify {

enum class Fault {
  none,
  float_without_slack,        // planes and box in float, the radius as it is
  cross_product_planes,       // side planes as cross products of rays through the corners, in float
  box_ends_swapped,           // the box from x0 * near and x1 * far whatever their signs
  symmetric_frustum,          // slopes from the field of view alone
  sky_in_maximum,             // what nothing covers counts as far
  strange_depth_ignored,      // NaN, infinite, negative depth passed over
  signed_minimum,             // the least depth by its bits as a signed integer
  last_pixel_forgotten,       // of each tile
  partial_tiles_dropped,
  first_sample_only,
  viewport_ignored,
  format_ignored,             // no widening by the format's step
  standard_depth_as_reversed, // the sky's value alone tells which it is
  empty_interval_as_range,    // near and far sorted
  mask_bin_32,                // 32 bins, the last value past them; no bin at all where zmin = zmax
  eight_bit_counts,
  zero_means_none,
  capacity_of_256,
  sixteen_bit_indices,
  order_by_chance,
  centres_only,               // lights whose centre is behind the eye or past far
  projected_rectangle,        // radius / distance around the projected centre
  float_world,                // world positions as float
  radius_squared,             // -r as r
  no_cones_past_90,           // the cone-sphere test, at any angle
  last_slice_closed,
  first_slice_from_near,      // from half its edge
  world_direction,            // cone axes not turned into view space
  z_bin_of_centre,            // a light in the z-bin of its centre alone
  last_z_bin_closed,
};

class NaiveCuller : public CullEngine {
 public:
  explicit NaiveCuller(Fault fault) : fault_(fault) {}
  std::string name() const override { return "naive"; }
  bool is_the_library() const override { return false; }

  HostGrid cull(const CullerOptions& o, const CullView& view, std::span<const CullLight> lights,
                std::span<const DepthInterval> bounds) override {
    return cull_masked(o, view, lights, bounds, {});
  }

  std::vector<DepthInterval> depth_bounds(const CullerOptions& o, const CullView& view, const DepthImage& depth,
                                       bool blend) override {
    std::vector<DepthInterval> bounds;
    for (size_t tile = 0; tile < tile_count(view, o.tile); ++tile) bounds.push_back(scan(o, view, depth, tile, blend));
    return bounds;
  }

  HostGrid cull_depth(const CullerOptions& o, const CullView& view, std::span<const CullLight> lights,
                      const DepthImage& depth, bool blend) override {
    std::vector<DepthInterval> bounds = depth_bounds(o, view, depth, blend);
    if (o.depth_bounds == DepthBoundsMode::none)
      std::fill(bounds.begin(), bounds.end(), DepthInterval{is_orthographic(view) ? -1e18f : 0.0f, 1e18f});
    std::vector<Mask> masks;
    if (fault_ == Fault::mask_bin_32 && o.depth_bounds == DepthBoundsMode::mask32) {
      for (size_t tile = 0; tile < bounds.size(); ++tile) masks.push_back(mask_of(o, view, depth, tile));
    }
    return cull_masked(o, view, lights, bounds, masks);
  }

 private:
  static float down(double x) { return std::nextafter(float(x), -1e30f); }
  static float up(double x) { return std::nextafter(float(x), 1e30f); }

  struct Mask {
    double near = no_end, far = -no_end;
    uint32_t bits = 0;
    double bin(double distance) const { return (distance - near) / (far - near) * 32; }
  };

  template <typename Body>
  void for_each_value(const CullerOptions& o, const CullView& view, const DepthImage& depth, size_t tile,
                      const Body& body) const {
    const int x0 = int(tile % tiles_x(view, o.tile)) * o.tile, y0 = int(tile / tiles_x(view, o.tile)) * o.tile;
    const int x1 = std::min(x0 + o.tile, view.width), y1 = std::min(y0 + o.tile, view.height);
    const int row = depth.row_pixels ? depth.row_pixels : view.width;
    const bool whole = fault_ == Fault::viewport_ignored;
    if (fault_ == Fault::partial_tiles_dropped && (x1 - x0 < o.tile || y1 - y0 < o.tile)) return;
    for (int y = y0; y < y1; ++y) {
      for (int x = x0; x < x1; ++x) {
        if (fault_ == Fault::last_pixel_forgotten && x == x0 + o.tile - 1 && y == y0 + o.tile - 1) continue;
        for (int s = 0; s < (fault_ == Fault::first_sample_only ? 1 : depth.samples); ++s)
          body(depth.values[((size_t(y) + (whole ? 0 : depth.y)) * row + x + (whole ? 0 : depth.x)) * depth.samples + s]);
      }
    }
  }

  DepthInterval scan(const CullerOptions& o, const CullView& view, const DepthImage& depth, size_t tile, bool blend) const {
    double near = no_end, far = -no_end;
    bool strange = false, sky = false;
    int32_t least = std::numeric_limits<int32_t>::max();
    for_each_value(o, view, depth, tile, [&](float value) {
      int32_t bits;
      std::memcpy(&bits, &value, 4);
      if (!(value >= 0 && value <= 1)) {
        strange |= fault_ != Fault::strange_depth_ignored;
        if (fault_ == Fault::signed_minimum) least = std::min(least, bits);
      } else if (value == depth_of_nothing(view)) {
        sky = true;
        if (fault_ == Fault::signed_minimum && std::signbit(value)) least = std::min(least, bits);
      } else {
        widen(o, view, value, near, far);
        least = std::min(least, bits);
      }
    });
    if (fault_ == Fault::signed_minimum && least < 0) return {down(near), down(near)};
    if (strange) return {is_orthographic(view) ? -1e18f : 0.0f, 1e18f};
    if (sky && fault_ == Fault::sky_in_maximum) far = 1e18, near = std::min(near, 1e18);
    if (blend) return {0, sky || near > far ? 1e18f : up(std::min(far, 1e18))};
    if (near > far) return {1e18f, -1e18f};
    if (fault_ == Fault::standard_depth_as_reversed && has_standard_depth(view)) std::swap(near, far);
    return {down(near), up(std::min(far, 1e18))};
  }

  // By half a step of the format, which is what rounding to it may have moved the depth by; of D32F too, as what was
  // rounded is the surface's own depth.
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
      distances.push_back(distance_at(view, value));
      mask.near = std::min(mask.near, distances.back()), mask.far = std::max(mask.far, distances.back());
    });
    for (const double d : distances) {
      const double bin = mask.bin(d);
      if (bin >= 0 && bin < 32) mask.bits |= 1u << int(bin);
    }
    return mask;
  }

  std::vector<TrueLight> view_lights(const CullView& view, std::span<const CullLight> lights) const {
    std::vector<TrueLight> all = true_lights(view, lights);
    for (size_t i = 0; i < all.size(); ++i) {
      TrueLight& light = all[i];
      if (fault_ == Fault::float_world)
        light.position = glm::mat3(view.view_from_world) * (glm::vec3(lights[i].position) - glm::vec3(view.eye));
      if (fault_ == Fault::radius_squared) light.radius = std::abs(light.radius), light.lists_nothing = false;
      if (fault_ == Fault::world_direction) light.axis = lights[i].direction;
    }
    return all;
  }

  Cell cell(const CullerOptions& o, CullView view, size_t index, DepthInterval b) const {
    if (fault_ == Fault::empty_interval_as_range && b.near > b.far) std::swap(b.near, b.far);
    if (fault_ == Fault::symmetric_frustum)
      for (const int i : {0, 1}) view.clip_from_view[2][i] = view.clip_from_view[3][i] = 0;
    Cell c = cell_of(view, o.tile, index, b, o.pixel_centres);
    const size_t slice = index / tile_count(view, o.tile);
    if (fault_ == Fault::last_slice_closed && slice && slice == view.slice_edges.size())
      c.far = std::min(c.far, 2.0 * view.slice_edges.back());
    if (fault_ == Fault::first_slice_from_near && !view.slice_edges.empty() && slice == 0)
      c.near = std::max(c.near, view.slice_edges[0] / 2.0);
    return c;
  }

  // Planes and box in float, as kernels have them but for the slack.
  static bool float_test(const Cell& c, const TrueLight& l, bool cross_products) {
    const float x = float(l.position.x), y = float(l.position.y), d = float(-l.position.z), r = float(l.radius);
    const float x0 = float(c.x0), x1 = float(c.x1), y0 = float(c.y0), y1 = float(c.y1);
    const float n = float(c.near), f = float(std::min(c.far, 1e18)), s0 = c.orthographic ? 1 : n, s1 = c.orthographic ? 1 : f;
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
    const auto side = [&](float value, float slope) { return value >= -r * std::sqrt(1 + t * slope * slope); };
    return bx * bx + by * by + bz * bz <= r * r && side(x - x0 * e, x0) && side(x1 * e - x, x1) && side(y - y0 * e, y0) &&
           side(y1 * e - y, y1);
  }

  bool cone_sphere(const Cell& c, const TrueLight& l) const {
    const double far = std::min(c.far, 1e6), near = std::max(c.near, -1e6), s = c.scale_at((near + far) / 2);
    const glm::dvec3 centre((c.x0 + c.x1) / 2 * s, (c.y0 + c.y1) / 2 * s, -(near + far) / 2);
    const double sf = c.scale_at(far);
    const double reach = glm::length(glm::dvec3((c.x1 - c.x0) * sf, (c.y1 - c.y0) * sf, far - near)) / 2;
    const glm::dvec3 v = centre - l.position;
    const double along = glm::dot(v, l.axis), across = glm::length(glm::cross(v, l.axis));
    const double sine = std::sqrt(std::max(0.0, 1 - l.cos_outer * l.cos_outer));
    return across * l.cos_outer - along * sine <= reach && along >= -reach;
  }

  bool listed(const CullView& view, const Cell& c, const TrueLight& l) const {
    if (l.lists_nothing || !(c.near <= c.far)) return false;
    if (fault_ == Fault::centres_only && (-l.position.z < 0 || -l.position.z > 100)) return false;
    if (fault_ == Fault::float_without_slack || fault_ == Fault::cross_product_planes) {
      if (!float_test(c, l, fault_ == Fault::cross_product_planes)) return false;
    } else if (fault_ == Fault::projected_rectangle && !c.orthographic) {
      const double d = -l.position.z, x = l.position.x / d, y = l.position.y / d, r = l.radius / d;
      if (x + r < c.x0 || x - r > c.x1 || y + r < c.y0 || y - r > c.y1 || d + l.radius < c.near || d - l.radius > c.far)
        return false;
    } else if (fault_ == Fault::box_ends_swapped) {
      const double s0 = c.scale_at(c.near), s1 = c.scale_at(std::min(c.far, 1e18));
      const glm::dvec3& p = l.position;
      const double bx = std::max({c.x0 * s1 - p.x, p.x - c.x1 * s1, 0.0}), by = std::max({c.y0 * s0 - p.y, p.y - c.y1 * s0, 0.0});
      if (std::hypot(bx, by) > l.radius || !sphere_touches_cell(c, p, l.radius)) return false;
    } else if (!sphere_touches_cell(c, l.position, l.radius)) {
      return false;
    }
    if (fault_ == Fault::no_cones_past_90 && l.cos_outer > -1) return cone_sphere(c, l);
    (void)view;
    return l.cos_outer <= -1 || cone_touches_cell(c, l.position, l.axis, l.cos_outer, l.radius) != Touch::no;
  }

  std::vector<uint32_t> z_bins(const CullView& view, const std::vector<TrueLight>& lights) const {
    const std::vector<float>& edges = view.z_bin_edges;
    std::vector<uint32_t> words;
    for (const TrueLight& l : lights) {
      const double d = -l.position.z, ends = is_orthographic(view) ? std::abs(distance_at(view, 0)) : 0;
      const double reach = fault_ == Fault::z_bin_of_centre ? 0 : l.radius + 1e-6 * (glm::length(l.position) + l.radius + ends);
      const auto reached = [&](double to) { return uint32_t(std::upper_bound(edges.begin(), edges.end(), to) - edges.begin()); };
      uint32_t end = reached(d + reach) + 1;
      if (fault_ == Fault::last_z_bin_closed && d - reach > 2 * edges.back()) end = 0;
      words.push_back(l.lists_nothing ? 0 : reached(d - reach) | end << 16);
    }
    return words;
  }

  HostGrid cull_masked(const CullerOptions& o, const CullView& view, std::span<const CullLight> lights,
                       std::span<const DepthInterval> bounds, const std::vector<Mask>& masks) {
    const std::vector<TrueLight> all = view_lights(view, lights);
    HostGrid grid;
    grid.cells_x = tiles_x(view, o.tile), grid.cells_y = int(bounds.size()) / grid.cells_x;
    grid.slices = int(view.slice_edges.size()) + 1;
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
          const double d = -all[light].position.z, from = mask.bin(d - all[light].radius), to = mask.bin(d + all[light].radius);
          uint32_t bits = 0;
          for (int bin = 0; bin < 32; ++bin) bits |= bin + 1 >= from && bin <= to ? 1u << bin : 0;
          if (!(bits & mask.bits)) continue;
        }
        if (fault_ == Fault::capacity_of_256 && lists[i].size() == 256) continue;
        lists[i].push_back(fault_ == Fault::sixteen_bit_indices ? light & 0xffff : light);
      }
      if (fault_ == Fault::eight_bit_counts) lists[i].resize(lists[i].size() & 0xff);
      if (fault_ == Fault::order_by_chance && lists[i].size() > 1 && runs_++ % 2) std::swap(lists[i][0], lists[i][1]);
    });
    for (const auto& list : lists) {
      grid.cells.emplace_back(grid.indices.size(), list.size());
      grid.indices.insert(grid.indices.end(), list.begin(), list.end());
    }
    if (!view.z_bin_edges.empty()) grid.z_bins = z_bins(view, all);
    return grid;
  }

  Fault fault_;
  std::atomic<uint64_t> runs_ = 0;
};

}  // namespace lightgrid::verify
