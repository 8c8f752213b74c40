// A culler in double with, optionally, one fault of naive code. Without one it is correct: the hard cases
// must pass on it. With one, the cases for that fault must fail; otherwise they would test nothing.
#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "base/parallel.h"
#include "culling/cull_view.h"
#include "hard_cases/faults.h"
#include "hard_cases/naive_depth.h"
#include "hard_cases/naive_light_test.h"
#include "hard_cases/naive_rasterizer.h"
#include "oracle/position.h"
#include "verify/views.h"

namespace lightgrid::lab::verify {

class NaiveCuller : public CullEngine {
 public:
  explicit NaiveCuller(Fault fault) : fault_(fault), depth_(fault), test_(fault) {}
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
      bounds.push_back(depth_.scan(o, view, depth, tile, blend));
    return bounds;
  }

  HostGrid cull_depth(const CullerOptions& o, const CullView& view, std::span<const CullLight> lights,
                      const DepthImage& depth, bool blend) override {
    std::vector<DepthInterval> bounds = depth_bounds(o, view, depth, blend);
    if (o.depth_bounds == DepthBoundsMode::none)
      std::fill(bounds.begin(), bounds.end(), DepthInterval{is_orthographic(view) ? -1e18f : 0.0f, 1e18f});
    std::vector<NaiveMask> masks;
    const bool masked = fault_ == Fault::mask_bin_32 || fault_ == Fault::mask_of_stored_depth ||
                        fault_ == Fault::mask_in_float;
    check(o, view, lights.size());
    if (masked && o.depth_bounds == DepthBoundsMode::mask32) {
      for (size_t tile = 0; tile < bounds.size(); ++tile)
        masks.push_back(depth_.mask_of(o, view, depth, tile));
    }
    return cull_masked(o, view, lights, bounds, masks);
  }

  std::optional<RasterImage> rasterize(const RasterOptions&, const RasterInput& input) override {
    return naive_image(input, fault_);
  }

 private:
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

  std::vector<OracleLight> view_lights(const CullView& view, std::span<const CullLight> lights) const {
    std::vector<OracleLight> all = oracle_lights(view, lights);
    const glm::dvec3 middle = median_light(lights);
    for (size_t i = 0; i < all.size(); ++i) {
      OracleLight& light = all[i];
      if (fault_ == Fault::float_world)
        light.position =
            glm::mat3(view.view_from_world) * (glm::vec3(lights[i].position) - glm::vec3(view.eye));
      if (fault_ == Fault::radius_squared) {
        light.radius = std::abs(light.radius);
        light.lists_nothing = false;
      }
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
      depth_.widen(o, view, float(depth_at(view, edge)), range.near, range.far);
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

  std::vector<uint32_t> z_bins(const CullerOptions& o, const CullView& view,
                               const std::vector<OracleLight>& lights) const {
    const std::vector<float>& edges = view.z_bin_edges;
    std::vector<double> nearest, farthest;  // that each edge may represent
    for (const float edge : edges) {
      const DepthInterval64 range = edge_range(o, view, edge);
      nearest.push_back(range.near);
      farthest.push_back(range.far);
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
                       std::span<const DepthInterval> bounds, const std::vector<NaiveMask>& masks) {
    const std::vector<OracleLight> all = view_lights(view, lights);
    HostGrid grid;
    grid.cells_x = tiles_x(view, o.tile);
    grid.cells_y = int(bounds.size()) / grid.cells_x;
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
        if (!test_.listed(c, all[light])) continue;
        if (!masks.empty()) {
          const NaiveMask& mask = masks[size_t(i) % bounds.size()];
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
  NaiveDepth depth_;
  NaiveLightTest test_;
  std::atomic<uint64_t> runs_ = 0;
};

}  // namespace lightgrid::lab::verify
