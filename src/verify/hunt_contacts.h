// Lights made to reach one pixel's own position by a hair.
#pragma once

#include <optional>

#include "scene/scene.h"
#include "scene/view_lights.h"
#include "verify/hunt_views.h"

namespace lightgrid::verify {

// The point of a pixel that a light is made for: its position by the stored depth, in double.
struct HuntContact {
  uint32_t light = 0;  // index into HuntLights::lights
  uint16_t x = 0, y = 0, sample = 0;
  float in_x = 0.5f, in_y = 0.5f;  // where in the pixel: its centre, where only centres are shaded
};

struct HuntLights {
  std::vector<Light> lights;       // as a lights file can hold them: radius, direction and cone are floats
  std::vector<HuntContact> contacts;   // those that certainly are lit
};

// `count` lights, of which the view may want some elsewhere. The same for the same seed, for any number of threads.
HuntLights random_contacts(const HuntView& view, const HuntSetting& setting, size_t count, uint64_t seed);

// As the library takes them.
std::vector<CullLight> cull_lights(std::span<const Light> lights);

// View space, in double. None where no surface is.
std::optional<glm::dvec3> position_of(const HuntView& view, const HuntContact& contact);

// The oracle's: strictly nearer than the radius, and strictly within the cone.
bool is_lit_there(const HuntView& view, const Light& light, const glm::dvec3& position);

}  // namespace lightgrid::verify
