// Where the coordinates of shadow rays have their origin.
#pragma once

#include "scene/scene.h"

namespace lightgrid {

inline constexpr double ray_origin_step_m = 64;  // floats there are 4e-6 m apart, below any gap of a ray

// World, metres. Floats are finest around it, so it lies where shadows are looked at: the median of the
// point and spot lights and the cameras, of the instances in a scene without any. A minority of them cannot
// move it, however far away. It is a multiple of ray_origin_step_m, so that what moves a little leaves it.
// Of more than 1000 lights, cameras or instances every n-th counts.
glm::dvec3 ray_origin(const Scene& scene);

}  // namespace lightgrid
