// Hard cases of depth: values that a depth buffer may hold, and images of awkward sizes. depth_bounds.cpp has
// the kinds of bounds.
#include <cmath>

#include "verify/depth_images.h"

namespace lightgrid::verify {
namespace {

void all_sky(Check& c) {
  const DepthImage depth = depth_of(sixty_degrees(), [](int, int) { return sky; });
  const std::vector<CullLight> lights = {point({0, 0, -5}, 1e20), point({0, 0, -1e6}, 1e6)};
  for (const int tile : {8, 16, 32, 64}) c.bounds(sixty_degrees(), depth, tile_of(tile));
  for (CullerOptions options : every_mode()) {
    if (options.depth_bounds == DepthBoundsMode::none) continue;
    options.shape = KernelShape::automatic;
    const HostGrid grid = c.engine.cull_depth(options, sixty_degrees(), lights, depth);
    c.that(listed(grid) == 0, "{}: sky lists {} lights", to_string(options), listed(grid));
  }
  CullerOptions blended;
  blended.blend = true;
  const HostGrid grid = c.engine.cull_depth(blended, sixty_degrees(), {lights.data(), 1}, depth, true);
  c.that(listed(grid) == grid.cells.size(), "blended surfaces before the sky have {} of {} lists",
         listed(grid), grid.cells.size());
}

void sky_beside_surface(Check& c) {
  const DepthImage depth = depth_of(sixty_degrees(), [](int x, int y) { return (x + y) % 2 ? sky : 2.0; });
  const std::vector<CullLight> lights = {point({0, 0, -2}, 1), point({0, 0, -50}, 20)};
  c.bounds(sixty_degrees(), depth, tile_of(16));
  const HostGrid grid = c.pixels(sixty_degrees(), lights, depth, every_mode());
  for (const uint32_t light : grid.indices) c.that(light == 0, "the light far behind the surface is listed");
}

void empty_interval(Check& c) {
  const std::vector<CullLight> lights = {point({0, 0, -5}, 1e20), point({0, 0, -5}, no_end),
                                         point({0, 0, 0}, 10)};
  for (const DepthInterval b :
       {no_surface, DepthInterval{2, 1}, DepthInterval{1, std::nextafter(1.0f, 0.0f)}})
    c.that(listed(c.grid(sixty_degrees(), lights, {b})) == 0, "an empty tile lists lights");
}

void awkward_size(Check& c, int width, int height) {
  const CullView view = field_of_view(60, width, height);
  const auto [depth, lights] = scattered_over_depth(view, 60, true, 3);
  for (const CullerOptions& options : c.every_tile()) c.bounds(view, depth, options);
  c.pixels(view, lights, depth, c.every_tile());
}

void one_pixel_image(Check& c) { awkward_size(c, 1, 1); }
void one_row_image(Check& c) { awkward_size(c, 17, 1), awkward_size(c, 1, 33); }

// Compares the image's tiles with those of the larger image that it is cut from.
void odd_size(Check& c) {
  const CullView large = field_of_view(60, 1296, 736), cut = [&] {
    CullView view = large;
    view.width = 1279, view.height = 721;
    return view;
  }();
  Random random(4);
  DepthImage depth = scattered_depth(large, random);
  depth.row_pixels = large.width;
  for (const int tile : {8, 16, 32, 64}) c.bounds(cut, depth, tile_of(tile));
  const auto whole = c.bounds(large, depth, tile_of(16)), part = c.bounds(cut, depth, tile_of(16));
  for (int y = 0; y < 721 / 16; ++y) {
    for (int x = 0; x < 1279 / 16; ++x) {
      const DepthInterval a = whole[size_t(y) * 81 + x], b = part[size_t(y) * 80 + x];
      if (!c.that(a.near == b.near && a.far == b.far, "tile {} {} differs from the larger image's", x, y))
        return;
    }
  }
  c.grid(cut, scattered_lights(cut, 40, true, random), {{1, 20}}, {tile_of(16)});
}

void viewport(Check& c) {
  Random random(5);
  const CullView whole = field_of_view(60, 130, 90), part = field_of_view(60, 71, 37);
  DepthImage inside = scattered_depth(whole, random), cropped;
  inside.row_pixels = 130, inside.x = 19, inside.y = 23;
  for (int y = 0; y < 37; ++y)
    for (int x = 0; x < 71; ++x) cropped.values.push_back(inside.values[size_t(y + 23) * 130 + x + 19]);
  const auto lights = scattered_lights(part, 100, true, random);
  for (const CullerOptions& options : c.every_tile()) c.bounds(part, inside, options);
  const HostGrid a = c.pixels(part, lights, inside, every_mode()),
                 b = c.pixels(part, lights, cropped, every_mode());
  c.that(a == b, "the viewport's grid is not that of the image cut out");
}

// One invalid value in the only tile, among surfaces: every light that any distance would list must be
// listed.
void strange_value(Check& c, std::initializer_list<float> values) {
  for (const float value : values) {
    for (const size_t at : {size_t(0), size_t(5), size_t(16 * 64 + 15), size_t(47 * 64 + 63)}) {
      DepthImage depth = depth_of(sixty_degrees(), [](int, int) { return 5.0; });
      depth.values[at] = value;
      c.bounds(sixty_degrees(), depth, tile_of(16));
      c.pixels(sixty_degrees(), {point({0, 0, -5}, 1), point({0, 0, -100}, 98)}, depth, every_mode());
    }
  }
}

constexpr float infinite = std::numeric_limits<float>::infinity(),
                not_a_number = std::numeric_limits<float>::quiet_NaN();
void nan_depth(Check& c) { strange_value(c, {not_a_number, -not_a_number}); }
void infinite_depth(Check& c) { strange_value(c, {infinite, -infinite}); }
void negative_depth(Check& c) { strange_value(c, {-0.5f, -1e-45f, -1e30f}); }
void depth_above_one(Check& c) { strange_value(c, {std::nextafter(1.0f, 2.0f), 1e30f}); }

void minus_zero(Check& c) {
  DepthImage depth = depth_of(sixty_degrees(), [](int, int) { return 5.0; });
  depth.values[3] = -0.0f;
  for (const DepthInterval& b : c.engine.depth_bounds(tile_of(16), sixty_degrees(), depth))
    c.that(b.near <= 5 && b.far >= 5, "minus zero hides the surface: [{}, {}]", b.near, b.far);
  c.pixels(sixty_degrees(), {point({0, 0, -5}, 1)}, depth, every_mode());
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
  c.bounds(reversed, a, tile_of(16), false);
  c.bounds(standard, b, tile_of(16), false);
  const HostGrid ga = c.pixels(reversed, lights, a, every_mode()),
                 gb = c.pixels(standard, lights, b, every_mode());
  c.that(ga == gb, "reversed and standard depth give two grids");
}

void endless_far(Check& c) {
  const CullView view = view_through({.near = 0.1}, 64, 48);
  for (const float least : {1e-45f, 1e-38f, 1.17549435e-38f, 1e-20f}) {
    DepthImage depth = depth_of(view, [](int, int) { return 5.0; });
    for (int x = 0; x < 64; x += 3) depth.values[size_t(x) * 17] = least;
    const auto found = c.bounds(view, depth, tile_of(16), false);
    for (const DepthInterval& b : found)
      c.that(std::isfinite(b.near) && std::isfinite(b.far), "[{}, {}]", b.near, b.far);
    c.pixels(view, {point({0, 0, -5}, 1), point({0, 0, -1e17}, 1e18)}, depth, every_mode());
  }
  // Up to the limit of the domain, each surface with a small light at its position and lights that just reach
  // one.
  const DepthImage far = depth_of(view, [](int x, int y) { return std::pow(10.0, (x + 5 * y) % 31 / 2.0); });
  std::vector<CullLight> lights = lights_at_surfaces(view, far, 1e-5);
  Random random(9);
  for (const CullLight& light : grazing_lights(view, far, 300, true, random)) lights.push_back(light);
  c.bounds(view, far, tile_of(16), false);
  c.pixels(view, lights, far, every_mode());
}

// Near at 10^-30 m puts a surface a kilometre away at a denormal depth.
void denormal_depth(Check& c) {
  const CullView view = view_through({.near = 0x1p-120}, 64, 48);
  const DepthImage depth = depth_of(view, [](int x, int) { return x % 3 ? 1000.0 : 5000.0; });
  c.bounds(view, depth, tile_of(16), false);
  c.pixels(view, {point({0, 0, -1000}, 50), point({0, 0, -5000}, 50)}, depth, every_mode());
}

void finite_far(Check& c) {
  for (const DepthOrder order : {DepthOrder::reversed, DepthOrder::standard}) {
    const CullView view = view_through({.near = 0.5, .far = 100, .order = order}, 64, 48);
    const DepthImage depth = depth_of(view, [](int x, int y) { return x < 20 ? 99.5 : y < 20 ? sky : 60.0; });
    c.bounds(view, depth, tile_of(16), false);
    c.pixels(view, {point({0, 0, -100}, 1), point({-60, 0, -99.5}, 30), point({0, 0, -60}, 5)}, depth,
             every_mode());
  }
}

void at_near_plane(Check& c) {
  for (const DepthOrder order : {DepthOrder::reversed, DepthOrder::standard}) {
    const CullView view = view_through({.near = 0.5, .order = order}, 64, 48);
    DepthImage depth = depth_of(view, [](int, int) { return 0.5; });
    c.bounds(view, depth, tile_of(16), false);
    c.pixels(view, {point({0, 0, 0}, 0.55), point({0, 0, -1}, 0.55), point({0.4, 0.4, -0.5}, 0.01)}, depth,
             every_mode());
  }
}

}  // namespace

std::vector<HardCase> depth_cases() {
  const char* group = "depth";
  return {
      CASE(all_sky, "nothing but sky", "max = far: every light is listed",
           "no list in any mode; blended surfaces keep theirs"),
      CASE(sky_beside_surface, "sky and a wall at 2 m in each tile", "an interval from 2 m to far",
           "sky is left out of the maximum"),
      CASE(empty_interval, "near > far, also by one ulp; lights of infinite radius",
           "an inverted box accepts or rejects by accident", "an empty tile lists nothing"),
      CASE(one_pixel_image, "1 × 1", "items that return before a barrier hang; reads out of range",
           "as a plain scan; nothing lost"),
      CASE(one_row_image, "17 × 1, 1 × 33", "the last tile's rows are read past the end",
           "as a plain scan; nothing lost"),
      CASE(odd_size, "1279 × 721 cut from 1296 × 736", "partial tiles are dropped, or read past the image",
           "whole tiles as those of the larger image, partial ones as a plain scan"),
      CASE(viewport, "a rectangle within a larger depth image",
           "tiles counted from the image's corner (Bevy #5946)", "byte-equal to the rectangle cut out"),
      CASE(nan_depth, "NaN of both signs among surfaces", "min and max depend on the order",
           "the tile spans every distance"),
      CASE(infinite_depth, "±infinity among surfaces", "inf - inf", "the tile spans every distance"),
      CASE(negative_depth, "-0.5, -1e-45, -1e30", "integer minimum and maximum swap",
           "the tile spans every distance"),
      CASE(minus_zero, "-0 among surfaces", "as an integer it is the largest value and hides the rest",
           "the surfaces beside it keep their lights"),
      CASE(depth_above_one, "one ulp above 1; 1e30", "a distance nearer than the near plane, or negative",
           "the tile spans every distance"),
      CASE(reversed_against_standard, "the same surfaces in both depths", "min and max swapped",
           "the same grid"),
      CASE(endless_far, "infinite far; depth 1e-45 … 1e-20; surfaces and lights to 10¹⁵ m",
           "division by almost zero: infinity, NaN", "bounds finite, surfaces inside, nothing lost"),
      CASE(denormal_depth, "surfaces whose depth is denormal", "flushed to 0: taken for sky", "nothing lost"),
      CASE(finite_far, "surfaces just in front of a far plane, and sky", "far plane and background confused",
           "surfaces inside, sky out"),
      CASE(at_near_plane, "every surface on the near plane", "rounded to nearer than near and dropped",
           "nothing lost"),
  };
}

}  // namespace lightgrid::verify
