// Hard cases of depth bounds: every kind of them, several samples, blended surfaces. depth_formats.cpp has
// formats.
#include <algorithm>
#include <cmath>

#include "verify/depth_images.h"

namespace lightgrid::verify {
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
    const DepthImage depth = depth_of(sixty_degrees(), [&](int, int) { return d; });
    const auto lights = lights_reaching(sixty_degrees(), depth);
    c.bounds(sixty_degrees(), depth, tile_of(16));
    c.pixels(sixty_degrees(), lights, depth, every_mode());
  }
}

// Surfaces on each of the 33 edges of the mask's slots, which are exact in an orthographic view.
void on_mask_edges(Check& c) {
  const CullView box =
      view_through({.half_x = 4, .half_y = 3, .near = 0, .far = 64, .orthographic = true}, 64, 48);
  for (const CullView& view : {box, sixty_degrees()}) {
    const DepthImage depth = depth_of(view, [](int x, int y) { return 1.0 + (x + 7 * y) % 33; });
    c.pixels(view, lights_at_surfaces(view, depth, 1e-6), depth, every_mode());
    c.pixels(view, lights_at_surfaces(view, depth, 1e-6), depth, every_mode(8));
  }
}

void at_the_farthest(Check& c) {
  const DepthImage depth = depth_of(sixty_degrees(), [](int x, int y) { return (x + y) % 16 ? 3.0 : 40.0; });
  c.pixels(sixty_degrees(), lights_reaching(sixty_degrees(), depth), depth, every_mode());
}

// Surfaces at both ends, exactly in the middle and one step of depth to either side of it.
void on_half_z(Check& c) {
  const CullView box =
      view_through({.half_x = 4, .half_y = 3, .near = 0, .far = 64, .orthographic = true}, 64, 48);
  for (const CullView& view : {box, sixty_degrees()}) {
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
  const DepthImage depth = depth_of(sixty_degrees(), [](int x, int) { return x % 16 < 4 ? 2.0 : 30.0; });
  Random random(6);
  std::vector<CullLight> lights = lights_at_surfaces(sixty_degrees(), depth, 1e-4);
  for (int i = 0; i < 400; ++i) {
    const double d = random.uniform(6, 26);
    lights.push_back(point({random.uniform(-0.5f, 0.5f) * d, random.uniform(-0.4f, 0.4f) * d, -d}, 0.5));
  }
  c.pixels(sixty_degrees(), lights, depth, every_mode());
  const auto listed_by = [&](DepthBoundsMode mode) {
    CullerOptions options;
    options.depth_bounds = mode;
    return listed(c.engine.cull_depth(options, sixty_degrees(), lights, depth));
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
      depth.values.push_back(pixel % 11 == 0 && !odd ? 0.0f : float(depth_at(sixty_degrees(), d)));
    }
    c.bounds(sixty_degrees(), depth, tile_of(16));
    c.bounds(sixty_degrees(), depth, tile_of(tile));
    std::vector<CullLight> lights;
    for (const double d : {3.0, 10.0, 30.0}) {
      for (int i = 0; i < 25; ++i)
        lights.push_back(point({(i % 5 - 2) * d / 5, (i / 5 - 2) * d / 6, -d}, d / 20));
    }
    c.pixels(sixty_degrees(), lights, depth, samples == 4 ? every_mode() : std::vector{tile_of(16)});
  }
}

// Tile i shows one surface, in its pixel i.
void one_pixel_shows(Check& c) {
  const CullView view = field_of_view(60, 256, 256);
  const DepthImage depth =
      depth_of(view, [](int x, int y) { return x % 16 + y % 16 * 16 == x / 16 + y / 16 * 16 ? 7.0 : sky; });
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
  const DepthImage depth = depth_of(sixty_degrees(), [](int x, int) { return x < 32 ? 20.0 : sky; });
  const std::vector<CullLight> lights = {point({-0.5, 0, -2}, 0.4), point({0.5, 0, -2}, 0.4),
                                         point({5, 0, -90}, 4), point({-5, 0, -90}, 4)};
  for (const DepthInterval& b : c.engine.depth_bounds(options, sixty_degrees(), depth, true))
    c.that(b.near <= 0.1f && b.far >= 20, "blended surfaces between [{}, {}] only", b.near, b.far);
  for (const KernelShape shape : {KernelShape::lanes, KernelShape::group}) {
    options.shape = shape;
    const HostGrid grid = c.engine.cull_depth(options, sixty_degrees(), lights, depth, true);
    const auto lists = [&](uint32_t light) {
      return std::count(grid.indices.begin(), grid.indices.end(), light) > 0;
    };
    c.that(lists(0) && lists(1), "a light before everything opaque is lost to the glass");
    c.that(lists(2), "a light behind the glass, with sky behind it, is lost");
    c.that(!lists(3), "a light behind a wall is listed for the glass before it");
  }
}

void bounds_none(Check& c) {
  CullerOptions options;
  options.depth_bounds = DepthBoundsMode::none;
  const DepthImage depth = depth_of(sixty_degrees(), [](int, int) { return 5.0; });
  const auto lights =
      std::vector<CullLight>{point({0, 0, -1}, 0.3), point({0, 0, -5}, 1), point({0, 0, -1e6}, 10)};
  const HostGrid grid = c.pixels(sixty_degrees(), lights, depth, {options});
  const HostGrid every = c.grid(sixty_degrees(), lights, {every_distance}, {options});
  c.that(grid == every, "without bounds the lists are not those of every distance");
}

// Random surfaces in every kind of view, under every mode and every cull test.
void scattered(Check& c) {
  for (const NamedView& named : hard_views(63, 41)) {
    const auto [depth, lights] = scattered_over_depth(named.view, 150, true, 8);
    std::vector<CullerOptions> settings = every_mode(8);
    for (const CullerOptions& options : c.every_test()) settings.push_back(options);
    settings.emplace_back();
    settings.back().depth_bounds = DepthBoundsMode::mask32;
    settings.back().cull_test = CullTest::exact;
    c.pixels(named.view, lights, depth, settings);
  }
}

}  // namespace

std::vector<HardCase> depth_bounds_cases() {
  const char* group = "depth";
  return {
      CASE(flat_wall, "zmin = zmax in every tile; lights tangent to it", "division by zero in a mask's slots",
           "nothing lost in any mode"),
      CASE(on_mask_edges, "surfaces exactly on the 33 edges of the mask's slots",
           "surface and light fall in different slots", "nothing lost in any mode"),
      CASE(at_the_farthest, "lights tangent to zmin and zmax", "z = zmax is slot 32: an undefined shift",
           "nothing lost in any mode"),
      CASE(on_half_z, "surfaces exactly in the middle of the interval and one step beside",
           "neither half contains them", "nothing lost in any mode"),
      CASE(two_layers, "a post in front of a wall, lights in the gap", "one interval spans the gap",
           "nothing lost; modified half-z and mask list fewer than min/max"),
      CASE(several_samples, "2, 4, 8 samples with a silhouette through each pixel",
           "one sample represents all", "bounds contain every sample"),
      CASE(one_pixel_shows, "one surface a tile, in each of its pixels in turn",
           "a reduction skips a lane or an item", "as a plain scan"),
      CASE(extremes_anywhere, "nearest and farthest in each pair of pixels",
           "minima and maxima merged wrongly (Daemon #1734)", "as a plain scan"),
      CASE(blended_before_opaque, "glass at any distance in front of a wall and of sky",
           "the opaque interval leaves it dark", "from near to the farthest opaque surface, or to infinity"),
      CASE(bounds_none, "depth bounds switched off", "an uninitialised interval",
           "the lists of every distance"),
      CASE(scattered, "random surfaces in eight kinds of view", "a single combination of mode, test and view",
           "no pixel loses a light under any mode or test"),
  };
}

}  // namespace lightgrid::verify
