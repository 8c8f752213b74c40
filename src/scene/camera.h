// Which camera, and the matrices of a view through it.
#pragma once

#include <string>

#include "scene/scene.h"

namespace lightgrid {

// A camera with an image size: all that culling and shading know of the viewer. View space is right-handed,
// looks along -z, y up. Clip space has depth zero to one, reversed: near at 1, far (or infinity) at 0.
struct View {
  int width = 0, height = 0;
  glm::dmat4 view_from_world{1};
  glm::dmat4 clip_from_view{1};
  double near_m = 0.1;
  double far_m = std::numeric_limits<double>::infinity();
  bool orthographic = false;
};

View make_view(const Camera& camera, int width, int height);

// NAME, INDEX or "eye:x,y,z,target:x,y,z,fov:deg" (fov vertical, 60 where absent). Empty: the scene's first
// camera, or, without one, a camera that sees the whole scene. Throws Error(input) for a name or form unknown.
Camera choose_camera(const Scene& scene, const std::string& wish);

}  // namespace lightgrid
