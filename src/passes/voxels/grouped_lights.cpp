#include "passes/voxels/grouped_lights.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lightgrid {
namespace {

constexpr size_t group = VOXEL_LIGHT_GROUP;
constexpr float far_off = 3e18f;           // its square is still a float
constexpr double longest_radius_m = 7e18;  // likewise
constexpr double wide = 1e30;  // 1 - cosine of the cone of a light without one: any widening is nothing

uint64_t spread_bits(uint64_t x) {
  x &= 0x1fffff;
  x = (x | x << 32) & 0x1f00000000ffff, x = (x | x << 16) & 0x1f0000ff0000ff,
  x = (x | x << 8) & 0x100f00f00f00f00f;
  x = (x | x << 4) & 0x10c30c30c30c30c3, x = (x | x << 2) & 0x1249249249249249;
  return x;
}

// Along a Morton curve through the box of all lights; those that are large compared with it last, so that
// they enlarge no box of small ones.
std::vector<uint32_t> neighbours_first(const std::vector<glm::dvec4>& lights) {
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high = -low;
  for (const glm::dvec4& l : lights) low = glm::min(low, glm::dvec3(l)), high = glm::max(high, glm::dvec3(l));
  // Half of it: all of it may be more than a double holds.
  const glm::dvec3 size = glm::max(0.5 * high - 0.5 * low, 0.5e-9);
  const double large = 0.25 * glm::length(size);
  std::vector<std::pair<uint64_t, uint32_t>> keys;
  keys.reserve(lights.size());
  for (uint32_t i = 0; i < lights.size(); ++i) {
    const glm::dvec3 at = glm::clamp((0.5 * glm::dvec3(lights[i]) - 0.5 * low) / size, 0.0, 1.0) * 1048575.0;
    const uint64_t code =
        spread_bits(uint64_t(at.x)) | spread_bits(uint64_t(at.y)) << 1 | spread_bits(uint64_t(at.z)) << 2;
    keys.emplace_back(code | (lights[i].w > large ? uint64_t(1) << 62 : 0), i);
  }
  std::sort(keys.begin(), keys.end());
  std::vector<uint32_t> order;
  order.reserve(keys.size());
  for (const auto& [key, i] : keys) order.push_back(i);
  return order;
}

}  // namespace

void GroupedLights::sort(const Seen& seen) {
  std::vector<glm::dvec4> by;
  by.reserve(seen.plan.local.size());
  for (const int i : seen.plan.local) {
    const Light& light = seen.scene.lights[i];
    by.emplace_back(light.position,
                    std::min(range_of(light, size_t(i), seen.plan.settings.ranges), longest_radius_m));
  }
  if (by == sorted_by_) return;
  sorted_by_ = std::move(by);
  order_ = neighbours_first(sorted_by_);
}

void GroupedLights::update(Work& work, const Seen& seen, const VoxelAxes& axes) {
  sort(seen);
  View along;
  along.view_from_world = glm::dmat4(axes.from_world);
  along.eye = axes.origin;
  const std::vector<ViewLight> lights = lights_in_view(seen.scene, along, seen.plan.settings.ranges);
  groups_ = uint32_t((order_.size() + group - 1) / group);
  const size_t padded = (groups_ + group - 1) / group * group;  // boxes are read by as many at once
  std::vector<float> places(4 * group * groups_, far_off), boxes(6 * padded, far_off);
  std::vector<glm::vec4> colors(group * groups_, glm::vec4(0)), cones;
  if (seen.plan.spots) cones.assign(2 * group * groups_, glm::vec4(0));
  for (size_t i = 0; i < places.size(); ++i) {
    if (i / group % 4 == 3) places[i] = 0;
  }
  brightest_ = 0;
  for (size_t n = 0; n < order_.size(); ++n) {
    const ViewLight& light = lights[size_t(seen.plan.local[order_[n]])];
    const size_t g = n / group, lane = n % group;
    const double radius = std::min(light.radius_m, longest_radius_m);
    const glm::vec3 at(glm::clamp(light.position, -double(far_off), double(far_off)));
    for (int axis = 0; axis < 3; ++axis) {
      places[(4 * g + axis) * group + lane] = at[axis];
      float& low = boxes[(g / 16 * 6 + axis) * 16 + g % 16];
      float& high = boxes[(g / 16 * 6 + 3 + axis) * 16 + g % 16];
      // Rounded outward.
      const float from = std::nextafter(float(at[axis] - radius), -far_off * 10),
                  to = std::nextafter(float(at[axis] + radius), far_off * 10);
      low = lane == 0 ? from : std::min(low, from), high = lane == 0 ? to : std::max(high, to);
    }
    places[(4 * g + 3) * group + lane] = float(radius);
    const glm::dvec3 color = light.radius_m > 0 ? light.radiant_intensity : glm::dvec3(0);
    colors[n] = glm::vec4(glm::vec3(color),
                          float(std::min(light.least_falloff, double(std::numeric_limits<float>::max()))));
    brightest_ = std::max({brightest_, colors[n].x, colors[n].y, colors[n].z});
    if (cones.empty()) continue;
    const bool spot = has_cone(light);
    const double scale = spot ? 1 / (light.cos_inner - light.cos_outer) : 0;
    // Directions are those to the light: the axis is turned around.
    cones[2 * n] = glm::vec4(glm::vec3(-light.direction * scale), spot ? float(-light.cos_outer * scale) : 1);
    cones[2 * n + 1] = glm::vec4(float(scale), spot ? float(1 - light.cos_outer) : float(wide),
                                 float(1 - light.cos_outer * light.cos_outer), 0);
  }
  const bool same =
      version_ > 0 && places == places_ && boxes == boxes_ && colors == colors_ && cones == cones_;
  if (same) return;
  ++version_;
  places_ = std::move(places), boxes_ = std::move(boxes), colors_ = std::move(colors),
  cones_ = std::move(cones);
  ClDevice& device = *work.renderer.cl;
  constexpr const char* what = "uploading lights of voxels";
  this->places.put(device, what, places_);
  this->boxes.put(device, what, boxes_);
  this->colors.put(device, what, colors_);
  this->cones.put(device, what, cones_);
}

size_t GroupedLights::memory_bytes() const {
  return boxes.bytes() + places.bytes() + colors.bytes() + cones.bytes();
}

}  // namespace lightgrid
