// Hard cases of the camera: projections, and positions of lights relative to it.
#include <algorithm>
#include <cmath>

#include "reference/position.h"
#include "shared/light_grid.h"
#include "verify/check.h"
#include "verify/tangent_lights.h"

namespace lightgrid::verify {
namespace {

// Tangent and scattered lights and spots over thin, thick, flat, endless and empty cells.
void lights_of_all_kinds(Check& c, const CullView& view, int tile = 16) {
  Random random(21);
  const auto bounds = scattered_bounds(view, tile, random);
  bool any = false;
  for (const DepthInterval& b : bounds) any |= b.near <= b.far;
  auto lights = scattered_lights(view, 150, true, random);
  if (any) {
    for (const auto& more : {tangent_lights(view, bounds, tile, 250, Contact::any, 0, random),
                             tangent_spots(view, bounds, tile, 50, random)})
      lights.insert(lights.end(), more.begin(), more.end());
  }
  move_to_world(view, lights);
  c.grid(view, lights, bounds, c.every_test(tile));
}

void scattered_pixels(Check& c, const CullView& view, uint64_t seed) {
  const auto [depth, lights] = scattered_over_depth(view, 100, true, seed);
  c.pixels(view, lights, depth, c.every_test());
}

void field(Check& c, double degrees) { lights_of_all_kinds(c, field_of_view(degrees, 127, 73)); }
void field_of_a_tenth(Check& c) { field(c, 0.1); }
void field_of_170(Check& c) { field(c, 170); }
void field_of_179(Check& c) { field(c, 179); }

void off_centre(Check& c) {
  for (const double shift : {0.2, -0.4})
    lights_of_all_kinds(
        c, view_through({.half_x = 0.8, .half_y = 0.5, .shift_x = shift, .shift_y = -shift / 2}, 127, 73));
}

void beside_the_axis(Check& c) {
  for (const double shift : {3.0, -20.0})
    lights_of_all_kinds(
        c, view_through({.half_x = 0.5, .half_y = 0.3, .shift_x = shift, .shift_y = shift}, 127, 73));
}

// A tiny light at each pixel's own position: the tile that shading finds for the pixel must list it.
void pixels_in_their_tiles(Check& c) {
  for (const NamedView& named : hard_views(127, 73)) {
    const View v = oracle_view(named.view);
    std::vector<CullLight> lights;
    for (int y = 0; y < 73; ++y)
      for (int x = 0; x < 127; ++x) lights.push_back(point(position_at(v, x, y, 5), 1e-6));
    move_to_world(named.view, lights);
    CullerOptions options;
    for (const CullTest test : {CullTest::planes, CullTest::exact}) {
      options.cull_test = test;
      const HostGrid grid = c.grid_of_known_answer(named.view, lights, {{5, 5}}, options);
      for (uint i = 0; i < lights.size(); ++i) {
        const auto list = list_of(grid, cell_of_pixel(i % 127, i / 127, 16, uint(grid.cells_x)));
        c.trials(1);
        if (!std::binary_search(list.begin(), list.end(), i))
          c.lost("{}: {}: pixel {} {} is not in its tile", named.name, to_string(options), i % 127, i / 127);
      }
      c.contacts(test == CullTest::planes ? lights.size() : 0);
    }
  }
}

Lens box(double half, double near, double far) {
  return {.half_x = half, .half_y = half, .near = near, .far = far, .orthographic = true};
}

void orthographic_near_zero(Check& c) {
  CullView view = view_through(box(5, 0, 100), 127, 73);
  lights_of_all_kinds(c, view);
  scattered_pixels(c, view, 22);
  // Slices and z-bins from that near plane, as in frames.
  for (const SliceSpacing spacing : {SliceSpacing::exponential, SliceSpacing::linear}) {
    view.slice_edges = slice_edges(spacing, 24, near_distance(view), 100);
    view.z_bin_edges = slice_edges(spacing, 64, near_distance(view), 100);
    for (const float edge : view.slice_edges)
      c.that(std::isfinite(edge) && edge > 0 && edge < 100, "a slice ends at {} m", edge);
    const auto [depth, lights] = scattered_over_depth(view, 100, true, 22);
    c.pixels(view, lights, depth, {CullerOptions{}});
  }
}

void orthographic_behind_the_eye(Check& c) {
  const CullView view = view_through(box(5, -50, 50), 127, 73);
  std::vector<CullLight> lights;
  for (int i = 0; i < 60; ++i) lights.push_back(point({i % 7 - 3, i % 5 - 2, 48 - 1.6 * i}, 1 + i % 3));
  c.grid(view, lights, {{-40, -20}}), c.grid(view, lights, {{-10, 10}});
  DepthImage depth;
  for (int i = 0; i < 127 * 73; ++i) depth.values.push_back(float(depth_at(view, i % 90 - 45)));
  c.bounds(view, depth, {});
  c.pixels(view, lights, depth, c.every_test());
}

void orthographic_off_centre(Check& c) {
  Lens lens = box(2, 0.1, 1000);
  lens.shift_x = 4000, lens.shift_y = -900;
  lights_of_all_kinds(c, view_through(lens, 127, 73));
}

void orthographic_tiny_and_huge(Check& c) {
  lights_of_all_kinds(c, view_through(box(1e-4, 0, 100), 127, 73));
  lights_of_all_kinds(c, view_through(box(1e5, 0, 1e5), 127, 73));
}

void sliver(Check& c) {
  lights_of_all_kinds(c, view_through({.half_x = 40, .half_y = 0.01}, 2048, 2));
  lights_of_all_kinds(c, view_through({.half_x = 0.001, .half_y = 3}, 3, 700));
}

void pixels_not_square(Check& c) {
  lights_of_all_kinds(c, view_through({.half_x = 5, .half_y = 0.05}, 73, 127));
}

void sixteen_thousand_wide(Check& c) {
  lights_of_all_kinds(c, view_through({.half_x = 1, .half_y = 0.01}, 16384, 17), 64);
}

void tiny_near(Check& c) {
  const CullView view = view_through({.near = 1e-6}, 63, 41);
  scattered_pixels(c, view, 23);
  c.grid(view, {point({0, 0, -1e-6}, 1e-6), point({1e-7, 0, -2e-6}, 1e-7)}, {{1e-6f, 3e-6f}});
}

void huge_near(Check& c) {
  const CullView view = view_through({.half_x = 1e-3, .half_y = 1e-3, .near = 1e6}, 63, 41);
  std::vector<CullLight> lights;
  for (int i = 0; i < 100; ++i)
    lights.push_back(point({(i % 10 - 5) * 200, (i / 10 - 5) * 200, -1.5e6}, 150));
  c.grid(view, lights, {{1.4e6f, 1.6e6f}}), c.grid(view, lights, {{1.5e6f, 1.5e6f}});
}

void inside_a_light(Check& c) {
  const HostGrid grid = c.grid(
      sixty(), {point({0, 0, 0}, 5), point({0.3, -0.2, 0.5}, 5), point({0, 0, -3}, 3.0001)}, {{0.1f, 4}});
  for (size_t i = 0; i < grid.cells.size(); ++i)
    c.that(grid.cells[i].y == 3, "tile {} lists {} of the 3 lights around the eye", i, grid.cells[i].y);
}

void across_the_near_plane(Check& c) {
  std::vector<CullLight> lights;
  for (const double r : {0.01, 0.1, 1.0, 30.0})
    for (int i = -5; i <= 5; ++i) lights.push_back(point({0.3 * i * r, 0.1 * i * r, -0.1 + 0.09 * i * r}, r));
  for (const DepthInterval b : {DepthInterval{0.1f, 0.1f}, DepthInterval{0.1f, 2}, DepthInterval{0, 1e18f}})
    c.grid(sixty(), lights, {b});
}

void behind(Check& c) {
  const HostGrid grid = c.grid(sixty(), {point({0, 0, 5}, 1), point({1, 1, 0.5}, 0.3)}, {{0.1f, 50}});
  c.that(grid.indices.empty(), "lights wholly behind the eye are in {} lists", grid.indices.size());
}

void behind_and_reaching_in(Check& c) {
  std::vector<CullLight> lights;
  for (int i = 0; i < 40; ++i)
    lights.push_back(point({(i % 8 - 4) * 2.0, (i / 8 - 2) * 2.0, 3}, 3.05 + i * 0.2));
  c.grid(sixty(), lights, {{0.1f, 50}}), c.grid(field_of_view(170, 127, 73), lights, {{0.1f, 50}});
}

void beyond_far(Check& c) {
  const CullView view = view_through({.near = 0.1, .far = 100}, 127, 73);
  const std::vector<CullLight> lights = {point({0, 0, -150}, 60), point({0, 0, -150}, 49),
                                         point({0, 0, -1e4}, 9950)};
  c.grid(view, lights, {{90, 100}}), c.grid(view, lights, {every_distance});
}

CullView sliced(CullView view) {
  view.slice_edges = {1, 2, 4, 8, 16};
  return view;
}

void beyond_the_last_slice(Check& c) {
  const HostGrid grid =
      c.grid(sliced(sixty()), {point({0, 0, -1000}, 5), point({0, 0, -20}, 3), point({0, 0, -1e7}, 1e3)},
             {every_distance});
  const size_t tiles = tile_count(sixty(), 16);
  uint64_t in_last = 0, before = 0;
  for (size_t i = 0; i < grid.cells.size(); ++i) (i >= 5 * tiles ? in_last : before) += grid.cells[i].y;
  c.that(in_last > 0 && before == 0, "the open last slice lists {}, those before it {}", in_last, before);
}

void before_the_first_slice(Check& c) {
  c.grid(sliced(sixty()), {point({0, 0, -0.2}, 0.1), point({0, 0, -0.9}, 0.05), point({0, 0, 0}, 0.3)},
         {every_distance});
  CullView view = view_through(box(5, -20, 20), 127, 73);
  view.slice_edges = {-10, 0, 10};
  c.grid(view, {point({0, 0, 15}, 1), point({0, 0, 10}, 0.5), point({0, 0, -12}, 1)}, {{-1e18f, 1e18f}});
}

// Lights on a grid of 2^-16 m, moved with the camera by a whole number of metres: the same bits.
void far_from_the_origin(Check& c, double metres) {
  Random random(24);
  std::vector<CullLight> lights = scattered_lights(sixty(), 200, true, random);
  for (CullLight& light : lights) light.position = glm::round(light.position * 0x1p16) * 0x1p-16;
  const auto bounds = scattered_bounds(sixty(), 16, random);
  const CullView moved = placed(sixty(), {metres, -metres, metres / 2}, 0, 0);
  std::vector<CullLight> moved_lights = lights;
  for (CullLight& light : moved_lights) light.position += moved.eye;
  const HostGrid here = c.grid(sixty(), lights, bounds), there = c.grid(moved, moved_lights, bounds);
  c.that(here == there, "the moved world has another grid");
}
void world_at_1e6(Check& c) { far_from_the_origin(c, 1e6); }
void world_at_1e7(Check& c) { far_from_the_origin(c, 1e7); }
void world_at_1e8(Check& c) { far_from_the_origin(c, 1e8); }

// Most lights are at one position, which becomes the origin. The eye is half a float step off there, nine
// times the slack of lights at arm's length. Their coordinates are just past a power of two, where the
// rounding that their radii include is least.
void between_two_floats(Check& c) {
  Random random(61);
  const DepthInterval near{0.1f, 0.11f};
  const std::vector<DepthInterval> bounds(tile_count(sixty(), 16), near);
  auto lights = tangent_lights(sixty(), bounds, 16, 1000, Contact::any, 2, random);
  lights.insert(lights.end(), 1100, point({0, 0, -16.0000009}, 1e-3));
  c.grid(sixty(), lights, bounds);
}

void turned(Check& c) {
  for (const double yaw : {0.3, 1.5707963267948966, 3.1})
    lights_of_all_kinds(c, placed(sixty(), {3, 2, 1}, yaw, -yaw / 3));
}

}  // namespace

std::vector<HardCase> camera_cases() {
  const char* group = "camera";
  return {
      CASE(field_of_a_tenth, "0.1° across", "cross products of almost parallel rays cancel", "nothing lost"),
      CASE(field_of_170, "170° across", "slivers; slopes of 11", "nothing lost"),
      CASE(field_of_179, "179° across", "slopes of 115, rounded by more than slack",
           "no pixel's centre loses a light"),
      CASE(off_centre, "the image's centre off the axis", "symmetric planes: wrong sides", "nothing lost"),
      CASE(beside_the_axis, "the axis outside of the image, slopes of one sign up to 20",
           "min and max of x · near and x · far swapped", "nothing lost"),
      CASE(pixels_in_their_tiles, "a tiny light at every pixel's position, in eight kinds of view",
           "planes from the field of view, pixels from the matrix",
           "the tile that shading finds for a pixel lists its light"),
      CASE(orthographic_near_zero,
           "orthographic, near = 0; exponential and linear slices and z-bins from there",
           "log 0, division by 0 (Bevy #3316, #9614)", "nothing lost"),
      CASE(orthographic_behind_the_eye, "orthographic, near = -50",
           "negative distances treated as empty or clamped", "nothing lost"),
      CASE(orthographic_off_centre, "a box 4 m across, 4 km beside the axis", "the offset treated as a slope",
           "nothing lost"),
      CASE(orthographic_tiny_and_huge, "boxes of 0.2 mm and 200 km", "absolute epsilons", "nothing lost"),
      CASE(sliver, "2048 × 2 and 3 × 700 pixels, slopes of 40 beside 0.01", "one tolerance for both axes",
           "nothing lost"),
      CASE(pixels_not_square, "pixels a hundred times as wide as high", "one scale for both axes",
           "nothing lost"),
      CASE(sixteen_thousand_wide, "16384 × 17", "pixel coordinates in half precision or 14 bits",
           "nothing lost"),
      CASE(tiny_near, "near = 10⁻⁶ m, lights of that size", "absolute epsilons", "nothing lost"),
      CASE(huge_near, "near = 10⁶ m, a field of 0.1°", "a step of float is 0.1 m there", "nothing lost"),
      CASE(inside_a_light, "the eye in a light's sphere", "a tangent of an imaginary angle",
           "every tile lists it"),
      CASE(across_the_near_plane, "spheres through the near plane", "projected rectangles flip",
           "nothing lost"),
      CASE(behind, "lights wholly behind the eye", "projected through the eye, upside down",
           "listed nowhere"),
      CASE(behind_and_reaching_in, "centres behind the eye, spheres that reach in",
           "dropped with their centres", "nothing lost"),
      CASE(beyond_far, "centres beyond the far plane", "dropped with their centres (Filament #3141)",
           "nothing lost"),
      CASE(beyond_the_last_slice, "lights far behind the last slice's edge", "dropped (Godot #77112)",
           "the last slice is open-ended"),
      CASE(before_the_first_slice, "lights between the eye and the first slice's edge",
           "a gap before it (Armory #2125)", "the first slice begins at the eye"),
      CASE(world_at_1e6, "camera and lights moved by 10⁶ m", "a float's step is 0.06 m", "the same bytes"),
      CASE(world_at_1e7, "by 10⁷ m", "a step of 1 m", "the same bytes"),
      CASE(world_at_1e8, "by 10⁸ m", "a step of 8 m", "the same bytes"),
      CASE(between_two_floats,
           "lights at arm's length, most others 16 m away; the eye is half a float step from a float",
           "the rounding error of the eye's position is lost (GCC 12.2 sets it to 0 in y and z)",
           "nothing lost"),
      CASE(turned, "a turned and placed camera", "directions stay in world space", "nothing lost"),
  };
}

}  // namespace lightgrid::verify
