// Hard cases of agreement: reader and writer of a grid agree on its meaning.
#include <algorithm>
#include <cmath>

#include "shared/cull_tests.h"
#include "shared/light_grid.h"
#include "shared/slices.h"
#include "verify/check.h"

namespace lightgrid::lab::verify {
namespace {

void pixel_finds_its_tile(Check& c) {
  for (const CullerOptions& options : every_tile()) c.pixels_find_tiny_lights(sixty(), options);
}

void expect_subset(Check& c, const HostGrid& inner, const HostGrid& outer, const char* what) {
  if (!c.that(inner.cells.size() == outer.cells.size(), "{}: {} and {} cells", what, inner.cells.size(),
              outer.cells.size()))
    return;
  for (size_t i = 0; i < inner.cells.size(); ++i) {
    const auto a = list_of(inner, i), b = list_of(outer, i);
    c.that(std::includes(b.begin(), b.end(), a.begin(), a.end()), "{}: cell {} lists more", what, i);
  }
}

// A test that combines two others lists exactly the lights that both list.
void tests_are_nested(Check& c) {
  for (const NamedView& named : hard_views(127, 73)) {
    const OverTiles over = scattered_over_tiles(named.view, 300, true, 51);
    const auto grid_by = [&](CullTest test) {
      return c.grid(named.view, over.lights, over.bounds, {{.cull_test = test}});
    };
    const HostGrid both = grid_by(CullTest::planes_aabb);
    for (const CullTest test : {CullTest::planes, CullTest::aabb})
      expect_subset(c, both, grid_by(test), "planes+aabb within one of the two");
    expect_subset(c, grid_by(CullTest::exact), both, "exact within planes+aabb");
  }
}

// Spheres only: a cone is tested against the sphere around a cell's box, and a part's sphere may stick out of
// the whole cell's.
void bounds_are_nested(Check& c) {
  for (const NamedView& named : hard_views(63, 41)) {
    const OverDepth over = scattered_over_depth(named.view, 300, false, 52);
    const auto grid_by = [&](DepthBoundsMode mode) {
      return c.pixels(named.view, over.lights, over.depth, {{.depth_bounds = mode}});
    };
    const HostGrid minmax = grid_by(DepthBoundsMode::minmax);
    expect_subset(c, minmax, grid_by(DepthBoundsMode::none), "min/max within none");
    for (const DepthBoundsMode mode :
         {DepthBoundsMode::halfz, DepthBoundsMode::halfz_modified, DepthBoundsMode::mask32})
      expect_subset(c, grid_by(mode), minmax, "tighter bounds within min/max");
  }
}

void narrower_intervals_list_less(Check& c) {
  Random random(53);
  const auto lights = scattered_lights(sixty(), 300, false, random);
  HostGrid outer = c.grid(sixty(), lights, {every_distance});
  for (const DepthInterval b :
       {DepthInterval{1, 50}, DepthInterval{3, 20}, DepthInterval{5, 6}, DepthInterval{5.5, 5.5}}) {
    const HostGrid inner = c.grid(sixty(), lights, {b});
    expect_subset(c, inner, outer, "a narrower interval within a wider one");
    outer = inner;
  }
}

void larger_lights_list_more(Check& c) {
  auto [bounds, lights] = scattered_over_tiles(sixty(), 300, true, 54);
  HostGrid inner = c.grid(sixty(), lights, bounds);
  for (int i = 0; i < 4; ++i) {
    for (CullLight& light : lights) light.radius_m *= i % 2 ? 2 : 1 + 1e-6;
    const HostGrid outer = c.grid(sixty(), lights, bounds);
    expect_subset(c, inner, outer, "the lists of smaller lights within those of larger ones");
    inner = outer;
  }
}

void whole_pixels_hold_centres(Check& c) {
  for (const NamedView& named : hard_views(127, 73)) {
    const auto [bounds, lights] = tangent_over_tiles(named.view, 300, Contact::any, 55);
    const HostGrid outer = c.grid(named.view, lights, bounds, {{.pixel_centres = false}});
    expect_subset(c, c.grid(named.view, lights, bounds, {{.pixel_centres = true}}), outer,
                  "centres within whole pixels");
  }
}

void portable_form(Check& c) {
  for (const NamedView& named : hard_views(127, 73)) {
    const auto [bounds, lights] = scattered_over_tiles(named.view, 300, true, 56);
    for (CullerOptions options : every_test()) {
      const HostGrid tuned = c.grid(named.view, lights, bounds, {options});
      options.portable = true;
      c.that(tuned == c.grid(named.view, lights, bounds, {options}), "{}: {}: the portable form differs",
             named.name, to_string(options));
    }
  }
}

CullView sliced(CullView view, int slices) {
  for (int i = 1; i < slices; ++i) view.slice_edges.push_back(float(0.3 * std::exp2(i * 8.0 / slices)));
  return view;
}

// 32 slices in a box, and in front of an eye with reversed and standard depth.
std::vector<CullView> sliced_views() {
  CullView box =
      view_through({.half_x = 4, .half_y = 3, .near = 0, .far = 128, .orthographic = true}, 48, 32);
  for (int i = 1; i < 32; ++i) box.slice_edges.push_back(float(4 * i));
  const CullView standard = view_through({.near = 0.1, .far = 1000, .order = DepthOrder::standard}, 48, 32);
  return {box, sliced(field_of_view(60, 48, 32), 32), sliced(standard, 32)};
}

// Surfaces on the edges and a few steps of depth to either side, each with a light of almost no size at its
// position and two that just reach it along the view axis, across slice boundaries.
struct OnEdges {
  DepthImage depth;
  std::vector<CullLight> lights;
};
void add_lights(const CullView& view, OnEdges& on) {
  for (const CullLight& at : lights_at_surfaces(view, on.depth, 1e-6)) {
    on.lights.push_back(at);
    const double r = 0.01 * std::max(0.01, -at.position.z);
    for (const double side : {-1.0, 1.0})
      on.lights.push_back(point(at.position + glm::dvec3(0, 0, side * r), r * (1 + 0x1p-30)));
  }
}

OnEdges on_edges(const CullView& view, const std::vector<float>& edges) {
  OnEdges on;
  for (int i = 0; i < view.width * view.height; ++i) {
    float value = float(depth_at(view, edges[size_t(i) % edges.size()]));
    if (i % 3) value = std::nextafter(value, i % 3 == 1 ? 0.0f : 1.0f);
    on.depth.values.push_back(value);
  }
  add_lights(view, on);
  return on;
}

// The same rounded to a format: the surfaces' true distances differ from the buffer's by up to half a step.
OnEdges on_edges_of_format(const CullView& view, const std::vector<float>& edges, double steps) {
  Random random(60);
  OnEdges on;
  for (int i = 0; i < view.width * view.height; ++i) {
    const double exact = depth_at(view, edges[size_t(i) % edges.size()]) + random.uniform(-1, 1) / steps;
    const double depth = std::clamp(exact, 1 / steps, 1 - 1 / steps);
    on.depth.distances.push_back(distance_at(view, depth));
    on.depth.values.push_back(float(std::round(depth * steps) / steps));
  }
  add_lights(view, on);
  return on;
}

// On the edges as stored in float depth, and in D24 and D16.
void on_edges_of_every_format(Check& c, const CullView& view, const std::vector<float>& edges,
                              const std::vector<CullerOptions>& settings) {
  const OnEdges in_floats = on_edges(view, edges);
  c.pixels(view, in_floats.lights, in_floats.depth, settings);
  for (const auto& [format, steps] : {std::pair(DepthFormat::d24, 16777215.0), {DepthFormat::d16, 65535.0}}) {
    const OnEdges on = on_edges_of_format(view, edges, steps);
    c.pixels(view, on.lights, on.depth, {{.depth_format = format}});
  }
}

void on_slice_edges(Check& c) {
  for (const CullView& view : sliced_views())
    on_edges_of_every_format(c, view, view.slice_edges, every_test());
}

CullView with_z_bins(CullView view) {
  view.z_bin_edges = std::move(view.slice_edges);
  view.slice_edges.clear();
  return view;
}

void on_z_bin_edges(Check& c) {
  for (const CullView& sliced_view : sliced_views()) {
    const CullView view = with_z_bins(sliced_view);
    on_edges_of_every_format(c, view, view.z_bin_edges, {CullerOptions{}});
  }
}

// No bin may hold a light that reaches none of its distances, up to a step of `more` for rounding.
void expect_tight_bins(Check& c, const CullView& view, const std::vector<CullLight>& lights,
                       const HostGrid& grid) {
  const std::vector<OracleLight> exact = oracle_lights(view, lights);
  const std::vector<float>& edges = view.z_bin_edges;
  if (!c.that(grid.z_bins.size() == lights.size(), "{} words of z-bins", grid.z_bins.size())) return;
  for (size_t i = 0; i < lights.size(); ++i) {
    const glm::dvec3& p = exact[i].position;
    const double r = exact[i].radius, d = -p.z,
                 ends = is_orthographic(view) ? std::abs(distance_at(view, 0)) : 0;
    for (size_t bin = 0; bin <= edges.size(); ++bin) {
      if (!bins_hold(grid.z_bins[i], uint(bin))) continue;
      const double near = bin > 0 ? edges[bin - 1] : -no_end, far = bin < edges.size() ? edges[bin] : no_end;
      // How far a depth's rounding moves the bin's ends.
      const auto step = [&](double edge) {
        const double depth = depth_at(view, edge);
        return std::isfinite(edge) ? std::abs(distance_at(view, depth + 0x1p-24 * std::abs(depth)) - edge)
                                   : 0.0;
      };
      const double more = step(near) + step(far) +
                          64 * 0x1p-24 * (std::abs(p.x) + std::abs(p.y) + 2 * std::abs(d) + 2 * r + ends) +
                          2 * exact[i].position_error;
      c.that(!exact[i].lists_nothing && d + r >= near - more && d - r <= far + more,
             "bin {} from {} to {} includes a light from {} to {}", bin, near, far, d - r, d + r);
    }
  }
}

// Lights across the near plane, behind the eye, around it, past the last edge, in every bin, of infinite
// range and of no size.
void z_bins_of_lights(Check& c) {
  uint64_t seed = 590;
  for (NamedView named : hard_views(64, 48)) {
    CullView& view = named.view;
    view.z_bin_edges = {0.3f, 0.5f, 1, 1, 2, 3, 5, 7, 10, 20};
    auto [depth, lights] = scattered_over_depth(view, 300, true, seed++);
    std::vector<CullLight> axial;
    for (const double d : {-3.0, -0.5, 0.0, 0.05, 0.1, 0.3, 1.0, 6.0, 99.0, 100.0, 1000.0})
      for (const double r : {0.0, 1e-6, 0.5, 3.0, 50.0, 1e20, no_end, -1.0})
        axial.push_back(point({0, 0, -d}, r));
    move_to_world(view, axial);
    add(lights, axial);
    expect_tight_bins(c, view, lights, c.pixels(view, lights, depth, {CullerOptions{}}));
  }
}

// The slices of a tile together list what a single slice lists for it.
void slices_make_the_whole(Check& c) {
  Random random(57);
  const auto lights = scattered_lights(sixty(), 300, false, random);
  const HostGrid whole = c.grid(sixty(), lights, {every_distance});
  for (const int slices : {2, 3, 16, 64}) {
    const CullView view = sliced(sixty(), slices);
    const HostGrid grid = c.grid(view, lights, {every_distance});
    const size_t tiles = whole.cells.size();
    if (!c.that(grid.cells.size() == tiles * slices, "{} cells", grid.cells.size())) return;
    for (size_t i = 0; i < tiles; ++i) {
      for (int slice = 0; slice < slices; ++slice) {
        const auto part = list_of(grid, i + slice * tiles), all = list_of(whole, i);
        c.that(std::includes(all.begin(), all.end(), part.begin(), part.end()),
               "slice {} of tile {} lists more", slice, i);
      }
    }
  }
}

void slices_and_bounds(Check& c) {
  const CullView view = sliced(sixty(), 24);
  c.grid(view, scattered_over_tiles(view, 200, true, 58));
  const OverDepth surfaces = scattered_over_depth(view, 200, true, 59);
  c.pixels(view, surfaces.lights, surfaces.depth, every_test());
}

}  // namespace

std::vector<CaseRun> agreement_cases() {
  return CASES(pixel_finds_its_tile, on_slice_edges, on_z_bin_edges, z_bins_of_lights, slices_make_the_whole,
               slices_and_bounds, tests_are_nested, bounds_are_nested, narrower_intervals_list_less,
               larger_lights_list_more, whole_pixels_hold_centres, portable_form);
}

}  // namespace lightgrid::lab::verify
