// Hard cases of depth formats: what the depth buffer rounded away, and what orthographic views cancel.
#include <algorithm>
#include <cmath>

#include "verify/depth_images.h"

namespace lightgrid::verify {
namespace {

struct Format {
  DepthFormat format;
  double steps;  // 0: floats
};

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
  CullerOptions options;
  options.depth_format = format.format;
  for (const int tile : {8, 16}) {
    options.tile = tile;
    const auto found = c.engine.depth_bounds(options, view, depth);
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
  for (const CullLight& light : grazing_lights(view, depth, 300, true, random)) lights.push_back(light);
  std::vector<CullerOptions> modes = every_mode();
  for (CullerOptions& options : modes) options.depth_format = format.format;
  c.pixels(view, lights, depth, modes);
}

void in_every_lens(Check& c, const Format& format) {
  for (const CullView& view : every_lens(127, 73)) bounds_hold_true_distances(c, view, format);
  for (const CullView& view : every_lens(48, 32)) lists_hold_true_places(c, view, format);
}

constexpr Format d16{DepthFormat::d16, 65535}, d24{DepthFormat::d24, 16777215}, d32f{DepthFormat::d32f, 0};
void depth_of_16_bits(Check& c) { in_every_lens(c, d16); }
void depth_of_24_bits(Check& c) { in_every_lens(c, d24); }
void depth_of_floats(Check& c) { in_every_lens(c, d32f); }

// A tile with one surface: the interval contains it, and extends at most a step of the format and the slack
// to either side.
void position_from_depth_bounded(Check& c) {
  for (const Format& format : {d16, d24, d32f}) {
    for (const CullView& view : every_lens(64, 64)) {
      DepthImage depth = rounded_depth(view, format, 10);
      for (int i = 0; i < 64 * 64; ++i) {  // each tile shows what its first pixel does
        const int first = i / 64 / 8 * 8 * 64 + i % 64 / 8 * 8;
        depth.values[i] = depth.values[first], depth.distances[i] = depth.distances[first];
      }
      CullerOptions options = tile_of(8);
      options.depth_format = format.format;
      const auto found = c.engine.depth_bounds(options, view, depth);
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

std::vector<HardCase> depth_format_cases() {
  const char* group = "depth";
  return {
      CASE(depth_of_16_bits,
           "D16, reversed and standard, perspective and orthographic; lights at the surfaces' true positions",
           "a step is 180 m at 1 km; a mask uses the slot of the rounded depth",
           "bounds contain the true distance, lists the light, in every mode"),
      CASE(depth_of_24_bits, "D24, the same", "a step is 0.6 m at 1 km", "the same"),
      CASE(depth_of_floats, "D32F, the same", "standard depth: as D24", "the same"),
      {group, "position_from_depth", "tiles of one surface each, in each format, order and kind of view",
       "distances from depth off by more than a step of it",
       "the interval contains the surface and at most two steps to either side", position_from_depth_bounded},
      CASE(
          mask_around_the_eye,
          "orthographic, near plane 10³ and 10⁵ m behind the eye, far plane as far in front; surfaces around "
          "the eye on the mask's edges",
          "the distance is the difference of two large numbers", "nothing lost in any mode"),
  };
}

}  // namespace lightgrid::verify
