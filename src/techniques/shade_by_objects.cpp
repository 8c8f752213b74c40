#include "techniques/shade_by_objects.h"

#include "passes/shade_forward.h"
#include "passes/shade_objects.h"

namespace lightgrid {

Frame shade_by_objects(RenderView& v, uint32_t lights_a_draw, bool own_apart) {
  const ObjectLights& objects = find_object_lights(v, v.caches.object_lights, find_surfaces(v).drawn);
  const ShadedImage image = shade_objects(v, objects, lights_a_draw, own_apart);
  shade_blended(v, image, find_blended_object_lights(v, v.caches.blended_object_lights));
  return {.image = image, .listed = [&v](auto&) { return listed_of_objects(v, v.caches.object_lights); }};
}

}  // namespace lightgrid
