// Hard cases of depth: values that a depth buffer may hold, and images of awkward sizes. depth_bounds.cpp has
// the kinds of bounds.
#include <cmath>

#include "verify/check.h"

namespace lightgrid::lab::verify {
namespace {

void all_sky(Check& c) {
  const DepthImage depth = depth_of(small_sixty(), [](int, int) { return sky; });
  const std::vector<CullLight> lights = {point({0, 0, -5}, 1e20), point({0, 0, -1e6}, 1e6)};
  for (const CullerOptions& options : every_tile()) c.bounds(small_sixty(), depth, options);
  for (CullerOptions options : every_mode()) {
    if (options.depth_bounds == DepthBoundsMode::none) continue;
    const HostGrid grid = c.engine.cull_depth(options, small_sixty(), lights, depth);
    c.that(grid.indices.empty(), "{}: sky lists {} lights", to_string(options), grid.indices.size());
  }
  const HostGrid grid = c.engine.cull_depth({.blend = true}, small_sixty(), {lights.data(), 1}, depth, true);
  c.that(grid.indices.size() == grid.cells.size(), "blended surfaces before the sky have {} of {} lists",
         grid.indices.size(), grid.cells.size());
}

void sky_beside_surface(Check& c) {
  const DepthImage depth = depth_of(small_sixty(), [](int x, int y) { return (x + y) % 2 ? sky : 2.0; });
  const std::vector<CullLight> lights = {point({0, 0, -2}, 1), point({0, 0, -50}, 20)};
  c.bounds(small_sixty(), depth, {});
  const HostGrid grid = c.pixels(small_sixty(), lights, depth, every_mode());
  for (const uint32_t light : grid.indices) c.that(light == 0, "the light far behind the surface is listed");
}

void empty_interval(Check& c) {
  const std::vector<CullLight> lights = {point({0, 0, -5}, 1e20), point({0, 0, -5}, no_end),
                                         point({0, 0, 0}, 10)};
  for (const DepthInterval b :
       {no_surface, DepthInterval{2, 1}, DepthInterval{1, std::nextafter(1.0f, 0.0f)}})
    c.that(c.grid(small_sixty(), lights, {b}).indices.empty(), "an empty tile lists lights");
}

void awkward_size(Check& c, int width, int height) {
  const CullView view = field_of_view(60, width, height);
  const auto [depth, lights] = scattered_over_depth(view, 60, true, 3);
  for (const CullerOptions& options : every_tile()) c.bounds(view, depth, options);
  c.pixels(view, lights, depth, every_tile());
}
void one_pixel_image(Check& c) { awkward_size(c, 1, 1); }
void one_row_image(Check& c) {
  awkward_size(c, 17, 1);
  awkward_size(c, 1, 33);
}

// Compares the image's tiles with those of the larger image that it is cut from.
void odd_size(Check& c) {
  const CullView large = field_of_view(60, 1296, 736), cut = [&] {
    CullView view = large;
    view.width = 1279;
    view.height = 721;
    return view;
  }();
  Random random(4);
  DepthImage depth = scattered_depth(large, random);
  depth.row_pixels = large.width;
  for (const CullerOptions& options : every_tile()) c.bounds(cut, depth, options);
  const auto whole = c.bounds(large, depth, {}), part = c.bounds(cut, depth, {});
  for (int y = 0; y < 721 / 16; ++y) {
    for (int x = 0; x < 1279 / 16; ++x) {
      const DepthInterval a = whole[size_t(y) * 81 + x], b = part[size_t(y) * 80 + x];
      if (!c.that(a.near == b.near && a.far == b.far, "tile {} {} differs from the larger image's", x, y))
        return;
    }
  }
  c.grid(cut, scattered_lights(cut, 40, true, random), {{1, 20}}, {CullerOptions{}});
}

void viewport(Check& c) {
  Random random(5);
  const CullView whole = field_of_view(60, 130, 90), part = field_of_view(60, 71, 37);
  DepthImage inside = scattered_depth(whole, random), cropped;
  inside.row_pixels = 130;
  inside.x = 19;
  inside.y = 23;
  for (int y = 0; y < 37; ++y)
    for (int x = 0; x < 71; ++x) cropped.values.push_back(inside.values[size_t(y + 23) * 130 + x + 19]);
  const auto lights = scattered_lights(part, 100, true, random);
  for (const CullerOptions& options : every_tile()) c.bounds(part, inside, options);
  const HostGrid a = c.pixels(part, lights, inside, every_mode()),
                 b = c.pixels(part, lights, cropped, every_mode());
  c.that(a == b, "the viewport's grid is not that of the image cut out");
}

constexpr float infinite = std::numeric_limits<float>::infinity(),
                not_a_number = std::numeric_limits<float>::quiet_NaN();

// One invalid value in the only tile, among surfaces: every light that any distance would list must be
// listed.
void strange_value(Check& c, std::initializer_list<float> values) {
  for (const float value : values) {
    for (const size_t at : {size_t(0), size_t(5), size_t(16 * 64 + 15), size_t(47 * 64 + 63)}) {
      DepthImage depth = depth_of(small_sixty(), [](int, int) { return 5.0; });
      depth.values[at] = value;
      c.bounds(small_sixty(), depth, {});
      c.pixels(small_sixty(), {point({0, 0, -5}, 1), point({0, 0, -100}, 98)}, depth, every_mode());
    }
  }
}
void nan_depth(Check& c) { strange_value(c, {not_a_number, -not_a_number}); }
void infinite_depth(Check& c) { strange_value(c, {infinite, -infinite}); }
void negative_depth(Check& c) { strange_value(c, {-0.5f, -1e-45f, -1e30f}); }
void depth_above_one(Check& c) { strange_value(c, {std::nextafter(1.0f, 2.0f), 1e30f}); }

void minus_zero(Check& c) {
  DepthImage depth = depth_of(small_sixty(), [](int, int) { return 5.0; });
  depth.values[3] = -0.0f;
  for (const DepthInterval& b : c.engine.depth_bounds({}, small_sixty(), depth))
    c.that(b.near <= 5 && b.far >= 5, "minus zero hides the surface: [{}, {}]", b.near, b.far);
  c.pixels(small_sixty(), {point({0, 0, -5}, 1)}, depth, every_mode());
}

// Distances that both depth orders represent exactly.
void reversed_against_standard(Check& c) {
  const CullView reversed = view_through({.near = 1, .order = DepthOrder::reversed}, 64, 48);
  const CullView standard = view_through({.near = 1, .order = DepthOrder::standard}, 64, 48);
  const auto distance = [](int x, int y) { return std::exp2(1 + (x / 7 + y / 5) % 6); };
  const DepthImage a = depth_of(reversed, distance), b = depth_of(standard, distance);
  std::vector<CullLight> lights;  // clear of the bounds by far more than their widening
  for (int i = 0; i < 60; ++i)
    lights.push_back(point({i % 9 - 4, i % 7 - 3, -1.37 * std::exp2(i % 6)}, 0.61 + i % 5));
  c.bounds(reversed, a, {}, false);
  c.bounds(standard, b, {}, false);
  const HostGrid ga = c.pixels(reversed, lights, a, every_mode()),
                 gb = c.pixels(standard, lights, b, every_mode());
  c.that(ga == gb, "reversed and standard depth give two grids");
}

void endless_far(Check& c) {
  const CullView view = view_through({.near = 0.1}, 64, 48);
  for (const float least : {1e-45f, 1e-38f, 1.17549435e-38f, 1e-20f}) {
    DepthImage depth = depth_of(view, [](int, int) { return 5.0; });
    for (int x = 0; x < 64; x += 3) depth.values[size_t(x) * 17] = least;
    const auto found = c.bounds(view, depth, {}, false);
    for (const DepthInterval& b : found)
      c.that(std::isfinite(b.near) && std::isfinite(b.far), "[{}, {}]", b.near, b.far);
    c.pixels(view, {point({0, 0, -5}, 1), point({0, 0, -1e17}, 1e18)}, depth, every_mode());
  }
  // Up to the limit of the domain, each surface with a small light at its position and lights that just reach
  // one.
  const DepthImage far = depth_of(view, [](int x, int y) { return std::pow(10.0, (x + 5 * y) % 31 / 2.0); });
  std::vector<CullLight> lights = lights_at_surfaces(view, far, 1e-5);
  Random random(9);
  add(lights, grazing_lights(view, far, 300, true, random));
  c.bounds(view, far, {}, false);
  c.pixels(view, lights, far, every_mode());
}

// Near at 10^-30 m puts a surface a kilometre away at a denormal depth.
void denormal_depth(Check& c) {
  const CullView view = view_through({.near = 0x1p-120}, 64, 48);
  const DepthImage depth = depth_of(view, [](int x, int) { return x % 3 ? 1000.0 : 5000.0; });
  c.bounds(view, depth, {}, false);
  c.pixels(view, {point({0, 0, -1000}, 50), point({0, 0, -5000}, 50)}, depth, every_mode());
}

void finite_far(Check& c) {
  for (const DepthOrder order : {DepthOrder::reversed, DepthOrder::standard}) {
    const CullView view = view_through({.near = 0.5, .far = 100, .order = order}, 64, 48);
    const DepthImage depth = depth_of(view, [](int x, int y) { return x < 20 ? 99.5 : y < 20 ? sky : 60.0; });
    c.bounds(view, depth, {}, false);
    c.pixels(view, {point({0, 0, -100}, 1), point({-60, 0, -99.5}, 30), point({0, 0, -60}, 5)}, depth,
             every_mode());
  }
}

void at_near_plane(Check& c) {
  for (const DepthOrder order : {DepthOrder::reversed, DepthOrder::standard}) {
    const CullView view = view_through({.near = 0.5, .order = order}, 64, 48);
    DepthImage depth = depth_of(view, [](int, int) { return 0.5; });
    c.bounds(view, depth, {}, false);
    c.pixels(view, {point({0, 0, 0}, 0.55), point({0, 0, -1}, 0.55), point({0.4, 0.4, -0.5}, 0.01)}, depth,
             every_mode());
  }
}

}  // namespace

std::vector<CaseRun> depth_cases() {
  return CASES(all_sky, sky_beside_surface, empty_interval, one_pixel_image, one_row_image, odd_size,
               viewport, nan_depth, infinite_depth, negative_depth, minus_zero, depth_above_one,
               reversed_against_standard, endless_far, denormal_depth, finite_far, at_near_plane);
}

}  // namespace lightgrid::lab::verify
