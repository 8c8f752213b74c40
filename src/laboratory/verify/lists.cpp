// Hard cases of lists: numbers of lights, lists and entries.
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "shared/cull_tests.h"
#include "verify/check.h"

namespace lightgrid::lab::verify {
namespace {

CullView small() { return field_of_view(60, 33, 17); }

// Lights that every tile lists and lights that none lists, mixed so that each lane of a vector gets both.
void counts(Check& c, std::initializer_list<size_t> numbers) {
  for (const size_t n : numbers) {
    const HostGrid all =
        c.grid_of_known_answer(small(), std::vector<CullLight>(n, point({0, 0, -5}, 1e3)), {{4, 6}}, {});
    c.that(all.cells.size() == 6, "{} cells", all.cells.size());
    c.each_cell_lists(all, uint32_t(n));
    std::vector<CullLight> mixed;
    std::vector<uint32_t> expected;
    for (uint32_t i = 0; i < n; ++i) {
      const bool in = Random::mix(i) % 3 == 0 || i + 1 == n;
      mixed.push_back(point({0, 0, in ? -5.0 : 500.0}, 100));
      if (in) expected.push_back(i);
    }
    const HostGrid some = c.grid_of_known_answer(small(), mixed, {{4, 6}}, {});
    for (size_t i = 0; i < some.cells.size(); ++i)
      c.that(std::ranges::equal(list_of(some, i), expected),
             "tile {} does not list the {} of {} lights that reach it", i, expected.size(), n);
  }
}
void light_zero_alone(Check& c) { counts(c, {1}); }
void around_a_byte(Check& c) { counts(c, {254, 255, 256, 257}); }
void around_16_bits(Check& c) { counts(c, {65534, 65535, 65536, 65537}); }
void around_lanes(Check& c) { counts(c, {2, 3, 7, 8, 9, 15, 16, 17, 31, 32, 33, 47, 48, 49}); }
void around_groups(Check& c) { counts(c, {63, 64, 65, 127, 128, 129}); }
void around_batches(Check& c) {
  counts(c, {511, 512, 513, 1023, 1024, 1025, 2047, 2048, 2049, 4095, 4096, 4097});
}

void no_lights(Check& c) {
  const HostGrid grid = c.grid(sixty(), {}, {every_distance});
  c.that(grid.indices.empty() && grid.cells.size() == 40, "no lights make {} entries", grid.indices.size());
}

// Every length of one list from 0 to 70.
void each_length(Check& c) {
  for (size_t n = 0; n <= 70; ++n) {
    const HostGrid grid =
        c.grid_of_known_answer(small(), std::vector<CullLight>(n, point({0, 0, -5}, 1e3)), {{4, 6}}, {});
    c.that(grid.indices.size() == 6 * n, "{} lights make {} entries in 6 lists", n, grid.indices.size());
  }
}

void none_in_view(Check& c) {
  std::vector<CullLight> lights;
  for (int i = 0; i < 3000; ++i) lights.push_back(point({i % 10, i % 7, 5 + i % 100}, 1));
  c.that(c.grid(sixty(), lights, {{1, 100}}).indices.empty(), "lights behind the eye are listed");
}

void only_the_last(Check& c) {
  std::vector<CullLight> lights(5000, point({0, 0, 500}, 1));
  lights.back() = point({0, 0, -5}, 100);
  const HostGrid grid = c.grid_of_known_answer(sixty(), lights, {{4, 6}}, {});
  for (size_t i = 0; i < grid.cells.size(); ++i)
    c.that(grid.cells[i].y == 1 && grid.indices[grid.cells[i].x] == 4999, "tile {} lists {}", i,
           grid.cells[i].y);
}

void all_in_one_tile(Check& c) {
  const Cell cell = cell_of(sixty(), 16, 13, {4, 4}, true);
  const glm::dvec3 middle((cell.x0 + cell.x1) * 2, (cell.y0 + cell.y1) * 2, -4);
  const HostGrid grid =
      c.grid(sixty(), std::vector<CullLight>(3000, point(middle, 0.01)), {{4, 4}}, {CullerOptions{}});
  for (size_t i = 0; i < grid.cells.size(); ++i)
    c.that(grid.cells[i].y == (i == 13 ? 3000u : 0u), "tile {} lists {}", i, grid.cells[i].y);
}

void first_and_last_tile(Check& c) {
  const CullView view = field_of_view(60, 1300, 700);
  for (const CullerOptions& options : every_tile()) {
    const size_t tiles = tile_count(view, options.tile);
    std::vector<CullLight> lights;
    for (const size_t tile : {size_t(0), tiles - 1}) {
      const Cell cell = cell_of(view, options.tile, tile, {4, 4}, true);
      lights.push_back(point({(cell.x0 + cell.x1) * 2, (cell.y0 + cell.y1) * 2, -4}, 1e-4));
    }
    const HostGrid grid = c.grid(view, lights, {{4, 4}}, {options});
    for (size_t i = 0; i < grid.cells.size(); ++i)
      c.that(grid.cells[i].y == (i == 0 || i + 1 == tiles ? 1u : 0u), "tile {} of {} lists {}", i, tiles,
             grid.cells[i].y);
  }
}

// Images that end one tile before, at and after the edge of a bin of tiles.
void around_bins(Check& c) {
  for (const int tiles : {7, 8, 9, 31, 32, 33, 63, 64, 65}) {
    const CullView view = field_of_view(60, tiles * 8, 17);
    Random random(41);
    c.grid(view, scattered_lights(view, 60, true, random), scattered_bounds(view, 8, random), {{.tile = 8}});
  }
}

void longer_than_expected(Check& c) {
  const CullView view = field_of_view(60, 321, 181);
  const size_t tiles = tile_count(view, 8);
  const HostGrid grid = c.grid_of_known_answer(view, std::vector<CullLight>(2000, point({0, 0, -5}, no_end)),
                                               {{1, 9}}, {.tile = 8});
  c.that(grid.indices.size() == tiles * 2000, "{} entries of {}", grid.indices.size(), tiles * 2000);
  c.each_cell_lists(grid, 2000);
}

void other_sizes_between(Check& c) {
  Random random(42);
  const CullView large = field_of_view(60, 301, 211), tiny = field_of_view(60, 5, 3);
  const auto few = scattered_lights(sixty(), 20, true, random),
             many = scattered_lights(sixty(), 900, true, random);
  const HostGrid first = c.grid(sixty(), few, {{1, 30}}, {CullerOptions{}});
  c.grid(large, many, {{1, 30}}, {CullerOptions{}});
  c.grid(tiny, {}, {{1, 30}}, {CullerOptions{}});
  c.grid(tiny, many, {{1, 30}}, {CullerOptions{}});
  c.that(first == c.grid(sixty(), few, {{1, 30}}, {CullerOptions{}}),
         "another frame in between changes the grid");
}

// Enough tiles for many work-groups, which finish in a different order each time; another frame runs between
// two runs.
void hundred_runs(Check& c) {
  const CullView view = field_of_view(60, 640, 360);
  Random random(43);
  const auto bounds = scattered_bounds(view, 16, random);
  const auto lights = scattered_lights(view, 500, true, random);
  const HostGrid first = c.grid(view, lights, bounds, {CullerOptions{}});
  for (const KernelShape shape : {KernelShape::lanes, KernelShape::group}) {
    const CullerOptions options{.shape = shape};
    for (int run = 0; run < 100; ++run) {
      if (run % 10 == 9)
        c.engine.cull(options, sixty(), {lights.data(), size_t(5 * run)},
                      {bounds.data(), tile_count(sixty(), 16)});
      c.that(first == c.engine.cull(options, view, lights, bounds), "run {} gives another grid", run);
    }
  }
}

void turned_round(Check& c) {  // the lights in another order: the same lights in each list
  Random random(44);
  const auto bounds = scattered_bounds(sixty(), 16, random);
  auto lights = scattered_lights(sixty(), 333, true, random);
  const HostGrid forward = c.grid(sixty(), lights, bounds);
  std::reverse(lights.begin(), lights.end());
  const HostGrid backward = c.grid(sixty(), lights, bounds);
  for (size_t i = 0; i < forward.cells.size(); ++i) {
    std::vector<uint32_t> turned(list_of(backward, i).begin(), list_of(backward, i).end());
    std::reverse(turned.begin(), turned.end());
    for (uint32_t& light : turned) light = uint32_t(lights.size()) - 1 - light;
    c.that(std::ranges::equal(turned, list_of(forward, i)),
           "tile {}'s list depends on the order of the lights", i);
  }
}

void in_32_bits(Check& c) {
  Random random(45);
  const auto bounds = scattered_bounds(sixty(), 16, random);
  const auto lights = scattered_lights(sixty(), 300, true, random);
  c.that(c.grid(sixty(), lights, bounds, {{.index_bits = 16}}) ==
             c.grid(sixty(), lights, bounds, {{.index_bits = 32}}),
         "16- and 32-bit lists differ");
}

// A full list, and after it one that begins past 65,536 entries.
void lists_past_16_bits(Check& c) {
  const HostGrid grid =
      c.grid_of_known_answer(sixty(), std::vector<CullLight>(4000, point({0, 0, -5}, 1e3)), {{4, 6}}, {});
  for (size_t i = 0; i < grid.cells.size(); ++i)
    c.that(grid.cells[i].y == 4000 && grid.cells[i].x % 4000 == 0, "list {} is {} from {}", i,
           grid.cells[i].y, grid.cells[i].x);
}

// 64 slices and tiles of 8: 58,880 cells, each with its own list.
void many_cells(Check& c) {
  CullView view = field_of_view(60, 320, 180);
  for (int i = 1; i < 64; ++i) view.slice_edges.push_back(float(0.5 * std::exp2(i * 0.15)));
  Random random(46);
  c.grid(view, scattered_lights(view, 60, true, random), {every_distance}, {{.tile = 8}});
}

// 16 tiles x 64 slices x 2^22 lights that reach everywhere: 2^32 entries in a single block of tiles.
void past_32_bits(Check& c) {
  CullView view = field_of_view(60, 32, 32);
  for (int i = 1; i < 64; ++i) view.slice_edges.push_back(float(0.5 * std::exp2(i * 0.15)));
  const std::vector<CullLight> lights(size_t(1) << 22, point({0, 0, -5}, no_end));
  const std::vector<DepthInterval> bounds(tile_count(view, 8), every_distance);
  try {  // the device's own shape only: the other one would take minutes
    const HostGrid grid = c.engine.cull({.tile = 8}, view, lights, bounds);
    c.that(grid.indices.size() == grid.cells.size() * lights.size(), "{} of 2^32 entries",
           grid.indices.size());
  } catch (const Error& error) {
    c.that(error.kind() == ErrorKind::machine, "{}", error.what());
  }
}

// Lights tangent to the cells, where the rounding of a coarse step could drop a light that the fine one
// keeps. Every test with slices, every depth-bounds mode without, each in half of the views; tile sizes
// alternate.
void float_twin(Check& c) {
  Random random(47);
  int turn = 0;
  for (NamedView named : hard_views(127, 73)) {
    const bool slices = turn++ % 2;
    if (slices) named.view.slice_edges = {0.5f, 1, 2, 5, 10, 30};
    const DepthImage depth = scattered_depth(named.view, random);
    for (int i = 0; i < 5; ++i) {
      CullerOptions options{.tile = 8 << (i + turn) % 4};
      if (slices)
        options.cull_test = CullTest(i);
      else
        options.depth_bounds = DepthBoundsMode(i);
      if (i == 4) options.cull_test = CullTest::exact;
      const auto bounds = c.engine.depth_bounds(options, named.view, depth);
      auto lights = scattered_lights(named.view, 100, true, random);
      add(lights, tangent_lights(named.view, bounds, options.tile, 150, Contact::any, 1, random));
      add(lights, tangent_spots(named.view, bounds, options.tile, 100, random));
      move_to_world(named.view, lights);
      if (i == turn % 5) c.pixels(named.view, lights, depth, {options});
      c.same_as_twin(named.view, lights, depth, options);
    }
  }
}

}  // namespace

std::vector<CaseRun> list_cases() {
  return CASES(no_lights, light_zero_alone, around_a_byte, around_16_bits, around_lanes, around_groups,
               around_batches, each_length, none_in_view, only_the_last, all_in_one_tile, first_and_last_tile,
               around_bins, longer_than_expected, other_sizes_between, hundred_runs, turned_round, in_32_bits,
               lists_past_16_bits, many_cells, past_32_bits, float_twin);
}

}  // namespace lightgrid::lab::verify
