// Inputs of the hard cases: lights, most of them tangent to cells, the easiest ones to lose; depth images and
// intervals.
#pragma once

#include "scene/random.h"
#include "verify/views.h"

namespace lightgrid::lab::verify {

constexpr double sky = no_end;

// distance(x, y) in metres; sky: background.
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

enum class Contact { face, edge, corner, any };

// Each touches one of the cells with its surface, within `ulps` units in the last place of the radius (as a
// float) to either side; with 0, exactly or by the rounding of the radius upward. Small and huge, near and
// far; in view space.
std::vector<CullLight> tangent_lights(const CullView& view, std::span<const DepthInterval> bounds, int tile,
                                      size_t count, Contact contact, int ulps, Random& random);

// Spots whose cone touches a cell with its side: half-angles up to 90 degrees.
std::vector<CullLight> tangent_spots(const CullView& view, std::span<const DepthInterval> bounds, int tile,
                                     size_t count, Random& random);

// Lights that barely reach one pixel's own surface: by at most 2^-24 of the radius, down to 2^-10 of
// that. In view space; sizes from 2^-12 to 8 times the surface's distance. With `spots`, every second one is
// a spot whose side passes by the surface.
std::vector<CullLight> grazing_lights(const CullView& view, const DepthImage& depth, size_t count, bool spots,
                                      Random& random);

// The surface at a pixel, in view space; empty if there is none.
std::optional<glm::dvec3> surface_at(const CullView& view, const DepthImage& depth, int x, int y,
                                     int sample = 0);

// A light at each pixel that shows a surface, on it, in the pixels' order. Its radius is `share` of the
// surface's distance, which counts as at least 0.01 m. In view space.
std::vector<CullLight> lights_at_surfaces(const CullView& view, const DepthImage& depth, double share);

// All over the view and beyond, of sizes between a pixel and the whole image; with `spots`, every second one
// a spot.
std::vector<CullLight> scattered_lights(const CullView& view, size_t count, bool spots, Random& random);

// Thin, thick, endless, flat and empty cells.
std::vector<DepthInterval> scattered_bounds(const CullView& view, int tile, Random& random);

// Surfaces at distances from 0.3 to 100 m, with sky in places; for any kind of view.
DepthImage scattered_depth(const CullView& view, Random& random);

// Lights over surfaces, or over the intervals of tiles, in world space; the same for the same seed.
struct OverDepth {
  DepthImage depth;
  std::vector<CullLight> lights;
};
struct OverTiles {
  std::vector<DepthInterval> bounds;
  std::vector<CullLight> lights;
};
OverDepth scattered_over_depth(const CullView& view, size_t count, bool spots, uint64_t seed);
OverTiles scattered_over_tiles(const CullView& view, size_t count, bool spots,
                               uint64_t seed);  // tiles of 16 pixels
OverTiles tangent_over_tiles(const CullView& view, size_t count, Contact contact, uint64_t seed,
                             int ulps = 0);

void add(std::vector<CullLight>& lights, const std::vector<CullLight>& more);
CullLight point(const glm::dvec3& position, double radius);
CullLight spot(const glm::dvec3& position, const glm::dvec3& direction, double radius, double outer_deg);

constexpr DepthInterval every_distance{0.0f, 1e18f};
constexpr DepthInterval no_surface{1e18f, -1e18f};

}  // namespace lightgrid::lab::verify
