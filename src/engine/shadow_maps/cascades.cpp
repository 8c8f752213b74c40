#include <algorithm>
#include <cmath>

#include "shadow_maps/shadow_atlas.h"

namespace lightgrid {
namespace {

using glm::dvec3;

struct Sphere {
  dvec3 centre;  // view space
  double radius_m = 0;
};

// Around the part of the frustum between two distances: its size depends on them and on the projection alone.
Sphere around_part(const View& view, double near_m, double far_m) {
  const double x = 1 / view.clip_from_view[0][0], y = 1 / view.clip_from_view[1][1];
  const double slope = std::sqrt(x * x + y * y);  // slope of a corner
  const double near_r = view.orthographic ? slope : slope * near_m,
               far_r = view.orthographic ? slope : slope * far_m;
  // As far from a corner of the near end as from one of the far end, if that lies between the ends.
  const double along =
      std::clamp((far_m + near_m + (far_r * far_r - near_r * near_r) / (far_m - near_m)) / 2, near_m, far_m);
  return {{0, 0, -along}, std::hypot(far_m - along, far_r)};
}

// The end of part i of n: the mean of equal and of exponential parts.
double split_m(double near_m, double far_m, int i, int n) {
  const double share = double(i) / n;
  return (near_m * std::pow(far_m / near_m, share) + near_m + (far_m - near_m) * share) / 2;
}

}  // namespace

std::vector<ShadowFace> cascades_of(const Light& light, const View& view, const dvec3& origin,
                                    const WorldBox& box, int size, const ShadowMapOptions& options) {
  const dvec3 ahead = glm::normalize(dvec3(light.direction));
  const double far_m = std::max(std::min(glm::length(box.max - box.min), view.far_m), 2 * view.near_m);
  double first_m = HUGE_VAL, last_m = -HUGE_VAL;  // the box's extent along `ahead`
  for (int corner = 0; corner < 8; ++corner) {
    const dvec3 p(corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                  corner & 4 ? box.max.z : box.min.z);
    first_m = std::min(first_m, glm::dot(ahead, p - origin));
    last_m = std::max(last_m, glm::dot(ahead, p - origin));
  }
  const double margin_m = 1e-3 * (last_m - first_m) + 1e-3;
  first_m -= margin_m;
  last_m += margin_m;
  const glm::dmat3 world_from_view = glm::transpose(glm::dmat3(view.view_from_world));
  std::vector<ShadowFace> faces;
  for (int i = 0; i < options.cascades; ++i) {
    const Sphere sphere = around_part(view, split_m(view.near_m, far_m, i, options.cascades),
                                      split_m(view.near_m, far_m, i + 1, options.cascades));
    // Moving to whole texels takes up to half a texel of the side.
    ShadowFace face = shadow_face::towards(ahead, sphere.radius_m * size / (size - 2), size, options);
    const dvec3 right(face.right[0], face.right[1], face.right[2]), up(face.up[0], face.up[1], face.up[2]);
    const double texel_m = 2 * double(face.extent) / size;
    const dvec3 centre = view.eye - origin + world_from_view * sphere.centre;
    const auto whole = [&](const dvec3& axis) {
      return std::round(glm::dot(axis, centre) / texel_m) * texel_m;
    };
    shadow_face::set(face.from, right * whole(right) + up * whole(up) + ahead * first_m);
    face.range_m = float(last_m - first_m);
    face.parallel = 1;
    faces.push_back(face);
  }
  return faces;
}

}  // namespace lightgrid
