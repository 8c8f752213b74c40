#include "plan/coarse_shadows.h"

#include <fmt/format.h>

#include <algorithm>

#include "scene/hidden.h"
#include "scene/ray_origin.h"
#include "shared/shadow_records.h"

namespace lightgrid {
namespace {

double gap_at(double distance_m) { return double(SHADOW_GAP_M) + double(SHADOW_GAP_SHARE) * distance_m; }

bool is_coarse(double gap_m, double size_m) { return gap_m > 1e-2 && gap_m > 1e-3 * size_m; }

void count(double gap_m, int index, int& number, int& first, double& max_m) {
  if (number++ == 0) first = index;
  max_m = std::max(max_m, gap_m);
}

}  // namespace

CoarseShadows coarse_shadows(const Scene& scene, const LightRanges& ranges) {
  CoarseShadows coarse;
  const glm::dvec3 origin = ray_origin(scene);
  bool sun = false;
  for (size_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    if (!light.casts_shadow || is_hidden(light)) continue;
    if (is_directional(light)) {
      sun = true;
      continue;
    }
    const double gap_m = gap_at(glm::length(light.position - origin));
    if (is_coarse(gap_m, range_of(light, i, ranges)))
      count(gap_m, int(i), coarse.lights, coarse.first_light, coarse.gap_m);
  }
  for (size_t i = 0; sun && i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    const WorldBox box = world_box(scene.meshes[size_t(instance.mesh)], instance.world_from_object);
    if (box.empty() || is_hidden(instance)) continue;
    const double gap_m = gap_at(glm::length(glm::clamp(origin, box.min, box.max) - origin));
    if (is_coarse(gap_m, glm::length(box.max - box.min)))
      count(gap_m, int(i), coarse.instances, coarse.first_instance, coarse.gap_m);
  }
  return coarse;
}

std::string describe(const CoarseShadows& coarse, const Scene& scene) {
  std::string what;
  if (coarse.lights > 0)
    what = fmt::format("at {} light{} (the first: {} \"{}\")", coarse.lights, coarse.lights > 1 ? "s" : "",
                       coarse.first_light, scene.lights[size_t(coarse.first_light)].name);
  if (coarse.instances > 0)
    what += fmt::format("{}on {} instance{} (the first: {} \"{}\")", what.empty() ? "" : " and ",
                        coarse.instances, coarse.instances > 1 ? "s" : "", coarse.first_instance,
                        scene.instances[size_t(coarse.first_instance)].name);
  if (what.empty()) return {};
  return fmt::format(
      "shadows {} are coarse: they are so far from most lights and cameras that rays leave out their last "
      "{:.2g} m; move the scene together, or let these cast no shadows",
      what, coarse.gap_m);
}

}  // namespace lightgrid
