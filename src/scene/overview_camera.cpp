#include "scene/overview_camera.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/camera.h"

namespace lightgrid {
namespace {

constexpr double filled = 0.9;  // of the image's width or height

// The pyramid |x - eye.x| <= slope.x (eye.z - z), likewise for y, that contains all points and has the least
// eye.z. x and y share only eye.z: x + slope z <= eye.x + slope eye.z and -x + slope z <= -eye.x + slope
// eye.z hold for all points if they hold for the greatest left sides, whose sum bounds eye.z.
struct Fit {
  glm::dvec2 slope;
  glm::dvec2 greatest{-std::numeric_limits<double>::infinity()}, greatest_mirrored = greatest;
  double nearest = -std::numeric_limits<double>::infinity();

  void add(const glm::dvec3& p) {
    const glm::dvec2 across(p);
    greatest = glm::max(greatest, across + slope * p.z);
    greatest_mirrored = glm::max(greatest_mirrored, slope * p.z - across);
    nearest = std::max(nearest, p.z);
  }

  glm::dvec3 eye() const {
    const glm::dvec2 distance = (greatest + greatest_mirrored) / (2.0 * slope);
    return {(greatest - greatest_mirrored) / 2.0, std::max(distance.x, distance.y)};
  }
};

}  // namespace

Camera overview_camera(const Scene& scene, double aspect) {
  const WorldBox box = world_box(scene);
  const glm::dvec3 center = box.empty() ? glm::dvec3(0) : (box.min + box.max) / 2.0;
  Camera camera = look_at(center + glm::dvec3(0.62, 0.45, 0.78), center);
  camera.name = "overview";
  const glm::dmat3 world_from_view(camera.world_from_view), view_from_world = glm::transpose(world_from_view);
  const double slope = std::tan(camera.fov_y_rad / 2);
  Fit fit{filled * glm::dvec2(slope * aspect, slope)};
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[size_t(instance.mesh)];
    const glm::dmat3 rotated = view_from_world * glm::dmat3(instance.world_from_object);
    const glm::dvec3 moved = view_from_world * (glm::dvec3(instance.world_from_object[3]) - center);
    for (const uint32_t index : mesh.indices) fit.add(rotated * glm::dvec3(mesh.positions[index]) + moved);
  }
  // Without triangles, or with numbers that overflow double, looks from the box's corner.
  const double size = box.empty() ? 1 : glm::length(box.max - box.min);
  glm::dvec3 eye = fit.eye();
  if (!std::isfinite(eye.x) || !std::isfinite(eye.y) || !std::isfinite(eye.z))
    eye = {0, 0, std::isfinite(size) ? size : 1};
  // The eye may touch the model, whose corner then fills the image and hides the rest: keep a distance.
  const double scale = size > 0 && std::isfinite(size) ? size : 1;
  if (std::isfinite(fit.nearest)) eye.z = std::max(eye.z, fit.nearest + 0.05 * scale);
  camera.near_m = 1e-3 * scale;
  camera.world_from_view[3] = glm::dvec4(center + world_from_view * eye, 1);
  return camera;
}

}  // namespace lightgrid
