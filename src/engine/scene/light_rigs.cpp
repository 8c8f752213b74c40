#include "scene/light_rigs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "base/facing.h"
#include "scene/random.h"

namespace lightgrid {
namespace {

constexpr int max_count = 10'000'000;
constexpr double lights_per_point = 8;

struct Triangle {
  glm::dvec3 a, b, c;
};

Triangle world_triangle(const Scene& scene, const Instance& instance, size_t first_index) {
  const Mesh& mesh = scene.meshes[instance.mesh];
  const auto corner = [&](size_t i) {
    return glm::dvec3(instance.world_from_object *
                      glm::dvec4(mesh.positions[mesh.indices[first_index + i]], 1));
  };
  Triangle triangle{corner(0), corner(1), corner(2)};
  // Mirrored instances have reversed triangles.
  if (is_mirroring(glm::dmat3(instance.world_from_object))) std::swap(triangle.b, triangle.c);
  return triangle;
}

// Every triangle of every instance, with the running sum of areas: a value below the sum selects a triangle
// by area.
class Surface {
 public:
  explicit Surface(const Scene& scene) : scene_(scene) {
    for (size_t i = 0; i < scene.instances.size(); ++i) {
      const size_t indices = scene.meshes[scene.instances[i].mesh].indices.size();
      for (size_t first = 0; first + 2 < indices; first += 3) {
        const Triangle t = world_triangle(scene, scene.instances[i], first);
        const double area = glm::length(glm::cross(t.b - t.a, t.c - t.a)) / 2;
        if (!(area > 0) || !std::isfinite(sum_ + area)) continue;
        sum_ += area;
        entries_.push_back({sum_, uint32_t(i), uint32_t(first)});
      }
    }
  }

  double area() const { return sum_; }

  Triangle pick(double share) const {
    const auto found = std::upper_bound(entries_.begin(), entries_.end(), share * sum_,
                                        [](double sum, const Entry& entry) { return sum < entry.sum; });
    const Entry& entry = found == entries_.end() ? entries_.back() : *found;
    return world_triangle(scene_, scene_.instances[entry.instance], entry.first_index);
  }

 private:
  struct Entry {
    double sum;
    uint32_t instance, first_index;
  };
  const Scene& scene_;
  std::vector<Entry> entries_;
  double sum_ = 0;
};

// Full colours, one channel at 1 and one at 0.25, by hue.
glm::vec3 color_of_hue(float hue) {
  const auto channel = [hue](float peak) {
    const float apart = std::abs(hue - peak), around = std::min(apart, 6 - apart);
    return 0.25f + 0.75f * std::clamp(2 - around, 0.f, 1.f);
  };
  return {channel(0), channel(2), channel(4)};
}

void check(const Scene& scene, const ScatterSettings& settings, double area) {
  if (settings.count < 0 || settings.count > max_count) {
    throw input_error("lights {}: not in 0..{}", settings.count, max_count);
  }
  const float low = settings.min_radius_m, high = settings.max_radius_m;
  if (!(low == 0 && high == 0) && !(low > 0 && low <= high && std::isfinite(high))) {
    throw input_error("light-radius {},{}: not 0 < MIN <= MAX", low, high);
  }
  if (settings.count > 0 && !(area > 0)) {
    throw input_error("lights {}: scene \"{}\" has no surface to scatter lights over", settings.count,
                      scene.name);
  }
}

Light scatter_one(const Surface& surface, uint64_t seed, int index, float min_radius, float max_radius) {
  // A separate generator for each light: independent of the number of lights.
  Random random(Random::mix(seed) + Random::mix(uint64_t(index) + 1));
  const double share = double(random.next() >> 11) * 0x1p-53;
  const double along = std::sqrt(double(random.uniform())), across = random.uniform();
  Light light;
  light.radius_m = random.uniform(min_radius, max_radius);
  light.color = color_of_hue(6 * random.uniform());
  light.intensity = float(double(light.radius_m) * light.radius_m / 8);

  const Triangle t = surface.pick(share);
  const glm::dvec3 normal = glm::normalize(glm::cross(t.b - t.a, t.c - t.a));
  const glm::dvec3 point = t.a * (1 - along) + (t.b * (1 - across) + t.c * across) * along;
  light.position = point + normal * (0.5 * light.radius_m * random.uniform());
  if (index % 8 == 7) {
    light.type = LightType::spot;
    const glm::dvec3 tilt(random.uniform(-0.5f, 0.5f), random.uniform(-0.5f, 0.5f),
                          random.uniform(-0.5f, 0.5f));
    light.direction = glm::vec3(glm::normalize(tilt - normal));
    light.outer_cone_rad = random.uniform(0.35f, 1.1f);
    light.inner_cone_rad = 0.7f * light.outer_cone_rad;
  }
  return light;
}

}  // namespace

std::vector<Light> scatter_lights(const Scene& scene, const ScatterSettings& settings) {
  const Surface surface(scene);
  check(scene, settings, surface.area());
  float min_radius = settings.min_radius_m, max_radius = settings.max_radius_m;
  if (max_radius == 0 && settings.count > 0) {
    // count * pi * radius^2 = lights_per_point * area; radii vary around it.
    const int count = settings.ranges_of > 0 ? settings.ranges_of : settings.count;
    const double radius = std::sqrt(lights_per_point * surface.area() / (std::numbers::pi * count));
    const WorldBox box = world_box(scene);
    const double bounded = std::min(radius, glm::length(box.max - box.min) / 4);
    min_radius = float(0.6 * bounded);
    max_radius = float(1.4 * bounded);
  }
  // Intensity is radius^2 / 8 (scatter_one).
  if (!(double(max_radius) * max_radius / 8 <= double(std::numeric_limits<float>::max()))) {
    throw input_error("light-radius {:g}: the intensity of a light that wide passes the largest float",
                      max_radius);
  }
  std::vector<Light> lights;
  lights.reserve(settings.count);
  for (int i = 0; i < settings.count; ++i) {
    lights.push_back(scatter_one(surface, settings.seed, i, min_radius, max_radius));
    lights.back().name = fmt::format("scattered {}", i);
  }
  return lights;
}

DefaultLights default_lights(const View& view) {
  const glm::dmat3 world_from_view = glm::transpose(glm::dmat3(view.view_from_world));
  const auto directional = [&](const char* name, const glm::dvec3& from_view, float illuminance_lux) {
    Light light;
    light.name = name;
    light.type = LightType::directional;
    light.direction = glm::vec3(-glm::normalize(world_from_view * from_view));
    light.intensity = illuminance_lux;
    return light;
  };
  // Facing the viewer, cosines are 0.59 and 0.72: (2.3 * 0.59 + 0.7 * 0.72) / pi = 0.59 of radiance, and 0.2
  // ambient.
  return {{directional("default key", {-0.6, 0.8, 0.73}, 2.3f),
           directional("default fill", {0.9, 0.1, 0.94}, 0.7f)},
          glm::vec3(0.2f)};
}

}  // namespace lightgrid
