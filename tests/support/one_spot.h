// A spot light at the eye that shines along the view.
#pragma once

#include "scene/view_lights.h"

namespace lightgrid {

inline Light spot_of(float inner, float outer) {
  return {.type = LightType::spot, .radius_m = 5, .inner_cone_rad = inner, .outer_cone_rad = outer};
}

inline ViewLight seen(const Light& light) {
  Scene scene;
  scene.lights = {light};
  return lights_in_view(scene, View())[0];
}

}  // namespace lightgrid
