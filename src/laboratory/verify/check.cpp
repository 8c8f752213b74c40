#include "verify/check.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/error.h"
#include "base/parallel.h"
#include "oracle/lit_set.h"
#include "oracle/position.h"
#include "shared/cull_tests.h"
#include "shared/light_grid.h"
#include "shared/slices.h"

namespace lightgrid::lab::verify {
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
  Scan scan;
  for (int y = ty * tile; y < std::min((ty + 1) * tile, view.height); ++y) {
    for (int x = tx * tile; x < std::min((tx + 1) * tile, view.width); ++x) {
      for (int s = 0; s < depth.samples; ++s) {
        const float value = depth.values[depth.index(view, x, y, s)];
        if (!(value >= 0 && value <= 1) || (value == 0 && std::signbit(value)))
          scan.invalid = true;
        else if (value != depth_of_nothing(view)) {
          const double distance = distance_at(view, value);
          scan.near = std::min(scan.near, distance);
          scan.far = std::max(scan.far, distance);
        }
      }
    }
  }
  return scan;
}

void spread_over_tiles(std::vector<DepthInterval>& bounds, const CullView& view, int tile) {
  if (bounds.size() == 1) bounds.assign(tile_count(view, tile), DepthInterval(bounds[0]));
}

}  // namespace

Settings settings_with(const std::string& assignments) {
  Settings settings;
  std::istringstream words(assignments);
  for (std::string word; words >> word;) apply_setting(settings, word);
  return settings;
}

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

const char* name_of(LostFrom from) {
  return from == LostFrom::list ? "list" : from == LostFrom::mask ? "mask" : "z-bins";
}

ListFinder::ListFinder(const CullView& view, int tile, const HostGrid& grid)
    : view_(view),
      tile_(tile),
      grid_(grid),
      slices_(slice_keys(view)),
      z_bins_(z_bin_keys(view)),
      mask_words_(grid.cells.empty() ? 0 : grid.masks.size() / grid.cells.size()) {}

std::optional<LostFrom> ListFinder::lost_from(uint x, uint y, float depth, uint32_t light) const {
  const float key = depth_key(view_, depth);
  const size_t slice = slice_of_key(key, slices_.data());
  const size_t cell =
      slice * grid_.cells_x * grid_.cells_y + cell_of_pixel(x, y, uint(tile_), uint(grid_.cells_x));
  if (cell >= grid_.cells.size()) return LostFrom::list;
  const auto list = list_of(grid_, cell);
  if (!std::binary_search(list.begin(), list.end(), light)) return LostFrom::list;
  if (mask_words_ && !(grid_.masks[cell * mask_words_ + light / 32] >> light % 32 & 1)) return LostFrom::mask;
  const bool held = grid_.z_bins.empty() || bins_hold(grid_.z_bins[light], z_bin_of_key(key, z_bins_.data()));
  return held ? std::nullopt : std::optional(LostFrom::z_bins);
}

std::string malformed(const HostGrid& grid, size_t lights) {
  if (grid.cells.size() != size_t(grid.cells_x) * grid.cells_y * grid.slices)
    return "not one first and count a cell";
  return malformed_lists(grid.cells, grid.indices, lights);
}

void Check::fail(const std::string& why) {
  if (outcome_.verdict != Verdict::fail) outcome_.why = why;
  outcome_.verdict = Verdict::fail;
  if (ends_at_failure_) throw Ended();
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

std::vector<CullerOptions> every_test(int tile) {
  std::vector<CullerOptions> settings = {{.tile = tile}};
  for (const CullTestRow& row : cull_tests)
    if (row.test != settings[0].cull_test) settings.push_back({.cull_test = row.test, .tile = tile});
  return settings;
}

std::vector<CullerOptions> every_mode(int tile) {
  std::vector<CullerOptions> settings = {{.tile = tile}};
  for (const DepthBoundsRow& row : depth_bounds_modes)
    if (row.mode != settings[0].depth_bounds) settings.push_back({.depth_bounds = row.mode, .tile = tile});
  return settings;
}

std::vector<CullerOptions> every_tile() { return {{.tile = 16}, {.tile = 8}, {.tile = 32}, {.tile = 64}}; }

std::vector<CullerOptions> Check::in_both_shapes(const CullerOptions& options) const {
  CullerOptions lanes = options, group = options;
  lanes.shape = KernelShape::lanes;
  group.shape = KernelShape::group;
  if (!engine.has_both_shapes()) return {lanes};
  return {lanes, group};
}

// make(options) in each shape: the first, which the second must equal.
template <typename Make>
auto Check::same_in_every_shape(const CullerOptions& options, const Make& make) {
  std::optional<decltype(make(options))> first;
  for (const CullerOptions& shaped : in_both_shapes(options)) {
    auto made = make(shaped);
    if (first)
      that(*first == made, "{}: lanes and group differ", to_string(options));
    else
      first = std::move(made);
  }
  return std::move(*first);
}

template <typename Cull>
HostGrid Check::well_formed_grid(const CullerOptions& options, size_t lights, const Cull& cull) {
  return same_in_every_shape(options, [&](const CullerOptions& shaped) {
    HostGrid grid = cull(shaped);
    const std::string wrong = malformed(grid, lights);
    if (!wrong.empty()) throw machine_error("{}: {}", to_string(shaped), wrong);  // ends the case
    return grid;
  });
}

void Check::each_cell_lists(const HostGrid& grid, uint32_t lights, const char* what) {
  for (size_t i = 0; i < grid.cells.size(); ++i)
    that(grid.cells[i].y == lights, "cell {} has {} of {} {}", i, grid.cells[i].y, lights, what);
}

void Check::pixels_find_lights(const HostGrid& grid, const CullView& view, int tile,
                               const std::string& what) {
  for (uint i = 0; i < uint(view.width * view.height); ++i) {
    const uint x = i % uint(view.width), y = i / uint(view.width);
    const auto list = list_of(grid, cell_of_pixel(x, y, uint(tile), uint(grid.cells_x)));
    trials(1);
    if (!std::binary_search(list.begin(), list.end(), i)) lost("{}: pixel {} {} loses its light", what, x, y);
  }
}

size_t Check::pixels_find_tiny_lights(const CullView& view, const CullerOptions& options) {
  const View v = oracle_view(view);
  std::vector<CullLight> lights;
  for (int y = 0; y < view.height; ++y)
    for (int x = 0; x < view.width; ++x) lights.push_back(point(position_at(v, x, y, 5), 1e-6));
  move_to_world(view, lights);
  pixels_find_lights(grid_of_known_answer(view, lights, {{5, 5}}, options), view, options.tile,
                     to_string(options));
  return lights.size();
}

void Check::hold_between(const CullView& view, std::span<const OracleLight> lights,
                         std::span<const DepthInterval> bounds, const Touching& touching,
                         const CullerOptions& options, const HostGrid& grid, bool counts) {
  if (!that(grid.cells.size() == touching.size(), "{}: {} cells for {}", to_string(options),
            grid.cells.size(), touching.size()))
    return;
  const View seen = oracle_view(view);
  const auto words = [&](size_t i, const Cell& cell, uint32_t light, const char* what) {
    const OracleLight& l = lights[light];
    return fmt::format("{}: cell {} [{:.9g}, {:.9g}] {} light {} at {:.9g} {:.9g} {:.9g} radius {:.9g}",
                       to_string(options), i, cell.near, cell.far, what, light, l.position.x, l.position.y,
                       l.position.z, l.radius);
  };
  for (size_t i = 0; i < touching.size(); ++i) {
    const auto list = list_of(grid, i);
    const Cell cell = cell_of(view, options.tile, i, bounds[i % bounds.size()], options.pixel_centres);
    for (const uint32_t light : touching[i]) {
      if (!std::binary_search(list.begin(), list.end(), light)) lost("{}", words(i, cell, light, "lost"));
    }
    for (const uint32_t light : list) {
      if (!possibly_touches(seen, options.tile, cell, lights[light], options.cull_test))
        fail(words(i, cell, light, "lists, which cannot touch it,"));
    }
    trials(touching[i].size() + list.size());
    if (counts) {
      listed_ += list.size();
      touching_ += touching[i].size();
    }
  }
}

HostGrid Check::grid(const CullView& view, const std::vector<CullLight>& lights,
                     std::vector<DepthInterval> bounds, const std::vector<CullerOptions>& settings) {
  const std::vector<OracleLight> exact = oracle_lights(view, lights);
  HostGrid first;
  Touching touching;
  int tile = 0;
  const std::vector<DepthInterval> given = std::move(bounds);
  for (const CullerOptions& options : settings) {
    bounds = given;
    spread_over_tiles(bounds, view, options.tile);
    if (options.tile != tile) {
      touching = touching_lights(view, exact, bounds, options.tile, options.pixel_centres);
      for (const auto& cell : touching) contacts(cell.size());
    }
    tile = options.tile;
    HostGrid grid = well_formed_grid(options, lights.size(), [&](const CullerOptions& shaped) {
      return engine.cull(shaped, view, lights, bounds);
    });
    hold_between(view, exact, bounds, touching, options, grid, &options == &settings[0]);
    if (&options == &settings[0]) first = std::move(grid);
  }
  return first;
}

HostGrid Check::grid_of_known_answer(const CullView& view, const std::vector<CullLight>& lights,
                                     std::vector<DepthInterval> bounds, const CullerOptions& options) {
  spread_over_tiles(bounds, view, options.tile);
  return well_formed_grid(options, lights.size(), [&](const CullerOptions& shaped) {
    return engine.cull(shaped, view, lights, bounds);
  });
}

std::vector<DepthInterval> Check::bounds(const CullView& view, const DepthImage& depth,
                                         const CullerOptions& options, bool tight) {
  return same_in_every_shape(options, [&](const CullerOptions& shaped) {
    const std::vector<DepthInterval> found = engine.depth_bounds(shaped, view, depth);
    if (!that(found.size() == tile_count(view, options.tile), "{}: bounds of {} tiles", to_string(shaped),
              found.size()))
      return found;
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
    return found;
  });
}

HostGrid Check::pixels(const CullView& view, const std::vector<CullLight>& lights, const DepthImage& depth,
                       const std::vector<CullerOptions>& settings) {
  const std::vector<OracleLight> exact = oracle_lights(view, lights);
  struct Lit {
    uint32_t x, y, light;
    double distance;
    float depth;
  };
  std::vector<std::vector<Lit>> rows(view.height);
  parallel_for(view.height, [&](int y) {
    for (int x = 0; x < view.width; ++x) {
      for (int s = 0; s < depth.samples; ++s) {
        const auto surface = surface_at(view, depth, x, y, s);
        if (!surface) continue;
        const float value = depth.values[depth.index(view, x, y, s)];
        for (uint32_t light = 0; light < exact.size(); ++light) {
          if (lights_it(exact[light], *surface))
            rows[y].push_back({uint32_t(x), uint32_t(y), light, -surface->z, value});
        }
      }
    }
  });
  for (const auto& lit : rows) contacts(lit.size());
  HostGrid first;
  for (const CullerOptions& options : settings) {
    HostGrid grid = well_formed_grid(options, lights.size(), [&](const CullerOptions& shaped) {
      return engine.cull_depth(shaped, view, lights, depth);
    });
    that(grid.z_bins.empty() || grid.z_bins.size() == lights.size(), "{} words of z-bins",
         grid.z_bins.size());
    const ListFinder finder(view, options.tile, grid);
    for (const auto& lit : rows) {
      for (const Lit& pair : lit) {
        if (const auto from = finder.lost_from(pair.x, pair.y, pair.depth, pair.light))
          lost("{}: pixel {} {} at {:.9g} m lost light {} from its {}", to_string(options), pair.x, pair.y,
               pair.distance, pair.light, name_of(*from));
      }
      trials(lit.size());
    }
    if (&options == &settings[0]) first = std::move(grid);
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

}  // namespace lightgrid::lab::verify
