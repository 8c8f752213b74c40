// Instances as boxes in world space, and what of them a light may reach: for rules that leave out what no
// pixel shows. In double; no triangle is read.
#pragma once

#include <vector>

#include "scene/camera.h"
#include "scene/view_lights.h"

namespace lightgrid {

struct InstanceBox {
  glm::dvec3 min{std::numeric_limits<double>::infinity()}, max{-std::numeric_limits<double>::infinity()};
  int instance = 0;
  bool blended = false;
  // World axis across which all triangles lie in one plane, to the last bit. -1: none.
  int flat_axis = -1;
  double nearest_m = 0, farthest_m = 0;  // along the view's axis
  double longest_m = 0, sliver_m = 0;    // bounds on edges: of all triangles, of slivers (Mesh)
  double thinness = 16;                  // of a flat box: bound on edge over height of all but slivers
};

InstanceBox box_of(const Scene& scene, int instance, const View& view);
bool is_blended(const Scene& scene, int instance);

double distance_to(const InstanceBox& box, const glm::dvec3& point);
double farthest_from(const InstanceBox& box, const glm::dvec3& point);

// A light's bounds, grown by what rounding may move positions, and by the sphere's radius: segments to a
// sphere's points are no further than that from those to its centre.
struct GrownLightBounds {
  LightBounds light;
  double slack_m = 0, source_m = 0;

  GrownLightBounds grown(double by_m) const { return {light, slack_m + by_m, source_m}; }
};

bool may_reach(const GrownLightBounds& reach, const InstanceBox& box);

// How far a pixel's point P, within a light's reach, may lie from the triangle of an instance that it shows.
// Rasterisers move vertices to 1/256 pixel, by at most half of that along x and y. So the triangle has a
// point Q that, seen from the eye, is no farther than that from the pixel's centre: `across`.
//
// P lies on the ray through the centre, at a depth between those of the triangle's corners, as Q does
// (docs/raster.md; OpenGL 4.6, 14.6.1). So along the ray they differ by no more than the longest edge, at any
// angle. llvmpipe, whose planes go through unmoved vertices, exceeds that where it draws triangles that are
// narrower than 1/362 pixel.
//
// Flat instances have a tighter bound: P lies in the plane, which the ray meets at the angle a, so P and Q
// differ by at most across / sin(a). Rounded corners turn the plane, most of all that of slivers, which have
// only the first bound. Any other triangle has a height of at least edge / t and turns by at most 2 t e /
// edge if its corners err by e. If that is more than sin(a) / 2, its edge is shorter than 4 t e / sin(a).
//
// Depth is computed in float, with errors of up to 3 * 2^-21 of the greatest depth, that of the nearest
// corner: near / z0. At z that is 3 * 2^-21 z^2 / z0 along the view (docs/raster.md). `across` and this are
// doubled.
class PixelErrors {
 public:
  explicit PixelErrors(const View& view);
  double displaced_m(const GrownLightBounds& reach, const InstanceBox& box) const;

 private:
  double sine_at(const InstanceBox& box, double z) const;
  double along_m(const InstanceBox& box, double z, double across_m, double rounding_m) const;

  glm::dvec3 eye_, ahead_;
  bool orthographic_;
  double near_m_, widest_ = 1;  // greatest distance of a pixel's point, relative to that along the view
  double fixed_m_ = 0, across_ = 0,
         along_ = 0;  // metres, and those a metre and a metre^2 / metre of distance
};

}  // namespace lightgrid
