#include "scene/light_motion.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "scene/random.h"

namespace lightgrid {
namespace {

constexpr double turn_rad = 2 * std::numbers::pi;

// The radius of the orbit, and the amplitude of the drift along each axis.
double step_of(const Light& light) { return 0.2 * std::min(double(light.radius_m), 5.0); }

// 0 at time 0, within -2 to 2.
double swing(double seconds, double period_s, double phase_rad) {
  return std::sin(phase_rad + seconds * (turn_rad / period_s)) - std::sin(phase_rad);
}

glm::dvec3 orbit_offset(const Light& light, Random& random, double seconds) {
  const double period_s = random.uniform(4, 10);
  const double phase_rad = turn_rad * random.uniform();
  const double direction = random.uniform() < 0.5f ? -1 : 1;
  const double quarter_rad = turn_rad / 4;
  return step_of(light) * glm::dvec3(swing(direction * seconds, period_s, phase_rad + quarter_rad), 0,
                                     swing(direction * seconds, period_s, phase_rad));
}

glm::dvec3 drift_offset(const Light& light, Random& random, double seconds) {
  glm::dvec3 offset(0);
  for (int axis = 0; axis < 3; ++axis) {
    // Two periods without a short common multiple.
    const double slow_s = random.uniform(11, 23), fast_s = random.uniform(5, 9);
    const double slow_rad = turn_rad * random.uniform(), fast_rad = turn_rad * random.uniform();
    offset[axis] = 0.7 * swing(seconds, slow_s, slow_rad) + 0.3 * swing(seconds, fast_s, fast_rad);
  }
  return step_of(light) * offset;
}

}  // namespace

LightMotion light_motion(const std::string& name) {
  if (name == "none") return LightMotion::none;
  if (name == "orbit") return LightMotion::orbit;
  if (name == "drift") return LightMotion::drift;
  throw input_error("light-motion {}: not none, orbit or drift", name);
}

LightRig make_light_rig(const Scene& scene, LightMotion motion) {
  LightRig rig{motion, {}};
  for (const Light& light : scene.lights) rig.positions.push_back(light.position);
  return rig;
}

SceneChanges move_lights(Scene& scene, const LightRig& rig, double seconds) {
  assert(rig.positions.size() == scene.lights.size());
  if (!std::isfinite(seconds))
    throw input_error("{}: time {} is not a finite number of seconds", scene.name, seconds);
  SceneChanges changes;
  for (size_t i = 0; i < scene.lights.size(); ++i) {
    Light& light = scene.lights[i];
    if (light.type == LightType::directional || light.is_virtual || light.node >= 0 ||
        rig.motion == LightMotion::none)
      continue;
    Random random(Random::mix(uint64_t(i) + 1));
    const glm::dvec3 offset = rig.motion == LightMotion::orbit ? orbit_offset(light, random, seconds)
                                                               : drift_offset(light, random, seconds);
    const glm::dvec3 position = rig.positions[i] + offset;
    if (position == light.position) continue;
    light.position = position;
    changes.lights.push_back(int(i));
  }
  return changes;
}

}  // namespace lightgrid
