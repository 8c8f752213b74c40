// What the hard cases of passes share: a scene of one wall, lights, and a perspective view. For passes of
// OpenCL alone.
#pragma once

#include "scene/builtin/compose.h"
#include "scene/camera.h"
#include "verify/views.h"

namespace lightgrid::verify {

// A wall of 8 x 8 m in front of an eye at the origin, oblique: 2 to 6 m away. It makes the plan and bounds
// volumes.
Scene wall_scene(const glm::dvec3& origin = glm::dvec3(0));

// The eye at the origin, looking along -z.
View eye_view(int width, int height, const glm::dvec3& origin = glm::dvec3(0));

// Hundreds of points and spots, some of them thin, in the space between the eye and the wall and around it.
void add_random_lights(Scene& scene, int count, uint64_t seed);

}  // namespace lightgrid::verify
