// Where a point or spot light ends: the largest error of most renderers, since real lights end nowhere.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace lightgrid {

// scene: the range that the scene gives. cutoff: where irradiance falls to a given value. infinite: nowhere.
// stochastic: a random distance that makes the expected image that of infinite ranges (Tokuyoshi and Harada,
// Stochastic Light Culling, JCGT 2016).
enum class LightRange { scene, cutoff, stochastic, infinite };

// How a light fades towards its range, as a factor on 1 / d^2. khr: 1 - (d / range)^4 (KHR_lights_punctual).
// smooth: its square (Karis, Real Shading in Unreal Engine 4, 2013). none: 1, with a hard edge.
enum class RangeWindow { khr, smooth, none };

struct LightRanges {
  LightRange range = LightRange::scene;
  RangeWindow window = RangeWindow::khr;  // random ranges have none
  double cutoff =
      0.01;  // irradiance at the range: brightest channel of the radiant intensity over distance^2
  double alpha =
      0.01;  // a light whose irradiance at a point is f reaches it with the probability min(f / alpha, 1)
  uint32_t seed = 1;  // seed of the random ranges
  // Settings of effects that change how much of a light reaches surfaces, by key: the difference from the
  // default (SettingFlags::of_lights).
  std::map<std::string, uint64_t> effects{};
  bool operator==(const LightRanges&) const = default;
};

// Radiant intensity of the brightest channel.
double brightest_intensity(const Light& light);

// Metres, at least 0. `index`: of the light in its scene, which together with the seed determines a random
// range. 0 for a light without intensity, unless the scene's own ranges are meant; infinite for directional
// lights.
double range_of(const Light& light, size_t index, const LightRanges& ranges);

// A light that reaches a point with the probability p = min(f / alpha, 1) counts 1 / p times: f / p = max(f,
// alpha). This is alpha over the intensity, the least value of 1 / d^2 that shading uses within the light's
// range. 0: as it is.
double min_falloff(const Light& light, const LightRanges& ranges);

// The largest 1 / distance^2 of a virtual light, by its nearest_m. Finite.
double max_falloff(const Light& light);

// The scene's lights with their ranges as radius_m.
std::vector<Light> lights_with_ranges(const Scene& scene, const LightRanges& ranges);

// The effect of a cutoff on the point and spot lights at the scene's surfaces, without cones and directions:
// lights that reach a point on average, and the share of its light that a point keeps on average, with the
// window khr.
struct CutoffEffect {
  double cutoff = 0, lights = 0, share = 0;
};

// Returns the smallest of the cutoffs 0.0001, 0.0002, 0.0005, … 1000000 with which at most an eighth of the
// lights, or eight, reach a point on average. If it keeps less than 0.9 of the light, the largest cutoffs
// that keep 0.7 and 0.9 follow, provided that they leave two thirds of the lights or fewer. Largest cutoff
// first; empty without surfaces, or if no such cutoff is enough. Deterministic.
std::vector<CutoffEffect> helpful_cutoffs(const Scene& scene);

// The window that shading uses.
RangeWindow window_of(const LightRanges& ranges);

}  // namespace lightgrid
