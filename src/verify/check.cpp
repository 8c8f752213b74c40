#include "verify/check.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "reference/position.h"
#include "shared/cull_settings.h"
#include "shared/light_grid.h"
#include "shared/slices.h"
#include "verify/float_twin.h"

namespace lightgrid::verify {
namespace {

constexpr double farthest_surface = 1e15;  // metres; docs/hard_cases.md#the-domain

bool lights_it(const OracleLight& light, const glm::dvec3& position) {
  if (light.lists_nothing) return false;
  const glm::dvec3 way = position - light.position;
  const double distance = glm::length(way);
  if (!(distance < light.radius)) return false;
  return light.cos_outer <= -1 || glm::dot(way, light.axis) > light.cos_outer * distance * (1 + 1e-12);
}

// The nearest and farthest surface of a tile by a plain scan over all samples; near > far: none. `invalid`:
// it contains a value that is no valid depth.
struct Scan {
  double near = no_end, far = -no_end;
  bool invalid = false;
};

Scan scan_tile(const CullView& view, const DepthImage& depth, int tile, size_t index) {
  const int tx = int(index % tiles_x(view, tile)), ty = int(index / tiles_x(view, tile));
  const int row = depth.row_pixels ? depth.row_pixels : view.width;
  Scan scan;
  for (int y = ty * tile; y < std::min((ty + 1) * tile, view.height); ++y) {
    for (int x = tx * tile; x < std::min((tx + 1) * tile, view.width); ++x) {
      for (int s = 0; s < depth.samples; ++s) {
        const size_t at = (size_t(y + depth.y) * row + x + depth.x) * depth.samples + s;
        const float value = depth.values[at];
        if (!(value >= 0 && value <= 1) || (value == 0 && std::signbit(value)))
          scan.invalid = true;
        else if (value != depth_of_nothing(view)) {
          const double distance = distance_at(view, value);
          scan.near = std::min(scan.near, distance), scan.far = std::max(scan.far, distance);
        }
      }
    }
  }
  return scan;
}

}  // namespace

std::string to_string(const CullerOptions& o) {
  return fmt::format("{} {} tile {} {}", row_of(o.cull_test).name, row_of(o.depth_bounds).name, o.tile,
                     o.shape == KernelShape::lanes   ? "lanes"
                     : o.shape == KernelShape::group ? "group"
                                                     : "automatic");
}

std::span<const uint32_t> list_of(const HostGrid& grid, size_t cell) {
  return grid.cells[cell].y ? std::span(grid.indices).subspan(grid.cells[cell].x, grid.cells[cell].y)
                            : std::span<const uint32_t>();
}

std::string malformed(const HostGrid& grid, size_t lights) {
  const size_t cells = size_t(grid.cells_x) * grid.cells_y * grid.slices;
  if (grid.cells.size() != cells) return "not one first and count a cell";
  std::vector<uint32_t> order;  // by position in the index list, whose order is private to the kernels
  for (uint32_t i = 0; i < cells; ++i) {
    if (grid.cells[i].y) order.push_back(i);
  }
  std::sort(order.begin(), order.end(),
            [&](uint32_t a, uint32_t b) { return grid.cells[a].x < grid.cells[b].x; });
  uint64_t next = 0;
  for (const uint32_t i : order) {
    if (grid.cells[i].x != next)
      return fmt::format("cell {} begins at {}, not at {}", i, grid.cells[i].x, next);
    next += grid.cells[i].y;
    if (next > grid.indices.size()) return fmt::format("cell {} ends past the index list", i);
    const auto list = list_of(grid, i);
    if (std::adjacent_find(list.begin(), list.end(), std::greater_equal<>()) != list.end())
      return fmt::format("the list of cell {} is not sorted", i);
    if (list.back() >= lights) return fmt::format("cell {} lists light {}", i, list.back());
  }
  return next == grid.indices.size() ? "" : "indices that belong to no cell";
}

void Check::fail(const std::string& why) {
  if (outcome_.verdict != Verdict::fail) outcome_.why = why;
  outcome_.verdict = Verdict::fail;
}

void Check::skip(const std::string& why) {
  if (outcome_.verdict != Verdict::pass) return;
  outcome_.verdict = Verdict::skip;
  outcome_.why = why;
}

Outcome Check::outcome() const {
  Outcome outcome = outcome_;
  if (touching_) outcome.excess_ratio = double(listed_) / double(touching_);
  if (outcome.verdict == Verdict::pass && outcome.trials == 0) {  // a case without trials proves nothing
    outcome.verdict = Verdict::fail;
    outcome.why = "the case compared nothing";
  }
  return outcome;
}

std::vector<CullerOptions> Check::every_test(int tile) const {
  std::vector<CullerOptions> settings;
  for (const CullTestRow& row : cull_tests) {
    CullerOptions options;
    options.cull_test = row.test;
    options.tile = tile;
    settings.insert(row.test == CullerOptions().cull_test ? settings.begin() : settings.end(), options);
  }
  return settings;
}

std::vector<CullerOptions> Check::every_tile() const {
  std::vector<CullerOptions> settings;
  for (const int tile : {16, 8, 32, 64}) {
    CullerOptions options;
    options.tile = tile;
    settings.push_back(options);
  }
  return settings;
}

std::vector<CullerOptions> Check::in_both_shapes(const CullerOptions& options) const {
  CullerOptions lanes = options, group = options;
  lanes.shape = KernelShape::lanes, group.shape = KernelShape::group;
  if (!engine.is_the_library()) return {lanes};
  return {lanes, group};
}

HostGrid Check::same_in_every_way(const CullView& view, const std::vector<CullLight>& lights,
                                  const std::vector<DepthInterval>& bounds, const CullerOptions& options) {
  HostGrid first;
  for (const CullerOptions& shaped : in_both_shapes(options)) {
    HostGrid grid = engine.cull(shaped, view, lights, bounds);
    const std::string wrong = malformed(grid, lights.size());
    if (!wrong.empty()) throw machine_error("{}: {}", to_string(shaped), wrong);  // ends the case
    if (shaped.shape == KernelShape::lanes)
      first = std::move(grid);
    else
      that(first == grid, "{}: lanes and group differ", to_string(options));
  }
  return first;
}

void Check::hold_between(const CullView& view, std::span<const OracleLight> lights,
                         std::span<const DepthInterval> bounds, const Touching& touching,
                         const CullerOptions& options, const HostGrid& grid, bool counts) {
  if (!that(grid.cells.size() == touching.size(), "{}: {} cells for {}", to_string(options),
            grid.cells.size(), touching.size()))
    return;
  const View seen = oracle_view(view);
  for (size_t i = 0; i < touching.size(); ++i) {
    const auto list = list_of(grid, i);
    const Cell cell = cell_of(view, options.tile, i, bounds[i % bounds.size()], options.pixel_centres);
    for (const uint32_t light : touching[i]) {
      if (std::binary_search(list.begin(), list.end(), light)) continue;
      const OracleLight& l = lights[light];
      lost("{}: cell {} [{:.9g}, {:.9g}] lost light {} at {:.9g} {:.9g} {:.9g} radius {:.9g}",
           to_string(options), i, cell.near, cell.far, light, l.position.x, l.position.y, l.position.z,
           l.radius);
    }
    for (const uint32_t light : list) {
      if (possibly_touches(seen, options.tile, cell, lights[light], options.cull_test)) continue;
      const OracleLight& l = lights[light];
      fail(fmt::format(
          "{}: cell {} [{:.9g}, {:.9g}] lists light {} at {:.9g} {:.9g} {:.9g} radius {:.9g}, which cannot "
          "touch it",
          to_string(options), i, cell.near, cell.far, light, l.position.x, l.position.y, l.position.z,
          l.radius));
    }
    trials(touching[i].size() + list.size());
    if (counts) listed_ += list.size(), touching_ += touching[i].size();
  }
}

HostGrid Check::grid(const CullView& view, const std::vector<CullLight>& lights,
                     std::vector<DepthInterval> bounds, const std::vector<CullerOptions>& settings) {
  const std::vector<OracleLight> exact = oracle_lights(view, lights);
  HostGrid first;
  Touching touching;
  int tile = 0;
  const bool one_for_all = bounds.size() == 1;
  const DepthInterval one = one_for_all ? bounds[0] : DepthInterval();
  for (const CullerOptions& options : settings) {
    if (one_for_all) bounds.assign(tile_count(view, options.tile), one);
    if (options.tile != tile) {
      touching = touching_lights(view, exact, bounds, options.tile, options.pixel_centres);
      for (const auto& cell : touching) contacts(cell.size());
    }
    tile = options.tile;
    HostGrid grid = same_in_every_way(view, lights, bounds, options);
    hold_between(view, exact, bounds, touching, options, grid, &options == &settings[0]);
    if (&options == &settings[0]) first = std::move(grid);
  }
  return first;
}

HostGrid Check::grid_of_known_answer(const CullView& view, const std::vector<CullLight>& lights,
                                     std::vector<DepthInterval> bounds, const CullerOptions& options) {
  if (bounds.size() == 1) {
    const DepthInterval one = bounds[0];
    bounds.assign(tile_count(view, options.tile), one);
  }
  return same_in_every_way(view, lights, bounds, options);
}

std::vector<DepthInterval> Check::bounds(const CullView& view, const DepthImage& depth,
                                         const CullerOptions& options, bool tight) {
  std::vector<DepthInterval> first;
  for (const CullerOptions& shaped : in_both_shapes(options)) {
    std::vector<DepthInterval> found = engine.depth_bounds(shaped, view, depth);
    if (!that(found.size() == tile_count(view, options.tile), "{}: bounds of {} tiles", to_string(shaped),
              found.size()))
      return {};
    for (size_t i = 0; i < found.size(); ++i) {
      const Scan scan = scan_tile(view, depth, options.tile, i);
      const DepthInterval b = found[i];
      if (scan.invalid || scan.far > farthest_surface) {  // the tile spans every distance
        that((is_orthographic(view) ? b.near <= -1e17f : b.near <= 0) && b.far >= 1e17f,
             "{}: tile {} has an invalid depth, or a surface past 10^15 m, but is bounded to [{}, {}]",
             to_string(shaped), i, b.near, b.far);
      } else if (scan.near > scan.far) {
        that(b.near > b.far, "{}: tile {} is empty, but is [{}, {}]", to_string(shaped), i, b.near, b.far);
      } else {
        const double far = scan.far;
        trials(1);
        if (!(b.near <= scan.near && b.far >= far)) {
          lost("{}: tile {} is [{:.9g}, {:.9g}], its surfaces are at [{:.9g}, {:.9g}]", to_string(shaped), i,
               b.near, b.far, scan.near, scan.far);
        }
        const double scale =
            is_orthographic(view) ? std::abs(scan.near) + far + std::abs(distance_at(view, 0)) : far;
        const double more = 32 * 0x1p-24 * scale;
        that(!tight || (b.near >= scan.near - more && b.far <= far + more),
             "{}: tile {} is [{:.9g}, {:.9g}], far wider than [{:.9g}, {:.9g}]", to_string(shaped), i, b.near,
             b.far, scan.near, scan.far);
      }
    }
    const auto same = [](const DepthInterval& a, const DepthInterval& b) {
      return a.near == b.near && a.far == b.far;
    };
    if (shaped.shape == KernelShape::lanes)
      first = found;
    else
      that(std::equal(first.begin(), first.end(), found.begin(), found.end(), same),
           "{}: lanes and group differ", to_string(options));
  }
  return first;
}

HostGrid Check::pixels(const CullView& view, const std::vector<CullLight>& lights, const DepthImage& depth,
                       const std::vector<CullerOptions>& settings) {
  const std::vector<OracleLight> exact = oracle_lights(view, lights);
  const View v = oracle_view(view);
  const int row = depth.row_pixels ? depth.row_pixels : view.width;
  struct Lit {
    uint32_t x, y, light;
    double distance;
    float depth;
  };
  std::vector<std::vector<Lit>> rows(view.height);
  parallel_for(view.height, [&](int y) {
    for (int x = 0; x < view.width; ++x) {
      for (int s = 0; s < depth.samples; ++s) {
        const size_t at = (size_t(y + depth.y) * row + x + depth.x) * depth.samples + s;
        const float value = depth.values[at];
        if (!(value >= 0 && value <= 1) || value == depth_of_nothing(view)) continue;
        const glm::dvec3 position = depth.distances.empty() ? position_from_depth(v, x, y, value)
                                                            : position_at(v, x, y, depth.distances[at]);
        for (uint32_t light = 0; light < exact.size(); ++light) {
          if (lights_it(exact[light], position))
            rows[y].push_back({uint32_t(x), uint32_t(y), light, -position.z, value});
        }
      }
    }
  });
  for (const auto& lit : rows) contacts(lit.size());
  const auto slices = slice_keys(view);
  HostGrid first;
  for (const CullerOptions& options : settings) {
    HostGrid lanes;
    for (const CullerOptions& shaped : in_both_shapes(options)) {
      HostGrid grid = engine.cull_depth(shaped, view, lights, depth);
      const std::string wrong = malformed(grid, lights.size());
      if (!wrong.empty()) throw machine_error("{}: {}", to_string(shaped), wrong);
      if (shaped.shape == KernelShape::lanes)
        lanes = std::move(grid);
      else
        that(lanes == grid, "{}: lanes and group differ", to_string(options));
    }
    that(lanes.z_bins.empty() || lanes.z_bins.size() == lights.size(), "{} words of z-bins",
         lanes.z_bins.size());
    const auto keys = z_bin_keys(view);
    const auto passed_over = [&](const Lit& pair) {
      return !lanes.z_bins.empty() &&
             !bins_hold(lanes.z_bins[pair.light], z_bin_of_key(depth_key(view, pair.depth), keys.data()));
    };
    for (const auto& lit : rows) {
      for (const Lit& pair : lit) {
        if (passed_over(pair))
          lost("z-bins: pixel {} {} at {:.9g} m skips light {}", pair.x, pair.y, pair.distance, pair.light);
        size_t cell = cell_of_pixel(pair.x, pair.y, uint(options.tile), uint(lanes.cells_x));
        const size_t slice = slice_of_key(depth_key(view, pair.depth), slices.data());
        cell += slice * lanes.cells_x * lanes.cells_y;
        const auto list = list_of(lanes, cell);
        if (std::binary_search(list.begin(), list.end(), pair.light)) continue;
        lost("{}: pixel {} {} at {:.9g} m lost light {}", to_string(options), pair.x, pair.y, pair.distance,
             pair.light);
      }
      trials(lit.size());
    }
    if (&options == &settings[0]) first = std::move(lanes);
  }
  return first;
}

void Check::same_as_twin(const CullView& view, const std::vector<CullLight>& lights, const DepthImage& depth,
                         const CullerOptions& options, bool blend) {
  for (const CullerOptions& shaped : in_both_shapes(options)) {
    const auto run = engine.kernel_run(shaped, view, lights, depth, blend);
    if (!run) return;
    const CullInputs& in = run->inputs;
    const auto bounds = twin_bounds(in.params, options.depth_bounds, blend, depth.samples, depth.values);
    HostGrid grid = run->grid;
    grid.masks.clear();  // the twin computes lists only
    grid.z_bins.clear();
    const std::string bounds_off = difference(bounds, in.bounds),
                      grid_off = difference(twin_grid(in, options.cull_test), grid);
    that(bounds_off.empty(), "{}: bounds are not the float twin's: {}", to_string(shaped), bounds_off);
    that(grid_off.empty(), "{}: lists are not the float twin's: {}", to_string(shaped), grid_off);
    trials(run->grid.cells.size() * lights.size());
  }
}

}  // namespace lightgrid::verify
