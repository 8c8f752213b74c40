// Hard cases of depth: what a depth buffer may hold, and what bounds of it must.
#include <cmath>

#include "study/verify/check.h"
#include "study/verify/tangent_lights.h"

namespace lightgrid::verify {
namespace {

constexpr double sky = no_end;

// distance(x, y) in metres; sky: nothing is there.
template <typename Distance>
DepthImage depth_of(const CullView& view, const Distance& distance) {
  DepthImage depth;
  for (int y = 0; y < view.height; ++y) {
    for (int x = 0; x < view.width; ++x) {
      const double d = distance(x, y);
      depth.values.push_back(d == sky ? depth_of_nothing(view) : float(depth_at(view, d)));
    }
  }
  return depth;
}

std::vector<CullerOptions> every_mode(int tile = 16) {
  std::vector<CullerOptions> settings;
  for (const DepthBoundsMode mode : {DepthBoundsMode::minmax, DepthBoundsMode::none, DepthBoundsMode::halfz,
                                     DepthBoundsMode::halfz_modified, DepthBoundsMode::mask32}) {
    CullerOptions options;
    options.depth_bounds = mode, options.tile = tile;
    settings.push_back(options);
  }
  return settings;
}

CullerOptions tile_of(int tile) {
  CullerOptions options;
  options.tile = tile;
  return options;
}

// A light the size of a thousandth of its distance at every pixel's surface.
std::vector<CullLight> light_at_each(const CullView& view, const DepthImage& depth, double share) {
  std::vector<CullLight> lights;
  const Cell image = cell_of(view, std::max(view.width, view.height), 0, every_distance, true);
  const auto along = [](double a, double b, int i, int n) { return n > 1 ? a + (b - a) * i / (n - 1) : a; };
  for (int i = 0; i < view.width * view.height; ++i) {
    if (depth.values[i] == depth_of_nothing(view)) continue;
    const double d = distance_at(view, depth.values[i]), scale = image.scale_at(d);
    const double x = along(image.x0, image.x1, i % view.width, view.width) * scale;
    const double y = along(image.y0, image.y1, i / view.width, view.height) * scale;
    lights.push_back(point({x, y, -d}, share * std::max(d, 0.01)));
  }
  return lights;
}

const CullView& sixty() {
  static const CullView view = field_of_view(60, 64, 48);
  return view;
}

uint64_t listed(const HostGrid& grid) { return grid.indices.size(); }

void all_sky(Check& c) {
  const DepthImage depth = depth_of(sixty(), [](int, int) { return sky; });
  const std::vector<CullLight> lights = {point({0, 0, -5}, 1e20), point({0, 0, -1e6}, 1e6)};
  for (const int tile : {8, 16, 32, 64}) c.bounds(sixty(), depth, tile_of(tile));
  for (CullerOptions options : every_mode()) {
    if (options.depth_bounds == DepthBoundsMode::none) continue;
    options.shape = KernelShape::automatic;
    const HostGrid grid = c.engine.cull_depth(options, sixty(), lights, depth);
    c.that(listed(grid) == 0, "{}: sky lists {} lights", to_string(options), listed(grid));
  }
  CullerOptions blended;
  blended.blend = true;
  const HostGrid grid = c.engine.cull_depth(blended, sixty(), {lights.data(), 1}, depth, true);
  c.that(listed(grid) == grid.cells.size(), "blended surfaces before the sky have {} of {} lists", listed(grid),
         grid.cells.size());
}

void sky_beside_surface(Check& c) {
  const DepthImage depth = depth_of(sixty(), [](int x, int y) { return (x + y) % 2 ? sky : 2.0; });
  const std::vector<CullLight> lights = {point({0, 0, -2}, 1), point({0, 0, -50}, 20)};
  c.bounds(sixty(), depth, tile_of(16));
  const HostGrid grid = c.pixels(sixty(), lights, depth, every_mode());
  for (const uint32_t light : grid.indices) c.that(light == 0, "the light far behind the surface is listed");
}

void empty_interval(Check& c) {
  const std::vector<CullLight> lights = {point({0, 0, -5}, 1e20), point({0, 0, -5}, no_end), point({0, 0, 0}, 10)};
  for (const DepthInterval b : {no_surface, DepthInterval{2, 1}, DepthInterval{1, std::nextafter(1.0f, 0.0f)}})
    c.that(listed(c.grid(sixty(), lights, {b})) == 0, "an empty tile lists lights");
}

void awkward_size(Check& c, int width, int height) {
  const CullView view = field_of_view(60, width, height);
  Random random(3);
  const DepthImage depth = scattered_depth(view, random);
  const auto lights = scattered_lights(view, 60, true, random);
  for (const CullerOptions& options : c.every_tile()) c.bounds(view, depth, options);
  c.pixels(view, lights, depth, c.every_tile());
}

void one_pixel_image(Check& c) { awkward_size(c, 1, 1); }
void one_row_image(Check& c) { awkward_size(c, 17, 1), awkward_size(c, 1, 33); }

// The image's tiles are those of the larger image that it is cut from.
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
      if (!c.that(a.near == b.near && a.far == b.far, "tile {} {} differs from the larger image's", x, y)) return;
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
  const HostGrid a = c.pixels(part, lights, inside, every_mode()), b = c.pixels(part, lights, cropped, every_mode());
  c.that(a == b, "the viewport's grid is not that of the image cut out");
}

// One strange value in the one tile, among surfaces: every light that any distance would list is listed.
void strange_value(Check& c, std::initializer_list<float> values) {
  for (const float value : values) {
    for (const size_t at : {size_t(0), size_t(5), size_t(16 * 64 + 15), size_t(47 * 64 + 63)}) {
      DepthImage depth = depth_of(sixty(), [](int, int) { return 5.0; });
      depth.values[at] = value;
      c.bounds(sixty(), depth, tile_of(16));
      c.pixels(sixty(), {point({0, 0, -5}, 1), point({0, 0, -100}, 98)}, depth, every_mode());
    }
  }
}

constexpr float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
void nan_depth(Check& c) { strange_value(c, {nan, -nan}); }
void infinite_depth(Check& c) { strange_value(c, {inf, -inf}); }
void negative_depth(Check& c) { strange_value(c, {-0.5f, -1e-45f, -1e30f}); }
void depth_above_one(Check& c) { strange_value(c, {std::nextafter(1.0f, 2.0f), 1e30f}); }

void minus_zero(Check& c) {
  DepthImage depth = depth_of(sixty(), [](int, int) { return 5.0; });
  depth.values[3] = -0.0f;
  for (const DepthInterval& b : c.engine.depth_bounds(tile_of(16), sixty(), depth))
    c.that(b.near <= 5 && b.far >= 5, "minus zero hides the surface: [{}, {}]", b.near, b.far);
  c.pixels(sixty(), {point({0, 0, -5}, 1)}, depth, every_mode());
}

// Distances that both depths hold exactly.
void reversed_against_standard(Check& c) {
  const CullView reversed = view_through({.near = 1, .order = DepthOrder::reversed}, 64, 48);
  const CullView standard = view_through({.near = 1, .order = DepthOrder::standard}, 64, 48);
  const auto distance = [](int x, int y) { return std::exp2(1 + (x / 7 + y / 5) % 6); };
  const DepthImage a = depth_of(reversed, distance), b = depth_of(standard, distance);
  std::vector<CullLight> lights;  // clear of the bounds by far more than their widening
  for (int i = 0; i < 60; ++i) lights.push_back(point({i % 9 - 4, i % 7 - 3, -1.37 * std::exp2(i % 6)}, 0.61 + i % 5));
  for (const CullView& view : {reversed, standard}) c.bounds(view, &view == &reversed ? a : a, tile_of(16), false);
  c.bounds(standard, b, tile_of(16), false);
  const HostGrid ga = c.pixels(reversed, lights, a, every_mode()), gb = c.pixels(standard, lights, b, every_mode());
  c.that(ga == gb, "reversed and standard depth give two grids");
}

void endless_far(Check& c) {
  const CullView view = view_through({.near = 0.1}, 64, 48);
  for (const float least : {1e-45f, 1e-38f, 1.17549435e-38f, 1e-20f}) {
    DepthImage depth = depth_of(view, [](int, int) { return 5.0; });
    for (int x = 0; x < 64; x += 3) depth.values[size_t(x) * 17] = least;
    const auto found = c.bounds(view, depth, tile_of(16), false);
    for (const DepthInterval& b : found) c.that(std::isfinite(b.near) && std::isfinite(b.far), "[{}, {}]", b.near, b.far);
    c.pixels(view, {point({0, 0, -5}, 1), point({0, 0, -1e17}, 1e18)}, depth, every_mode());
  }
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
    c.pixels(view, {point({0, 0, -100}, 1), point({-60, 0, -99.5}, 30), point({0, 0, -60}, 5)}, depth, every_mode());
  }
}

void at_near_plane(Check& c) {
  for (const DepthOrder order : {DepthOrder::reversed, DepthOrder::standard}) {
    const CullView view = view_through({.near = 0.5, .order = order}, 64, 48);
    DepthImage depth = depth_of(view, [](int, int) { return 0.5; });
    c.bounds(view, depth, tile_of(16), false);
    c.pixels(view, {point({0, 0, 0}, 0.55), point({0, 0, -1}, 0.55), point({0.4, 0.4, -0.5}, 0.01)}, depth, every_mode());
  }
}

// Before and behind the surface of every seventh pixel, just reaching it.
std::vector<CullLight> lights_reaching(const CullView& view, const DepthImage& depth) {
  std::vector<CullLight> lights;
  int seen = 0;
  for (const CullLight& on : light_at_each(view, depth, 1)) {
    if (seen++ % 7) continue;
    for (const double side : {-1.0, 1.0}) {
      const double d = -on.position.z, r = d * std::exp2(-2.0 * (1 + lights.size() % 6));
      lights.push_back(point(on.position + glm::dvec3(0, 0, side * r * (1 - 1e-6)), r));
    }
  }
  return lights;
}

void flat_wall(Check& c) {
  for (const double d : {0.7, 5.0, 1000.0}) {
    const DepthImage depth = depth_of(sixty(), [&](int, int) { return d; });
    const auto lights = lights_reaching(sixty(), depth);
    c.bounds(sixty(), depth, tile_of(16));
    c.pixels(sixty(), lights, depth, every_mode());
  }
}

// Surfaces on each of the 33 edges of the mask's bins: in an orthographic view they are exact.
void on_mask_edges(Check& c) {
  const CullView box = view_through({.half_x = 4, .half_y = 3, .near = 0, .far = 64, .orthographic = true}, 64, 48);
  for (const CullView& view : {box, sixty()}) {
    const DepthImage depth = depth_of(view, [](int x, int y) { return 1.0 + (x + 7 * y) % 33; });
    c.pixels(view, light_at_each(view, depth, 1e-6), depth, every_mode());
    c.pixels(view, light_at_each(view, depth, 1e-6), depth, every_mode(8));
  }
}

void at_the_farthest(Check& c) {
  const DepthImage depth = depth_of(sixty(), [](int x, int y) { return (x + y) % 16 ? 3.0 : 40.0; });
  c.pixels(sixty(), lights_reaching(sixty(), depth), depth, every_mode());
}

// Surfaces at both ends, in the very middle and one step of depth to either side of it.
void on_half_z(Check& c) {
  const CullView box = view_through({.half_x = 4, .half_y = 3, .near = 0, .far = 64, .orthographic = true}, 64, 48);
  for (const CullView& view : {box, sixty()}) {
    DepthImage depth = depth_of(view, [](int x, int y) { return (x + y) % 3 == 0 ? 2.0 : (x + y) % 3 == 1 ? 6.0 : 4.0; });
    const float middle = float(depth_at(view, 4.0));
    for (size_t i = 0; i < depth.values.size(); i += 5) {
      if (depth.values[i] == middle) depth.values[i] = std::nextafter(middle, i % 2 ? 0.0f : 1.0f);
    }
    c.pixels(view, light_at_each(view, depth, 1e-6), depth, every_mode());
  }
}

// A post before a wall: no light lost; and lights in the gap are listed less by what knows of the gap.
void two_layers(Check& c) {
  const DepthImage depth = depth_of(sixty(), [](int x, int) { return x % 16 < 4 ? 2.0 : 30.0; });
  Random random(6);
  std::vector<CullLight> lights = light_at_each(sixty(), depth, 1e-4);
  for (int i = 0; i < 400; ++i) {
    const double d = random.uniform(6, 26);
    lights.push_back(point({random.uniform(-0.5f, 0.5f) * d, random.uniform(-0.4f, 0.4f) * d, -d}, 0.5));
  }
  c.pixels(sixty(), lights, depth, every_mode());
  const auto listed_by = [&](DepthBoundsMode mode) {
    CullerOptions options;
    options.depth_bounds = mode;
    return listed(c.engine.cull_depth(options, sixty(), lights, depth));
  };
  if (!c.engine.is_the_library()) return;
  const uint64_t minmax = listed_by(DepthBoundsMode::minmax);
  for (const DepthBoundsMode mode : {DepthBoundsMode::halfz_modified, DepthBoundsMode::mask32})
    c.that(listed_by(mode) < minmax, "mode {} lists as much as min/max does: {}", int(mode), minmax);
}

// Depth as a format of `steps` steps holds it (0: floats), near a surface whose true distance is known.
void low_precision(Check& c, const CullView& view, DepthFormat format, double steps) {
  Random random(7);
  std::vector<double> truth;
  DepthImage depth = depth_of(view, [&](int, int) {
    truth.push_back(std::exp2(random.uniform(-1, 9.9f)));
    return truth.back();
  });
  for (size_t i = 0; i < truth.size(); ++i) {
    const double exact = depth_at(view, truth[i]);
    depth.values[i] = float(steps > 0 ? std::round(exact * steps) / steps : exact);
    if (depth.values[i] == depth_of_nothing(view)) truth[i] = 0;  // rounded away: nothing is there
  }
  CullerOptions options;
  options.depth_format = format;
  for (const int tile : {8, 16}) {
    options.tile = tile;
    const auto found = c.engine.depth_bounds(options, view, depth);
    for (size_t i = 0; i < truth.size(); ++i) {
      if (truth[i] == 0) continue;
      const DepthInterval b = found[i / view.width / tile * tiles_x(view, tile) + i % view.width / tile];
      c.trials(1);
      if (b.near <= truth[i] && truth[i] <= b.far) continue;
      c.lost("tile {}: a surface at {:.9g} m is outside of [{:.9g}, {:.9g}]", tile, truth[i], b.near, b.far);
    }
  }
}

void every_lens(Check& c, DepthFormat format, double steps) {
  for (const DepthOrder order : {DepthOrder::reversed, DepthOrder::standard}) {
    low_precision(c, view_through({.near = 0.1, .far = 1000, .order = order}, 127, 73), format, steps);
    low_precision(c, view_through({.near = 0.1, .order = order}, 127, 73), format, steps);
    low_precision(c, view_through({.half_x = 9, .half_y = 9, .near = 0, .far = 1000, .orthographic = true,
                                   .order = order}, 127, 73), format, steps);
  }
}

void depth_of_16_bits(Check& c) { every_lens(c, DepthFormat::d16, 65535); }
void depth_of_24_bits(Check& c) { every_lens(c, DepthFormat::d24, 16777215); }
void depth_of_floats(Check& c) { every_lens(c, DepthFormat::d32f, 0); }

void several_samples(Check& c) {
  for (const int samples : {2, 4, 8}) {
    DepthImage depth;
    depth.samples = samples;
    for (int i = 0; i < 64 * 48 * samples; ++i) {
      const int pixel = i / samples, sample = i % samples;
      const bool odd = sample == 1 + pixel % (samples - 1);  // never the first: that one shows the middle everywhere
      const double d = !odd ? 10.0 : pixel / 7 % 2 ? 3.0 : 30.0;
      depth.values.push_back(pixel % 11 == 0 && !odd ? 0.0f : float(depth_at(sixty(), d)));
    }
    for (const int tile : {8, 16, 32, 64}) c.bounds(sixty(), depth, tile_of(tile));
    std::vector<CullLight> lights;
    for (const double d : {3.0, 10.0, 30.0}) {
      for (int i = 0; i < 25; ++i)
        lights.push_back(point({(i % 5 - 2) * d / 5, (i / 5 - 2) * d / 6, -d}, d / 20));
    }
    c.pixels(sixty(), lights, depth, every_mode());
  }
}

// Tile i shows one surface, in its pixel i.
void one_pixel_shows(Check& c) {
  const CullView view = field_of_view(60, 256, 256);
  const DepthImage depth = depth_of(view, [](int x, int y) {
    return x % 16 + y % 16 * 16 == x / 16 + y / 16 * 16 ? 7.0 : sky;
  });
  for (const int tile : {8, 16, 32, 64}) c.bounds(view, depth, tile_of(tile));
}

// In tile i the nearest surface is in pixel i and the farthest in another.
void extremes_anywhere(Check& c) {
  const CullView view = field_of_view(60, 256, 256);
  const DepthImage depth = depth_of(view, [](int x, int y) {
    const int tile = x / 16 + y / 16 * 16, pixel = x % 16 + y % 16 * 16;
    return pixel == tile ? 1.0 : pixel == (tile * 77 + 13) % 256 ? 50.0 : 7.0;
  });
  for (const int tile : {8, 16, 32, 64}) c.bounds(view, depth, tile_of(tile));
}

void blended_before_opaque(Check& c) {
  CullerOptions options;
  options.blend = true;
  const DepthImage depth = depth_of(sixty(), [](int x, int) { return x < 32 ? 20.0 : sky; });
  const std::vector<CullLight> lights = {point({-0.5, 0, -2}, 0.4), point({0.5, 0, -2}, 0.4), point({5, 0, -90}, 4),
                                         point({-5, 0, -90}, 4)};
  for (const DepthInterval& b : c.engine.depth_bounds(options, sixty(), depth, true))
    c.that(b.near <= 0.1f && b.far >= 20, "blended surfaces between [{}, {}] only", b.near, b.far);
  for (const KernelShape shape : {KernelShape::lanes, KernelShape::group}) {
    options.shape = shape;
    const HostGrid grid = c.engine.cull_depth(options, sixty(), lights, depth, true);
    const auto lists = [&](uint32_t light) { return std::count(grid.indices.begin(), grid.indices.end(), light) > 0; };
    c.that(lists(0) && lists(1), "a light before everything opaque is lost to the glass");
    c.that(lists(2), "a light behind the glass, with sky behind it, is lost");
    c.that(!lists(3), "a light behind a wall is listed for the glass before it");
  }
}

void bounds_none(Check& c) {
  CullerOptions options;
  options.depth_bounds = DepthBoundsMode::none;
  const DepthImage depth = depth_of(sixty(), [](int, int) { return 5.0; });
  const auto lights = std::vector<CullLight>{point({0, 0, -1}, 0.3), point({0, 0, -5}, 1), point({0, 0, -1e6}, 10)};
  const HostGrid grid = c.pixels(sixty(), lights, depth, {options});
  const HostGrid every = c.grid(sixty(), lights, {every_distance}, {options});
  c.that(grid == every, "without bounds the lists are not those of every distance");
}

// Random surfaces in every kind of view, under every mode and every cull test.
void scattered(Check& c) {
  for (const NamedView& named : hard_views(63, 41)) {
    Random random(8);
    const DepthImage depth = scattered_depth(named.view, random);
    auto lights = scattered_lights(named.view, 150, true, random);
    move_to_world(named.view, lights);
    std::vector<CullerOptions> settings = every_mode(8);
    for (const CullerOptions& options : c.every_test()) settings.push_back(options);
    settings.push_back(every_mode()[4]), settings.back().cull_test = CullTest::exact;
    c.pixels(named.view, lights, depth, settings);
  }
}

}  // namespace

std::vector<HardCase> depth_cases() {
  const char* g = "depth";
  return {
      {g, "all_sky", "nothing but sky", "max = far: every light is listed",
       "no list in any mode; blended surfaces keep theirs", all_sky},
      {g, "sky_beside_surface", "sky and a wall at 2 m in each tile", "an interval from 2 m to far",
       "sky is left out of the maximum", sky_beside_surface},
      {g, "empty_interval", "near > far, also by one ulp; lights of endless radius", "an inverted box accepts or rejects by accident",
       "an empty tile lists nothing", empty_interval},
      {g, "one_pixel_image", "1 × 1", "items that leave before a barrier hang; reads out of range", "as a plain scan; nothing lost",
       one_pixel_image},
      {g, "one_row_image", "17 × 1, 1 × 33", "the last tile's rows are read past the end", "as a plain scan; nothing lost",
       one_row_image},
      {g, "odd_size", "1279 × 721 cut from 1296 × 736", "partial tiles are dropped, or read past the image",
       "whole tiles as those of the larger image, partial ones as a plain scan", odd_size},
      {g, "viewport", "a rectangle within a larger depth image", "tiles counted from the image's corner (Bevy #5946)",
       "byte-equal to the rectangle cut out", viewport},
      {g, "nan_depth", "NaN of both signs among surfaces", "min and max depend on the order", "the tile spans every distance",
       nan_depth},
      {g, "infinite_depth", "±infinity among surfaces", "inf - inf", "the tile spans every distance", infinite_depth},
      {g, "negative_depth", "-0.5, -1e-45, -1e30", "integer minimum and maximum swap", "the tile spans every distance",
       negative_depth},
      {g, "minus_zero", "-0 among surfaces", "as an integer the greatest of all: hides the rest",
       "the surfaces beside it keep their lights", minus_zero},
      {g, "depth_above_one", "one ulp above 1; 1e30", "a distance before the near plane, or negative", "the tile spans every distance",
       depth_above_one},
      {g, "reversed_against_standard", "the same surfaces in both depths", "min and max swapped", "the same grid",
       reversed_against_standard},
      {g, "endless_far", "infinite far; depth 1e-45 … 1e-20", "division by almost zero: infinity, NaN", "bounds finite, surfaces inside",
       endless_far},
      {g, "denormal_depth", "surfaces whose depth is denormal", "flushed to 0: taken for sky", "nothing lost", denormal_depth},
      {g, "finite_far", "surfaces just before a far plane, and sky", "far and nothing confused", "surfaces inside, sky out",
       finite_far},
      {g, "at_near_plane", "every surface on the near plane", "rounded to before near and dropped", "nothing lost",
       at_near_plane},
      {g, "flat_wall", "zmin = zmax in every tile; lights tangent to it", "division by zero in a mask's bins", "nothing lost in any mode",
       flat_wall},
      {g, "on_mask_edges", "surfaces exactly on the 33 edges of the mask's bins", "surface and light fall in two bins",
       "nothing lost in any mode", on_mask_edges},
      {g, "at_the_farthest", "lights tangent to zmin and zmax", "z = zmax is bin 32: an undefined shift", "nothing lost in any mode",
       at_the_farthest},
      {g, "on_half_z", "surfaces in the very middle of the interval and a step beside", "neither half holds them",
       "nothing lost in any mode", on_half_z},
      {g, "two_layers", "a post before a wall, lights in the gap", "one interval holds the gap",
       "nothing lost; modified half-z and mask list fewer than min/max", two_layers},
      {g, "depth_of_16_bits", "D16, reversed and standard, perspective and orthographic", "a step is 180 m at 1 km",
       "bounds hold the true distance", depth_of_16_bits},
      {g, "depth_of_24_bits", "D24, the same", "a step is 0.6 m at 1 km", "bounds hold the true distance", depth_of_24_bits},
      {g, "depth_of_floats", "D32F, the same", "standard depth: as D24", "bounds hold the true distance", depth_of_floats},
      {g, "several_samples", "2, 4, 8 samples with a silhouette through each pixel", "one sample stands for all",
       "bounds hold every sample", several_samples},
      {g, "one_pixel_shows", "one surface a tile, in each of its pixels in turn", "a reduction that forgets a lane or an item",
       "as a plain scan", one_pixel_shows},
      {g, "extremes_anywhere", "nearest and farthest in each pair of pixels", "minima and maxima merged wrongly (Daemon #1734)",
       "as a plain scan", extremes_anywhere},
      {g, "blended_before_opaque", "glass at any distance before a wall and before sky", "the opaque interval leaves it dark",
       "from near to the farthest opaque, or without end", blended_before_opaque},
      {g, "bounds_none", "depth bounds switched off", "an interval not set", "the lists of every distance", bounds_none},
      {g, "scattered", "random surfaces in eight kinds of view", "some mode with some test in some view",
       "no pixel loses a light under any mode or test", scattered},
  };
}

}  // namespace lightgrid::verify
