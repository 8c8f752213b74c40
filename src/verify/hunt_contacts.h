// Lights that barely reach one pixel's own position.
#pragma once

#include <optional>

#include "scene/scene.h"
#include "scene/view_lights.h"
#include "verify/hunt_views.h"

namespace lightgrid::verify {

// The point that a light is made to reach: a pixel's position from its depth, in double.
struct HuntContact {
  uint32_t light = 0;  // index into HuntLights::lights
  uint16_t x = 0, y = 0, sample = 0;
  float in_x = 0.5f, in_y = 0.5f;  // position in the pixel: its centre, if only centres are shaded
  float depth = 0;                 // as the depth buffer stores it, or of the blended surface before it
};

struct HuntLights {
  std::vector<Light> lights;  // as a lights file can store them: radius, direction and cone are floats
  std::vector<HuntContact> contacts;  // those that are certainly lit
};

// `count` lights; the view may place some elsewhere. Depends on the seed alone, not on the number of threads.
HuntLights random_contacts(const HuntView& view, const HuntSetting& setting, size_t count, uint64_t seed);

// As input of the library.
std::vector<CullLight> cull_lights(std::span<const Light> lights);

// View space, in double. Empty without a surface. Where the near plane is oblique, the depth of a pixel's
// only sample is that of its centre.
std::optional<glm::dvec3> position_of(const HuntView& view, const HuntContact& contact);

// According to the oracle: strictly nearer than the radius, and strictly within the cone.
bool is_lit_there(const HuntView& view, const Light& light, const glm::dvec3& position);

}  // namespace lightgrid::verify
