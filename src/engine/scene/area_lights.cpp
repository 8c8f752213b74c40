#include "scene/area_lights.h"

#include <numbers>

#include "scene/light_axes.h"

namespace lightgrid {

// Fields of lights files; "light_area_width" and "light_area_height" in extras of glTF files.
static const Property<double> width{"area_width", 0, {.low = 0}}, height{"area_height", 0, {.low = 0}};

double width_of(const Light& light) { return width.of(light); }
double height_of(const Light& light) { return height.of(light); }

bool has_rectangle(const Light& light) {
  return has_cone(light) && !light.is_virtual && width.of(light) > 0 && height.of(light) > 0;
}

LightRectangle rectangle_of(const Light& light) {
  const LightAxes axes = axes_of(light);
  return {axes.right * (width.of(light) / 2), axes.up * (height.of(light) / 2), axes.direction};
}

void set_rectangle(Light& light, double width_m, double height_m) {
  light.type = LightType::spot;
  light.inner_cone_rad = light.outer_cone_rad = std::numbers::pi_v<float> / 2;
  width.set(light, width_m);
  height.set(light, height_m);
}

}  // namespace lightgrid
