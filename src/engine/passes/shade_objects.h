// Forward shading object by object.
#pragma once

#include "passes/find_object_lights.h"
#include "scene/listed_lights.h"

namespace lightgrid {

// Shades each object at the prepass' depth: base lighting replaces the image, then its lights are added in
// the order of their indices, `lights_a_draw` in each draw. own_apart: the first draw has none of them.
ShadedImage shade_objects(PassContext& work, const ObjectLights& objects, uint32_t lights_a_draw,
                          bool own_apart);

// The lights that the last frame of shade_objects used at each pixel. For the oracle, not part of a frame.
ListedLights listed_of_objects(PassContext& work, Cached<ObjectLights>& cache);

}  // namespace lightgrid
