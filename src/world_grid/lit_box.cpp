#include "world_grid/lit_box.h"

namespace lightgrid {

size_t sample_step(size_t lights) {
  constexpr size_t most_sampled = 4096;
  return lights / most_sampled + 1;
}

double sampled_median(std::span<const CullLight> lights) {
  std::vector<double> radii;
  for (size_t i = 0; i < lights.size(); i += sample_step(lights.size()))
    if (is_local(lights[i]) && lights[i].radius_m > 0) radii.push_back(lights[i].radius_m);
  if (radii.empty()) return 0;
  const auto middle = radii.begin() + std::ptrdiff_t(radii.size() / 2);
  std::nth_element(radii.begin(), middle, radii.end());
  return std::max(*middle, 1e-12);
}

void LitBox::add(const CullLight& light, double most_radius) {
  if (!is_local(light)) return;
  if (light.radius_m > 0) least = std::min(least, light.radius_m);
  if (light.radius_m > most_radius) return;
  box.min = glm::min(box.min, light.position - light.radius_m);
  box.max = glm::max(box.max, light.position + light.radius_m);
}

void LitBox::add(const LitBox& other) {
  least = std::min(least, other.least);
  box.min = glm::min(box.min, other.box.min), box.max = glm::max(box.max, other.box.max);
}

LitBox lit_box(std::span<const CullLight> lights, double most_radius) {
  std::vector<LitBox> parts(parts_of(lights.size()));
  for_each_part(lights.size(), [&](size_t part, size_t begin, size_t end) {
    LitBox of_part;  // of this thread alone: parts share cache lines
    for (size_t i = begin; i < end; ++i) of_part.add(lights[i], most_radius);
    parts[part] = of_part;
  });
  LitBox all;
  for (const LitBox& part : parts) all.add(part);
  return all;
}

WorldBox ordinary_box(const WorldBox& lit, const WorldBox& bounds) {
  if (lit.empty()) return {glm::dvec3(0), glm::dvec3(0)};
  const glm::dvec3 low = glm::max(lit.min, bounds.min), high = glm::min(lit.max, bounds.max);
  const WorldBox box = glm::all(glm::lessThanEqual(low, high)) ? WorldBox{low, high} : lit;
  return {glm::clamp(box.min, -most_world_m, most_world_m), glm::clamp(box.max, -most_world_m, most_world_m)};
}

}  // namespace lightgrid
