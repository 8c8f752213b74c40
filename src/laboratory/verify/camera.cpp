// Hard cases of the camera: projections, very wide fields, jitter, and positions of lights relative to the
// camera.
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "shared/cull_tests.h"
#include "shared/light_grid.h"
#include "verify/check.h"

namespace lightgrid::lab::verify {
namespace {

// Tangent and scattered lights and spots over thin, thick, flat, endless and empty cells.
void lights_of_all_kinds(Check& c, const CullView& view, int tile = 16) {
  Random random(21);
  const auto bounds = scattered_bounds(view, tile, random);
  bool any = false;
  for (const DepthInterval& b : bounds) any |= b.near <= b.far;
  auto lights = scattered_lights(view, 150, true, random);
  if (any) {
    add(lights, tangent_lights(view, bounds, tile, 250, Contact::any, 0, random));
    add(lights, tangent_spots(view, bounds, tile, 50, random));
  }
  move_to_world(view, lights);
  c.grid(view, lights, bounds, every_test(tile));
}

void scattered_pixels(Check& c, const CullView& view, uint64_t seed) {
  const auto [depth, lights] = scattered_over_depth(view, 100, true, seed);
  c.pixels(view, lights, depth, every_test());
}

void field(Check& c, double degrees) { lights_of_all_kinds(c, field_of_view(degrees, 127, 73)); }

void off_centre(Check& c) {
  for (const double shift : {0.2, -0.4})
    lights_of_all_kinds(
        c, view_through({.half_x = 0.8, .half_y = 0.5, .shift_x = shift, .shift_y = -shift / 2}, 127, 73));
}
void field_of_a_tenth(Check& c) { field(c, 0.1); }
void field_of_170(Check& c) { field(c, 170); }
void field_of_179(Check& c) { field(c, 179); }

void beside_the_axis(Check& c) {
  for (const double shift : {3.0, -20.0})
    lights_of_all_kinds(
        c, view_through({.half_x = 0.5, .half_y = 0.3, .shift_x = shift, .shift_y = shift}, 127, 73));
}

void pixels_in_their_tiles(Check& c) {
  for (const NamedView& named : hard_views(127, 73)) {
    c.contacts(c.pixels_find_tiny_lights(named.view, {.cull_test = CullTest::planes}));
    c.pixels_find_tiny_lights(named.view, {.cull_test = CullTest::exact});
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
  c.grid(view, lights, {{-40, -20}});
  c.grid(view, lights, {{-10, 10}});
  DepthImage depth;
  for (int i = 0; i < 127 * 73; ++i) depth.values.push_back(float(depth_at(view, i % 90 - 45)));
  c.bounds(view, depth, {});
  c.pixels(view, lights, depth, every_test());
}

void orthographic_off_centre(Check& c) {
  Lens lens = box(2, 0.1, 1000);
  lens.shift_x = 4000;
  lens.shift_y = -900;
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
  c.grid(view, lights, {{1.4e6f, 1.6e6f}});
  c.grid(view, lights, {{1.5e6f, 1.5e6f}});
}

void inside_a_light(Check& c) {
  const HostGrid grid = c.grid(
      sixty(), {point({0, 0, 0}, 5), point({0.3, -0.2, 0.5}, 5), point({0, 0, -3}, 3.0001)}, {{0.1f, 4}});
  c.each_cell_lists(grid, 3, "lights around the eye");
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
  c.grid(sixty(), lights, {{0.1f, 50}});
  c.grid(field_of_view(170, 127, 73), lights, {{0.1f, 50}});
}

void beyond_far(Check& c) {
  const CullView view = view_through({.near = 0.1, .far = 100}, 127, 73);
  const std::vector<CullLight> lights = {point({0, 0, -150}, 60), point({0, 0, -150}, 49),
                                         point({0, 0, -1e4}, 9950)};
  c.grid(view, lights, {{90, 100}});
  c.grid(view, lights, {every_distance});
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

// Past 170 degrees the slopes of a tile's sides are differences of two numbers as large as the slope at the
// image's edge; most precision is lost at the axis, which here goes through the last pixel of a tile. Lights
// stand in the next tile, beside the planes through the pixels there, and just reach the pixels.
void fields_to_179_9(Check& c) {
  constexpr int width = 127, height = 95, axis_x = 63, axis_y = 47;
  for (const double degrees : {150.0, 170.0, 174.0, 176.0, 178.0, 179.0, 179.5, 179.9}) {
    const CullView view = field_of_view(degrees, width, height);
    const DepthImage depth = depth_of(view, [](int x, int y) { return 2 + (x * 7 + y * 3) % 5; });
    Random random(25);
    std::vector<CullLight> lights;
    const auto add = [&](int x, int y, int axis, double side) {
      const glm::dvec3 q = *surface_at(view, depth, x, y);
      glm::dvec3 normal(0, 0, q[axis] / -q.z);  // plane through the eye and the pixel's column or row
      normal[axis] = 1;
      const double size = -q.z * std::exp2(-6 - 10 * random.uniform());
      lights.push_back(point(q + side * size * glm::normalize(normal), size * (1 + 0x1p-30)));
    };
    for (int i = -3; i <= 3; ++i) {
      for (int repeat = 0; repeat < 4; ++repeat) {
        add(axis_x, axis_y + i, 0, 1);
        add(axis_x + 1, axis_y + i, 0, -1);
        add(axis_x + i, axis_y, 1, 1);
        add(axis_x + i, axis_y + 1, 1, -1);
      }
    }
    verify::add(lights, grazing_lights(view, depth, 200, true, random));
    c.pixels(view, lights, depth, every_test());
  }
}

// Halton's first points in bases 2 and 3, as engines move the image by parts of a pixel.
void jittered(Check& c) {
  constexpr double offsets[][2] = {{0, -1.0 / 6},       {-0.25, 1.0 / 6},  {0.25, -7.0 / 18},
                                   {-0.375, -1.0 / 18}, {0.125, 5.0 / 18}, {0.5, 0.5}};
  const CullView still = field_of_view(60, 64, 48);
  for (const auto& [x, y] : offsets) {
    CullView view = still;
    view.clip_from_view[2][0] += 2 * x / view.width;
    view.clip_from_view[2][1] += 2 * y / view.height;
    const auto distance = [](int px, int py) { return 2 + (px * 5 + py * 3) % 20; };
    const DepthImage depth = depth_of(view, distance);
    // Tiny lights at the pixels' own positions: a matrix off by a fraction of a pixel moves outer pixels to
    // the next tile.
    const HostGrid grid = c.pixels(view, lights_at_surfaces(view, depth, 1e-6), depth, every_tile());
    c.that(grid == c.engine.cull_depth({}, view, lights_at_surfaces(view, depth, 1e-6), depth),
           "the next frame through the same matrix has another grid");
  }
}

struct NamedMatrix {
  const char* name;
  int column, row;
  double value;
  bool orthographic;
};

// Each is either refused by name or loses nothing. Surfaces' positions come from the inverse matrix, which
// handles every kind of projection.
void other_projections(Check& c) {
  constexpr NamedMatrix changes[] = {{"shear of x by y", 1, 0, 0.3, false},
                                     {"shear of y by x", 0, 1, -0.4, false},
                                     {"oblique near plane in x", 0, 2, 0.004, false},
                                     {"oblique near plane in y", 1, 2, -0.004, false},
                                     {"w depends on x", 0, 3, 0.3, false},
                                     {"w depends on y", 1, 3, -0.2, false},
                                     {"x moved", 3, 0, 0.5, false},
                                     {"y moved", 3, 1, -0.5, false},
                                     {"x depends on z", 2, 0, 0.05, true},
                                     {"shear of x by y", 1, 0, 0.3, true},
                                     {"depth depends on x", 0, 2, 0.01, true},
                                     {"w depends on x", 0, 3, 0.05, true}};
  for (const NamedMatrix& change : changes) {
    CullView view =
        change.orthographic
            ? view_through({.half_x = 4, .half_y = 3, .near = 0.5, .far = 50, .orthographic = true}, 64, 48)
            : view_through({.half_x = 1, .half_y = 0.75, .near = 0.1}, 64, 48);
    view.clip_from_view[change.column][change.row] += change.value;
    const glm::dmat4 view_from_clip = glm::inverse(view.clip_from_view);
    DepthImage depth;
    std::vector<CullLight> lights;
    for (int y = 0; y < view.height; ++y) {
      for (int x = 0; x < view.width; ++x) {
        depth.values.push_back(change.orthographic ? 0.2f + 0.01f * float((x + y) % 60)
                                                   : 0.1f / float(2 + (x * 5 + y) % 9));
        const glm::dvec4 clip((x + 0.5) * 2 / view.width - 1, (y + 0.5) * 2 / view.height - 1,
                              depth.values.back(), 1);
        const glm::dvec4 p = view_from_clip * clip;
        lights.push_back(point(glm::dvec3(p) / p.w, 1e-4 * glm::length(glm::dvec3(p) / p.w)));
      }
    }
    try {
      c.pixels_find_lights(c.engine.cull_depth({}, view, lights, depth), view, 16, change.name);
    } catch (const Error& error) {
      c.that(error.kind() == ErrorKind::input, "{}: {}", change.name, error.what());
    }
  }
}

// Found by fuzzing: squares of radii were infinite, and one kernel shape dropped lights that the other kept.
// Since then lights past 10^16 m are uploaded nearer, with finite squares.
void eye_1e26_m_off(Check& c) {
  const glm::dvec3 eye(-9.4e25, 0, 1);
  const CullView view = placed(small_sixty(), eye, 0.5, -0.1);
  Random random(39);
  std::vector<CullLight> lights;
  for (const glm::dvec3& middle : {glm::dvec3(0), eye / 2.0, eye * (1 - 1e-6), eye}) {
    for (int i = 0; i < 100; ++i) {
      const double radius = std::pow(10.0, double(random.uniform(0, 38)));
      lights.push_back(point(middle + any_direction(random) * 20.0, radius));
    }
  }
  for (const DepthInterval& bounds : {DepthInterval{12, 99}, every_distance}) {
    for (const CullerOptions& options : every_test()) {
      const HostGrid grid = c.grid_of_known_answer(view, lights, {bounds}, options);
      for (uint32_t i = 0; i < lights.size(); ++i) {
        if (!(lights[i].radius_m > 1.01 * glm::distance(lights[i].position, eye) + 1000)) continue;
        for (size_t cell = 0; cell < grid.cells.size(); ++cell) {
          c.contacts(1);
          c.trials(1);
          if (!std::ranges::binary_search(list_of(grid, cell), i))
            c.lost("{}: cell {} lost light {}, which reaches everything", to_string(options), cell, i);
        }
      }
    }
  }
}

// Found by fuzzing: half-z cut a tile where it has no surface. Since then the second view is refused; a
// culler that takes it must lose nothing.
void nearest_near_plane(Check& c) {
  for (const double near : {1e-37, 3e-53}) {
    const CullView view = view_through({.half_x = 2.6, .half_y = 0.44, .near = near}, 19, 13);
    const DepthImage depth = depth_of(
        view, [&](int x, int y) { return (x + y) % 5 ? near * std::exp2((x * 7 + y * 3) % 149) : sky; });
    std::vector<CullLight> lights = lights_at_surfaces(view, depth, 1e-3);
    for (int i = 0; i < 50; ++i) lights.push_back(point({i % 10 - 4.5, i % 7 - 3, -3 * i}, i % 13));
    try {
      c.pixels(view, lights, depth, every_mode());
    } catch (const Error& error) {
      c.that(near < 1e-37 && error.kind() == ErrorKind::input, "a near plane at {} m: {}", near,
             error.what());
    }
  }
}

}  // namespace

std::vector<CaseRun> camera_cases() {
  return CASES(field_of_a_tenth, field_of_170, field_of_179, off_centre, beside_the_axis,
               pixels_in_their_tiles, orthographic_near_zero, orthographic_behind_the_eye,
               orthographic_off_centre, orthographic_tiny_and_huge, sliver, pixels_not_square,
               sixteen_thousand_wide, tiny_near, huge_near, inside_a_light, across_the_near_plane, behind,
               behind_and_reaching_in, beyond_far, beyond_the_last_slice, before_the_first_slice,
               world_at_1e6, world_at_1e7, world_at_1e8, between_two_floats, turned, fields_to_179_9,
               jittered, other_projections, eye_1e26_m_off, nearest_near_plane);
}

}  // namespace lightgrid::lab::verify
