// The surfaces at a place on the screen, by rays in double: no rasteriser's coverage or depth.
#pragma once

#include <optional>
#include <vector>

#include "oracle/occlusion.h"
#include "oracle/scene_surfaces.h"

namespace lightgrid::lab {

enum class RayTargets { opaque, blended };  // opaque: with masked ones, where their mask lets them be seen

class PrimaryRays {
 public:
  // Both outlive it, and do not move meanwhile.
  PrimaryRays(const Scene& scene, const View& view, RayTargets targets = RayTargets::opaque);

  struct Hit {
    CastingTriangle triangle;
    TriangleInView in_view;
    double depth = 0;  // as the depth buffer has it, from 1 at the near plane down
  };
  // The nearest triangle that is drawn there. place: pixels from the lower left corner of the image, a
  // pixel's centre at .5. surfaces: a thread's own, of this scene and view, but of any size: masks are looked
  // up with the footprint of its pixels.
  std::optional<Hit> at(SceneSurfaces& surfaces, const glm::dvec2& place) const;
  // All triangles that are drawn there at this depth or nearer, the farthest first.
  std::vector<Hit> all_at(SceneSurfaces& surfaces, const glm::dvec2& place, double depth) const;

 private:
  std::array<uint32_t, 3> vertices_of(const CastingTriangle& t) const;
  std::optional<Hit> hit(SceneSurfaces& surfaces, const CastingTriangle& t, const glm::dvec2& place) const;
  template <typename Visit>
  void each_hit(SceneSurfaces& surfaces, const glm::dvec2& place, const Visit& visit) const;

  const Scene& scene_;
  const View& view_;
  std::vector<CastingTriangle> numbers_;
  TriangleTree tree_;
  double far_m_ = 1;
};

}  // namespace lightgrid::lab
