// Where the coordinates of shadow rays have their origin.
#pragma once

#include "scene/scene.h"

namespace lightgrid {

inline constexpr double ray_origin_step_m = 64;  // rounds by 4e-6 m, far below a ray's gap

// World, metres. Floats are finest around it, so it lies where shadows are looked at: the median of the
// point and spot lights and the cameras, or of the instances in a scene without any. A minority of them
// cannot move it, however far away. It is a multiple of ray_origin_step_m, so that small movements leave it
// in place. Hidden lights count, so that lights that blink do too. More than 1000 lights, cameras or
// instances are sampled evenly.
glm::dvec3 ray_origin(const Scene& scene);

}  // namespace lightgrid
