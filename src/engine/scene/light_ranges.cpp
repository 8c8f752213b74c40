#include "scene/light_ranges.h"

#include <algorithm>
#include <array>
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

double min_falloff(const Light& light, const LightRanges& ranges) {
  const double intensity = brightest_intensity(light);
  return ranges.range == LightRange::stochastic && intensity > 0 ? ranges.alpha / intensity : 0;
}

double max_falloff(const Light& light) {
  constexpr double largest = 1e31;  // shared/punctual_light.h: LARGEST_ATTENUATION
  return 1 / std::max(double(light.nearest_m) * double(light.nearest_m), 1 / largest);
}

std::vector<Light> lights_with_ranges(const Scene& scene, const LightRanges& ranges) {
  std::vector<Light> lights = scene.lights;
  if (ranges.range == LightRange::scene) return lights;
  for (size_t i = 0; i < lights.size(); ++i) lights[i].radius_m = float(range_of(lights[i], i, ranges));
  return lights;
}

static std::vector<glm::dvec3> surface_points(const Scene& scene, size_t count) {
  struct Part {
    double area_until;
    const Instance* instance;
    size_t index;
  };
  std::vector<Part> parts;
  double area = 0;
  const auto corner = [&](const Instance& instance, size_t index) {
    const Mesh& mesh = scene.meshes[size_t(instance.mesh)];
    return glm::dvec3(instance.world_from_object * glm::dvec4(mesh.positions[mesh.indices[index]], 1));
  };
  for (const Instance& instance : scene.instances) {
    for (size_t i = 0; i + 2 < scene.meshes[size_t(instance.mesh)].indices.size(); i += 3) {
      const glm::dvec3 a = corner(instance, i);
      area += glm::length(glm::cross(corner(instance, i + 1) - a, corner(instance, i + 2) - a));
      parts.push_back({area, &instance, i});
    }
  }
  std::vector<glm::dvec3> points;
  if (!(area > 0) || !std::isfinite(area)) return points;
  for (size_t n = 0; n < count; ++n) {
    const double at = area * (double(n) + 0.5) / double(count);
    const auto part = std::ranges::lower_bound(parts, at, {}, &Part::area_until);
    double u = random_of(1, 2 * n), v = random_of(1, 2 * n + 1);
    if (u + v > 1) {
      u = 1 - u;
      v = 1 - v;
    }
    const glm::dvec3 a = corner(*part->instance, part->index);
    points.push_back(a + u * (corner(*part->instance, part->index + 1) - a) +
                     v * (corner(*part->instance, part->index + 2) - a));
  }
  return points;
}

namespace {

// Irradiance of the sampled lights at points on surfaces.
struct SampledIrradiance {
  std::vector<std::vector<double>> at_points;
  double lights = 0;  // sampled
  double stride = 1;  // every n-th of many
};

SampledIrradiance sampled_irradiance(const Scene& scene) {
  constexpr size_t count = 256, max_lights = 10'000;
  const std::vector<glm::dvec3> points = surface_points(scene, count);
  const size_t stride = scene.lights.size() / max_lights + 1;
  SampledIrradiance sampled{std::vector<std::vector<double>>(points.size()), 0, double(stride)};
  for (size_t i = 0; i < scene.lights.size(); i += stride) {
    const Light& light = scene.lights[i];
    if (is_directional(light)) continue;
    ++sampled.lights;
    for (size_t p = 0; p < points.size(); ++p) {
      const glm::dvec3 to = light.position - points[p];
      sampled.at_points[p].push_back(brightest_intensity(light) / std::max(glm::dot(to, to), 1e-4));
    }
  }
  return sampled;
}

CutoffEffect effect_of(double cutoff, const SampledIrradiance& sampled) {
  double reach = 0, share = 0;
  for (const std::vector<double>& at : sampled.at_points) {
    double kept = 0, sum = 0;
    for (const double irradiance : at) {
      sum += irradiance;
      if (irradiance <= cutoff) continue;
      const double squares = cutoff / irradiance;  // square of distance over range
      ++reach;
      kept += irradiance * (1 - squares * squares);
    }
    share += sum > 0 ? kept / sum : 1;
  }
  const auto points = double(sampled.at_points.size());
  return {cutoff, reach * sampled.stride / points, share / points};
}

}  // namespace

std::vector<CutoffEffect> helpful_cutoffs(const Scene& scene) {
  const SampledIrradiance sampled = sampled_irradiance(scene);
  if (sampled.at_points.empty()) return {};
  const double all = sampled.lights * sampled.stride, most = std::max(all / 8, 8.0);
  std::vector<CutoffEffect> gentle, found;  // the least cutoff first
  for (int step = 0; step <= 30 && found.empty(); ++step) {
    const double cutoff = std::array{1, 2, 5}[size_t(step % 3)] * std::pow(10, step / 3 - 4);
    const CutoffEffect effect = effect_of(cutoff, sampled);
    (effect.lights <= most ? found : gentle).push_back(effect);
  }
  if (found.empty() || found[0].share >= 0.9) return found;
  for (const double share : {0.7, 0.9}) {
    const auto largest =
        std::find_if(gentle.rbegin(), gentle.rend(), [&](const CutoffEffect& e) { return e.share >= share; });
    if (found[0].share >= share || largest == gentle.rend() || largest->lights > all * 2 / 3) continue;
    if (largest->cutoff < found.back().cutoff) found.push_back(*largest);
  }
  return found;
}

RangeWindow window_of(const LightRanges& ranges) {
  return ranges.range == LightRange::stochastic ? RangeWindow::none : ranges.window;
}

}  // namespace lightgrid
