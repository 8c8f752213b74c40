// A camera that sees all of a scene without one.
#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/camera.h"
#include "scene/hidden.h"

namespace lightgrid {
namespace {

constexpr double filled = 0.9;  // share of the image's width or height
constexpr double infinity = std::numeric_limits<double>::infinity();

// An instance's mesh in a space that is turned as the view, with the scene's centre as its origin.
struct Placed {
  const Mesh* mesh;
  glm::dmat3 turned;
  glm::dvec3 moved;
};

// The vertex of a triangle with the largest value. `value` is largest at a corner of any box. Instances
// whose box cannot exceed the largest value so far are skipped.
template <typename Value>
glm::dvec3 outermost(const std::vector<Placed>& instances, const Value& value) {
  glm::dvec3 found(0);
  double largest = -infinity;
  for (const Placed& placed : instances) {
    const auto point = [&](const glm::vec3& p) { return placed.turned * glm::dvec3(p) + placed.moved; };
    const auto corners = corners_of(placed.mesh->bounds);
    const bool may_exceed =
        std::ranges::any_of(corners, [&](const glm::dvec3& c) { return !(value(point(c)) <= largest); });
    if (!may_exceed) continue;
    for (const uint32_t index : placed.mesh->indices) {
      const glm::dvec3 p = point(placed.mesh->positions[index]);
      if (value(p) > largest) {
        largest = value(p);
        found = p;
      }
    }
  }
  return found;
}

// Where the image's margins left and right (axis 0) or below and above (axis 1) are equal, for an eye at this
// distance: p[axis] / depth is the eye's place with the slope of a vertex p, at both ends of the image.
// Each step solves for the two outermost vertices, until they stay the same.
double centred(const std::vector<Placed>& instances, int axis, double distance, double low, double high) {
  const auto depth = [&](const glm::dvec3& p) { return distance - p.z; };
  double at = (low + high) / 2;
  for (int step = 0; step < 40 && low < high; ++step) {
    const auto slope = [&](const glm::dvec3& p) {
      return depth(p) > 0 ? (p[axis] - at) / depth(p) : infinity;
    };
    const glm::dvec3 most = outermost(instances, slope);
    const glm::dvec3 least = outermost(
        instances, [&](const glm::dvec3& p) { return depth(p) > 0 ? (at - p[axis]) / depth(p) : infinity; });
    const double excess = slope(most) + slope(least);
    (excess > 0 ? low : high) = at;
    const double solved =
        (most[axis] / depth(most) + least[axis] / depth(least)) / (1 / depth(most) + 1 / depth(least));
    if (std::abs(solved - at) <= 1e-9 * distance) break;
    at = solved > low && solved < high ? solved : (low + high) / 2;
  }
  return at;
}

// The eye of the pyramid |x - eye.x| <= slope.x (eye.z - z), likewise for y, that contains all vertices and
// has the least eye.z, but stays `margin` in front of them. x and y share only eye.z: x + slope z <= eye.x +
// slope eye.z and -x + slope z <= -eye.x + slope eye.z hold for all vertices if they hold for the greatest
// left sides, whose sum bounds eye.z.
glm::dvec3 fitted_eye(const std::vector<Placed>& instances, const glm::dvec2& slope, double margin) {
  glm::dvec2 greatest(0), greatest_mirrored(0);
  for (int axis = 0; axis < 2; ++axis) {
    const auto right = [&](const glm::dvec3& p) { return p[axis] + slope[axis] * p.z; };
    const auto left = [&](const glm::dvec3& p) { return slope[axis] * p.z - p[axis]; };
    greatest[axis] = right(outermost(instances, right));
    greatest_mirrored[axis] = left(outermost(instances, left));
  }
  const glm::dvec2 far = (greatest + greatest_mirrored) / (2.0 * slope);
  const double nearest = outermost(instances, [](const glm::dvec3& p) { return p.z; }).z;
  const double distance = std::max({far.x, far.y, nearest + margin});
  glm::dvec3 eye(0, 0, distance);
  for (int axis = 0; axis < 2 && std::isfinite(distance); ++axis)
    eye[axis] = centred(instances, axis, distance, greatest[axis] - slope[axis] * distance,
                        slope[axis] * distance - greatest_mirrored[axis]);
  return eye;
}

}  // namespace

Camera overview_camera(const Scene& scene, double aspect) {
  const WorldBox box = world_box(scene);
  const glm::dvec3 center = box.empty() ? glm::dvec3(0) : (box.min + box.max) / 2.0;
  Camera camera = look_at(center + glm::dvec3(0.62, 0.45, 0.78), center);
  camera.name = "overview";
  const glm::dmat3 world_from_view(camera.world_from_view), view_from_world = glm::transpose(world_from_view);
  std::vector<Placed> instances;
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[size_t(instance.mesh)];
    if (mesh.indices.empty() || is_hidden(instance)) continue;
    instances.push_back({&mesh, view_from_world * glm::dmat3(instance.world_from_object),
                         view_from_world * (glm::dvec3(instance.world_from_object[3]) - center)});
  }
  // Without triangles, or with numbers that overflow double, looks from the box's corner.
  const double size = box.empty() ? 0 : glm::length(box.max - box.min);
  const double scale = size > 0 && std::isfinite(size) ? size : 1;
  glm::dvec3 eye(0, 0, scale);
  if (!instances.empty()) {
    // The eye may touch the model, whose corner then fills the image and hides the rest: keep a distance.
    const double slope = std::tan(camera.fov_y_rad / 2);
    const glm::dvec3 fitted = fitted_eye(instances, filled * glm::dvec2(slope * aspect, slope), 0.05 * scale);
    if (std::isfinite(fitted.x + fitted.y + fitted.z)) eye = fitted;
  }
  camera.near_m = 1e-3 * scale;
  camera.world_from_view[3] = glm::dvec4(center + world_from_view * eye, 1);
  return camera;
}

}  // namespace lightgrid
