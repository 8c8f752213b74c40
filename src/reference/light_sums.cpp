#include "reference/light_sums.h"

#include "reference/attenuation.h"

namespace lightgrid {

LightSums light_sums(const glm::dvec3& position, const glm::dvec3& normal, std::span<const ViewLight> lights,
                     double exponent) {
  const glm::dvec3 to_eye = glm::normalize(-position);
  LightSums sums;
  for (const ViewLight& light : lights) {
    const glm::dvec3 offset = light.position - position;
    const double distance = glm::length(offset);
    const double arrives = attenuation(light, position, true) * light_reaches(light, position, no_instance);
    if (!(distance > 0) || !(arrives > 0)) continue;
    const glm::dvec3 to_light = offset / distance;
    const double arriving = arrives * glm::clamp(glm::dot(normal, to_light), 0.0, 1.0);
    const double brightest =
        glm::max(light.radiant_intensity.x, glm::max(light.radiant_intensity.y, light.radiant_intensity.z));
    const glm::dvec3 half = to_light + to_eye;
    const double length = glm::length(half);
    const double cosine = length > 0 ? glm::clamp(glm::dot(normal, half) / length, 0.0, 1.0) : 0;
    const double lobe = std::pow(cosine, exponent);
    const double grazing = std::pow(1 - 0.5 * length, 5);  // v.h = |l + v| / 2
    sums.diffuse += arriving * (1 - grazing) * light.radiant_intensity;
    sums.specular += arriving * lobe * brightest;
    sums.weight += arriving * brightest;
    sums.rim += arriving * lobe * grazing * brightest;
  }
  return sums;
}

}  // namespace lightgrid
