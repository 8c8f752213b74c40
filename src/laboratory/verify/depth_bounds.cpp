// Hard cases of depth bounds: every kind of them, several samples, blended surfaces; and of formats: what the
// depth buffer rounded away, and what orthographic views cancel.
#include <algorithm>
#include <cmath>

#include "plan/settings/samples.h"
#include "shared/cull_tests.h"
#include "verify/check.h"

namespace lightgrid::lab::verify {
namespace {

// In front of and behind the surface of every seventh pixel, just reaching it.
std::vector<CullLight> lights_reaching(const CullView& view, const DepthImage& depth) {
  std::vector<CullLight> lights;
  int seen = 0;
  for (const CullLight& on : lights_at_surfaces(view, depth, 1)) {
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
    const DepthImage depth = depth_of(small_sixty(), [&](int, int) { return d; });
    const auto lights = lights_reaching(small_sixty(), depth);
    c.bounds(small_sixty(), depth, {});
    c.pixels(small_sixty(), lights, depth, every_mode());
  }
}

// Surfaces on each of the 33 edges of the mask's slots, which are exact in an orthographic view.
void on_mask_edges(Check& c) {
  const CullView box =
      view_through({.half_x = 4, .half_y = 3, .near = 0, .far = 64, .orthographic = true}, 64, 48);
  for (const CullView& view : {box, small_sixty()}) {
    const DepthImage depth = depth_of(view, [](int x, int y) { return 1.0 + (x + 7 * y) % 33; });
    c.pixels(view, lights_at_surfaces(view, depth, 1e-6), depth, every_mode());
    c.pixels(view, lights_at_surfaces(view, depth, 1e-6), depth, every_mode(8));
  }
}

void at_the_farthest(Check& c) {
  const DepthImage depth = depth_of(small_sixty(), [](int x, int y) { return (x + y) % 16 ? 3.0 : 40.0; });
  c.pixels(small_sixty(), lights_reaching(small_sixty(), depth), depth, every_mode());
}

// Surfaces at both ends, exactly in the middle and one step of depth to either side of it.
void on_half_z(Check& c) {
  const CullView box =
      view_through({.half_x = 4, .half_y = 3, .near = 0, .far = 64, .orthographic = true}, 64, 48);
  for (const CullView& view : {box, small_sixty()}) {
    DepthImage depth = depth_of(view, [](int x, int y) {
      return (x + y) % 3 == 0 ? 2.0 : (x + y) % 3 == 1 ? 6.0 : 4.0;
    });
    const float middle = float(depth_at(view, 4.0));
    for (size_t i = 0; i < depth.values.size(); i += 5) {
      if (depth.values[i] == middle) depth.values[i] = std::nextafter(middle, i % 2 ? 0.0f : 1.0f);
    }
    c.pixels(view, lights_at_surfaces(view, depth, 1e-6), depth, every_mode());
  }
}

// A post in front of a wall: no light may be lost, and modes that exclude the gap must list fewer lights in
// it.
void two_layers(Check& c) {
  const DepthImage depth = depth_of(small_sixty(), [](int x, int) { return x % 16 < 4 ? 2.0 : 30.0; });
  Random random(6);
  std::vector<CullLight> lights = lights_at_surfaces(small_sixty(), depth, 1e-4);
  for (int i = 0; i < 400; ++i) {
    const double d = random.uniform(6, 26);
    lights.push_back(point({random.uniform(-0.5f, 0.5f) * d, random.uniform(-0.4f, 0.4f) * d, -d}, 0.5));
  }
  c.pixels(small_sixty(), lights, depth, every_mode());
  const auto listed_by = [&](DepthBoundsMode mode) {
    return c.engine.cull_depth({.depth_bounds = mode}, small_sixty(), lights, depth).indices.size();
  };
  if (!c.engine.is_the_library()) return;
  const uint64_t minmax = listed_by(DepthBoundsMode::minmax);
  for (const DepthBoundsMode mode : {DepthBoundsMode::halfz_modified, DepthBoundsMode::mask32})
    c.that(listed_by(mode) < minmax, "mode {} lists as much as min/max does: {}", int(mode), minmax);
}

// Each number of samples in two sizes of tile, and one of them in every mode: each combination is a kernel of
// its own.
void several_samples(Check& c) {
  struct Reduction {
    int samples, tile;
  };
  for (const auto& [samples, tile] : {Reduction{2, 64}, Reduction{4, 32}, Reduction{8, 8}}) {
    DepthImage depth;
    depth.samples = samples;
    for (int i = 0; i < 64 * 48 * samples; ++i) {
      const int pixel = i / samples, sample = i % samples;
      const bool odd = sample == 1 + pixel % (samples - 1);  // never the first, which shows the middle
                                                             // everywhere
      const double d = !odd ? 10.0 : pixel / 7 % 2 ? 3.0 : 30.0;
      depth.values.push_back(pixel % 11 == 0 && !odd ? 0.0f : float(depth_at(small_sixty(), d)));
    }
    c.bounds(small_sixty(), depth, {});
    c.bounds(small_sixty(), depth, {.tile = tile});
    std::vector<CullLight> lights;
    for (const double d : {3.0, 10.0, 30.0}) {
      for (int i = 0; i < 25; ++i)
        lights.push_back(point({(i % 5 - 2) * d / 5, (i / 5 - 2) * d / 6, -d}, d / 20));
    }
    c.pixels(small_sixty(), lights, depth,
             samples == 4 ? every_mode() : std::vector<CullerOptions>{CullerOptions{}});
  }
}

// Tile i shows one surface, in its pixel i.
void one_pixel_shows(Check& c) {
  const CullView view = field_of_view(60, 256, 256);
  const DepthImage depth =
      depth_of(view, [](int x, int y) { return x % 16 + y % 16 * 16 == x / 16 + y / 16 * 16 ? 7.0 : sky; });
  for (const CullerOptions& options : every_tile()) c.bounds(view, depth, options);
}

// In tile i the nearest surface is in pixel i and the farthest in another.
void extremes_anywhere(Check& c) {
  const CullView view = field_of_view(60, 256, 256);
  const DepthImage depth = depth_of(view, [](int x, int y) {
    const int tile = x / 16 + y / 16 * 16, pixel = x % 16 + y % 16 * 16;
    return pixel == tile ? 1.0 : pixel == (tile * 77 + 13) % 256 ? 50.0 : 7.0;
  });
  for (const CullerOptions& options : every_tile()) c.bounds(view, depth, options);
}

void blended_before_opaque(Check& c) {
  CullerOptions options{.blend = true};
  const DepthImage depth = depth_of(small_sixty(), [](int x, int) { return x < 32 ? 20.0 : sky; });
  const std::vector<CullLight> lights = {point({-0.5, 0, -2}, 0.4), point({0.5, 0, -2}, 0.4),
                                         point({5, 0, -90}, 4), point({-5, 0, -90}, 4)};
  for (const DepthInterval& b : c.engine.depth_bounds(options, small_sixty(), depth, true))
    c.that(b.near <= 0.1f && b.far >= 20, "blended surfaces between [{}, {}] only", b.near, b.far);
  for (const KernelShape shape : {KernelShape::lanes, KernelShape::group}) {
    options.shape = shape;
    const HostGrid grid = c.engine.cull_depth(options, small_sixty(), lights, depth, true);
    const auto lists = [&](uint32_t light) {
      return std::count(grid.indices.begin(), grid.indices.end(), light) > 0;
    };
    c.that(lists(0) && lists(1), "a light before everything opaque is lost to the glass");
    c.that(lists(2), "a light behind the glass, with sky behind it, is lost");
    c.that(!lists(3), "a light behind a wall is listed for the glass before it");
  }
}

void bounds_none(Check& c) {
  const CullerOptions options{.depth_bounds = DepthBoundsMode::none};
  const DepthImage depth = depth_of(small_sixty(), [](int, int) { return 5.0; });
  const auto lights =
      std::vector<CullLight>{point({0, 0, -1}, 0.3), point({0, 0, -5}, 1), point({0, 0, -1e6}, 10)};
  const HostGrid grid = c.pixels(small_sixty(), lights, depth, {options});
  const HostGrid every = c.grid(small_sixty(), lights, {every_distance}, {options});
  c.that(grid == every, "without bounds the lists are not those of every distance");
}

// Random surfaces in every kind of view, under every mode and every cull test.
void scattered(Check& c) {
  for (const NamedView& named : hard_views(63, 41)) {
    const auto [depth, lights] = scattered_over_depth(named.view, 150, true, 8);
    std::vector<CullerOptions> settings = every_mode(8);
    for (const CullerOptions& options : every_test()) settings.push_back(options);
    settings.push_back({.cull_test = CullTest::exact, .depth_bounds = DepthBoundsMode::mask32});
    c.pixels(named.view, lights, depth, settings);
  }
}

struct Format {
  DepthFormat format;
  double steps;  // 0: floats
};

constexpr Format d16{DepthFormat::d16, 65535}, d24{DepthFormat::d24, 16777215}, d32f{DepthFormat::d32f, 0};

// Surfaces at known distances, as a depth buffer of that format stores them.
DepthImage rounded_depth(const CullView& view, const Format& format, uint64_t seed) {
  Random random(seed);
  DepthImage depth;
  for (int i = 0; i < view.width * view.height; ++i) {
    const double distance = std::exp2(random.uniform(-1, 9.9f)), exact = depth_at(view, distance);
    const double rounded = format.steps > 0 ? std::round(exact * format.steps) / format.steps : exact;
    depth.distances.push_back(distance);
    depth.values.push_back(float(rounded));
  }
  return depth;
}

std::vector<CullView> every_lens(int width, int height) {
  std::vector<CullView> views;
  for (const DepthOrder order : {DepthOrder::reversed, DepthOrder::standard}) {
    views.push_back(view_through({.near = 0.1, .far = 1000, .order = order}, width, height));
    views.push_back(view_through({.near = 0.1, .order = order}, width, height));
    views.push_back(
        view_through({.half_x = 9, .half_y = 9, .near = 0, .far = 1000, .orthographic = true, .order = order},
                     width, height));
  }
  return views;
}

void bounds_hold_true_distances(Check& c, const CullView& view, const Format& format) {
  const DepthImage depth = rounded_depth(view, format, 7);
  for (const int tile : {8, 16}) {
    const auto found = c.engine.depth_bounds({.tile = tile, .depth_format = format.format}, view, depth);
    for (size_t i = 0; i < depth.values.size(); ++i) {
      if (depth.values[i] == depth_of_nothing(view)) continue;  // rounded to background
      const DepthInterval b = found[i / view.width / tile * tiles_x(view, tile) + i % view.width / tile];
      const double d = depth.distances[i];
      c.trials(1);
      if (b.near <= d && d <= b.far) continue;
      c.lost("tile {}: a surface at {:.9g} m is outside of [{:.9g}, {:.9g}]", tile, d, b.near, b.far);
    }
  }
}

// Lights at the surfaces' true positions, and lights that just reach one, in every mode.
void lists_hold_true_places(Check& c, const CullView& view, const Format& format) {
  const DepthImage depth = rounded_depth(view, format, 8);
  Random random(9);
  std::vector<CullLight> lights = lights_at_surfaces(view, depth, 1e-5);
  add(lights, grazing_lights(view, depth, 300, true, random));
  std::vector<CullerOptions> modes = every_mode();
  for (CullerOptions& options : modes) options.depth_format = format.format;
  c.pixels(view, lights, depth, modes);
}

void in_every_lens(Check& c, const Format& format) {
  for (const CullView& view : every_lens(127, 73)) bounds_hold_true_distances(c, view, format);
  for (const CullView& view : every_lens(48, 32)) lists_hold_true_places(c, view, format);
}
void depth_of_16_bits(Check& c) { in_every_lens(c, d16); }
void depth_of_24_bits(Check& c) { in_every_lens(c, d24); }
void depth_of_floats(Check& c) { in_every_lens(c, d32f); }

// A tile with one surface: the interval contains it, and extends at most a step of the format and the slack
// to either side.
void position_from_depth(Check& c) {
  for (const Format& format : {d16, d24, d32f}) {
    for (const CullView& view : every_lens(64, 64)) {
      DepthImage depth = rounded_depth(view, format, 10);
      for (int i = 0; i < 64 * 64; ++i) {  // each tile shows what its first pixel does
        const int first = i / 64 / 8 * 8 * 64 + i % 64 / 8 * 8;
        depth.values[i] = depth.values[first];
        depth.distances[i] = depth.distances[first];
      }
      const auto found = c.engine.depth_bounds({.tile = 8, .depth_format = format.format}, view, depth);
      for (int tile = 0; tile < 64; ++tile) {
        const int pixel = tile / 8 * 8 * 64 + tile % 8 * 8;
        const double value = depth.values[pixel], d = depth.distances[pixel];
        const double step = format.steps > 0           ? 1 / format.steps
                            : has_standard_depth(view) ? 0x1p-24
                                                       : 0x1p-23 * value;
        if (value == depth_of_nothing(view) || value - 2 * step <= 0 || value + 2 * step >= 1) continue;
        const DepthInterval b = found[tile];
        c.trials(1);
        if (!(b.near <= d && d <= b.far))
          c.lost("a surface at {:.9g} m is outside of [{:.9g}, {:.9g}]", d, b.near, b.far);
        const double ends[] = {distance_at(view, value - 2 * step), distance_at(view, value + 2 * step)};
        const double more =
            32 * 0x1p-24 * (is_orthographic(view) ? std::abs(distance_at(view, 0)) + std::abs(d) : d);
        c.that(b.near >= std::min(ends[0], ends[1]) - more && b.far <= std::max(ends[0], ends[1]) + more,
               "a surface at {:.9g} m is within [{:.9g}, {:.9g}], wider than two steps of depth", d, b.near,
               b.far);
      }
    }
  }
}

// The eye is inside a long box, with surfaces around it: the distance there is the difference of two large
// numbers. Surfaces lie on the edges of the mask's slots and a few steps of depth beside them; lights just
// reach one each.
void mask_around_the_eye(Check& c) {
  for (const double reach : {1e3, 1e5}) {
    for (const double ahead : {1.0, 1.3, 0.37, 2.9}) {
      const double half = reach / 1000;
      const CullView view = view_through(
          {.half_x = half, .half_y = half, .near = -reach, .far = ahead * reach, .orthographic = true}, 32,
          32);
      const DepthImage depth = depth_of(view, [&](int x, int y) {
        const int pixel = x % 16 + y % 16 * 16, step = (x / 16 + 2 * (y / 16)) + 4 * (pixel / 33);
        return pixel == 0   ? -half
               : pixel == 1 ? half
                            : half * ((pixel % 33) / 16.0 - 1) + (step - 16) * 0x1p-25 * reach;
      });
      std::vector<CullLight> lights;
      for (const CullLight& on : lights_at_surfaces(view, depth, 0)) {
        const double r = half / 1000;
        for (const double side : {-1.0, 1.0})
          lights.push_back(point(on.position + glm::dvec3(0, 0, side * r), r * (1 + 0x1p-30)));
      }
      c.pixels(view, lights, depth, every_mode());
    }
  }
}

}  // namespace

std::vector<CaseRun> depth_bounds_cases() {
  return CASES(flat_wall, on_mask_edges, at_the_farthest, on_half_z, two_layers, several_samples,
               one_pixel_shows, extremes_anywhere, blended_before_opaque, bounds_none, scattered,
               depth_of_16_bits, depth_of_24_bits, depth_of_floats, position_from_depth, mask_around_the_eye);
}

}  // namespace lightgrid::lab::verify
