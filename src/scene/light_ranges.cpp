#include "scene/light_ranges.h"

#include <algorithm>
#include <cmath>

#include "scene/random.h"

namespace lightgrid {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

// (0, 1), the same on every machine.
double random_of(uint32_t seed, size_t index) {
  Random random(Random::mix((uint64_t(seed) << 32) ^ uint64_t(index)));
  return (double(random.next() >> 11) + 0.5) * 0x1p-53;
}

}  // namespace

double brightest_intensity(const Light& light) {
  return double(std::max({light.color.r, light.color.g, light.color.b})) * double(light.intensity);
}

double range_of(const Light& light, size_t index, const LightRanges& ranges) {
  if (light.type == LightType::directional) return infinite;
  switch (ranges.range) {
    case LightRange::scene:
      return light.radius_m;
    case LightRange::cutoff:
      return std::sqrt(brightest_intensity(light) / ranges.cutoff);
    case LightRange::stochastic:
      return std::sqrt(brightest_intensity(light) / (ranges.alpha * random_of(ranges.seed, index)));
    case LightRange::infinite:
      return brightest_intensity(light) > 0 ? infinite : 0;
  }
  return infinite;
}

double least_falloff(const Light& light, const LightRanges& ranges) {
  const double intensity = brightest_intensity(light);
  return ranges.range == LightRange::stochastic && intensity > 0 ? ranges.alpha / intensity : 0;
}

std::vector<Light> lights_with_ranges(const Scene& scene, const LightRanges& ranges) {
  std::vector<Light> lights = scene.lights;
  if (ranges.range == LightRange::scene) return lights;
  for (size_t i = 0; i < lights.size(); ++i) lights[i].radius_m = float(range_of(lights[i], i, ranges));
  return lights;
}

RangeWindow window_of(const LightRanges& ranges) {
  return ranges.range == LightRange::stochastic ? RangeWindow::none : ranges.window;
}

}  // namespace lightgrid
