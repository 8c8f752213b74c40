// The exact value of a pixel: the mean of the radiance over its area, from 256 places, in double. The oracle
// of samples (docs/samples.md): rays find the surface at each place, whatever places a rasteriser has.
#pragma once

#include <span>
#include <vector>

#include "oracle/primary_rays.h"
#include "scene/light_ranges.h"

namespace lightgrid::lab {

inline constexpr int places_of_area = 256;

// For numbers 0 to 255: within the pixel, 0 to 1 from its lower left corner. Hammersley's points in base 2:
// each 256th of the pixel's area, of sides that are powers of two, has one. The share of them on one side of
// a line through the pixel's centre has an error of at most 3 / 256 (PlacesOfArea in oracle_tests).
glm::dvec2 place_of_area(int number);

struct PixelArea {
  glm::dvec3 radiance{0};
  // Radiance that lights add whose shadow turns on rounding: they count as seen. It bounds the error that
  // these decisions may have.
  glm::dvec3 doubt{0};
  glm::dvec3 spread{0};  // standard deviation of the places' radiance, over the root of their number
  // Its places see several surfaces, of which the background is one. Triangles of one instance that share an
  // edge by its vertices' numbers, and turn the same way on the screen, are one surface.
  bool at_edge = false;
  bool blended = false;    // some place sees a blended surface
  bool undecided = false;  // some light's shadow turns on rounding, at more than 1 in 100 places
};

// The surfaces at some of a pixel's places.
struct SeenSurfaces {
  int surfaces = 0;  // without the background; told apart as for at_edge above
  int covered = 0;   // places that see one
  int places = 0;
  bool at_edge() const { return surfaces > 1 || (surfaces == 1 && covered < places); }
};

class AreaOracle {
 public:
  // occlusion: null: no light casts. All outlive it, and do not move meanwhile. settings.hidden is not read.
  AreaOracle(const Scene& scene, const View& view, const LightRanges& ranges, const ShadeSettings& settings,
             const Occlusion* occlusion);
  AreaOracle(const AreaOracle&) = delete;  // its rays keep its views
  AreaOracle& operator=(const AreaOracle&) = delete;

  // Pixels are y * width + x, row 0 at the bottom. places: 1, 4, 16, 64 or 256; one lies 1/512 pixel from the centre in x and y. A
  // place's textures are filtered with the footprint of a 256th of the pixel's area. Blended surfaces are laid
  // over others in the order of their depths. Runs on all cores.
  std::vector<PixelArea> at(std::span<const uint32_t> pixels, int places = places_of_area) const;

  // From 2, 4, 8 or 16 places, as many of Hammersley's points.
  std::vector<SeenSurfaces> surfaces_at(std::span<const uint32_t> pixels, int places) const;

 private:
  struct Hit;
  struct Seen;
  struct NearLights;
  struct Shaded;
  Hit hit_of(const PrimaryRays::Hit& hit, const glm::ivec2& place) const;
  std::vector<Seen> seen_at(SceneSurfaces& surfaces, uint32_t pixel, int places) const;
  NearLights lights_near(const std::vector<Seen>& seen) const;
  Shaded shade_hit(const Hit& hit, SceneSurfaces& surfaces, NearLights& near) const;
  glm::dvec3 background_at(const glm::ivec2& place) const;
  void shade_area(PixelArea& area, SceneSurfaces& surfaces, const std::vector<Seen>& seen) const;

  const Scene& scene_;
  const View& view_;
  View of_surfaces_, of_places_;  // at 16 times the size, for textures, and at 256: a place is a centre there
  ShadeSettings settings_;
  const Occlusion* occlusion_;
  std::vector<ViewLight> lights_;
  PrimaryRays opaque_, blended_;
};

}  // namespace lightgrid::lab
