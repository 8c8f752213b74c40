// Cameras, and the matrices of a view.
#pragma once

#include <optional>
#include <string>

#include "base/pixel_grid.h"
#include "scene/scene.h"

namespace lightgrid {

// A camera with an image size: the viewer, as culling and shading read it. View space is right-handed, looks
// along -z, y up. Clip space has depth zero to one, reversed: near at 1, far (or infinity) at 0.
struct View {
  int width = 0, height = 0;
  glm::dmat4 view_from_world{1};
  glm::dvec3 eye{
      0};  // world, exactly as the camera had it: view_from_world's translation is -rotation * eye, rounded
  glm::dmat4 clip_from_view{1};
  double near_m = 0.1;
  double far_m = std::numeric_limits<double>::infinity();
  bool orthographic = false;

  PixelGrid grid() const { return {width, height}; }
  bool operator==(const View&) const = default;
};

// The camera's vertical field is kept and the image's own aspect used (Camera::aspect and half_width_m are
// ignored). A camera matrix with scale, shear or mirroring is made rigid: direction first, then up. Throws
// Error(input) if field, near, far or matrix give no projection; an orthographic camera needs a finite far.
View make_view(const Camera& camera, int width, int height);

// Subtracts the eye in double before rotating, so that a scene and a camera moved together by an exact amount
// give the same bits; view_from_world * world_from_object does not.
glm::dmat4 view_from_object(const View& view, const glm::dmat4& world_from_object);

// A camera at `eye` that looks at `target` with y up (-z up if it looks straight up or down). Unnamed, 60
// degrees, near 0.1 m, far infinite.
Camera look_at(const glm::dvec3& eye, const glm::dvec3& target);

// NAME, INDEX or "eye:x,y,z,target:x,y,z,fov:deg,near:m" (fov vertical, default 60; near by default a
// thousandth of the scene's size, and at most 0.1 m). Empty: the scene's first camera, or, without one,
// room_camera, else overview_camera in an image of this aspect. Far is infinite unless the scene's camera has
// one. Throws Error(input) for an unknown name or form, an invalid number, a field outside
// 0..180 degrees, a near that is not above 0, and a target at the eye.
Camera choose_camera(const Scene& scene, const std::string& wish, double aspect = 1);

// A camera for scenes without one.
// From a corner above, 60 degrees high, as near as possible with every triangle in an image of this aspect
// (width / height) and a margin: the scene spans nine tenths of the image's width or height and is centred on
// both axes. The caller sets near and far. Without geometry it looks at the origin.
Camera overview_camera(const Scene& scene, double aspect);

// A person's eye in a room, along its greatest length, 60 degrees high; named "room". Walls are front faces
// on nearly all sides, at least 1.5 m away, over a level floor. None in a scene below 3 x 2 x 3 m, without
// such a place, of more than two million triangles, or if the room is the empty cavity of an object whose
// outer faces face out. The caller sets near and far.
std::optional<Camera> room_camera(const Scene& scene);

}  // namespace lightgrid
