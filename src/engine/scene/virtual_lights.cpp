#include "scene/virtual_lights.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include <fmt/format.h>

#include "scene/shadow_casters.h"

namespace lightgrid {
namespace {

constexpr double widest_view_rad = 75 * std::numbers::pi / 180;  // half of a spot's

double weight_of(const ReflectedPixel& p) { return double(p.flux.r) + double(p.flux.g) + double(p.flux.b); }

double fraction(double x) { return x - std::floor(x); }

// Bits of i, mirrored behind the point (van der Corput).
double radical_inverse(uint32_t i) {
  double inverse = 0;
  for (double bit = 0.5; i != 0; i >>= 1, bit /= 2) inverse += i & 1 ? bit : 0;
  return inverse;
}

// Rows of all views, one after the other.
class Rows {
 public:
  explicit Rows(const std::vector<ReflectedView>& views) {
    for (const ReflectedView& v : views) {
      for (int y = 0; y < v.view.height; ++y) {
        const ReflectedPixel* pixels = v.pixels.data() + size_t(y) * size_t(v.view.width);
        for (int x = 0; x < v.view.width; ++x) sum_ += weight_of(pixels[x]);
        rows_.push_back({&v, pixels, y, sum_});
      }
    }
  }

  double sum() const { return sum_; }

  struct Pick {
    const ReflectedView* of;
    const ReflectedPixel* pixel;
    int x, y;
  };

  // row_share, share: [0, 1), of the sum of all rows, and of that of the row. The sum is above 0.
  Pick pick(double row_share, double share) const {
    auto row = std::ranges::upper_bound(rows_, row_share * sum_, {}, &Row::until);
    if (row == rows_.end()) row = std::ranges::lower_bound(rows_, sum_, {}, &Row::until);
    const double before = row == rows_.begin() ? 0 : std::prev(row)->until;
    const double at = share * (row->until - before);
    double until = 0;
    int last = 0;  // that reflects
    for (int x = 0; x < row->of->view.width; ++x) {
      const double weight = weight_of(row->pixels[x]);
      if (weight > 0) last = x;
      if ((until += weight) > at) break;
    }
    return {row->of, row->pixels + last, last, row->y};
  }

 private:
  struct Row {
    const ReflectedView* of;
    const ReflectedPixel* pixels;
    int y;
    double until;  // the sum of all rows so far
  };
  std::vector<Row> rows_;
  double sum_ = 0;
};

}  // namespace

void make_virtual(Light& light) {
  light.type = LightType::spot;
  light.is_virtual = true;
  light.inner_cone_rad = 0;
  light.source_m = 0;
  // The float below pi / 2: its cosine is 8e-8, and not below 0, so that cull tests use the cone.
  light.outer_cone_rad = std::nextafter(float(std::numbers::pi / 2), 0.0f);
}

std::vector<size_t> reflected_lights(const Scene& scene, size_t most) {
  const WorldBox box = world_box(scene);
  const double diameter_m = box.empty() ? 0 : glm::length(box.max - box.min);
  std::vector<std::pair<double, size_t>> ranked;
  for (size_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    if (!is_directional(light) && !light.is_virtual)
      ranked.emplace_back(-light_importance(light, diameter_m), i);
  }
  std::ranges::sort(ranked);
  ranked.resize(std::min(ranked.size(), most));
  std::vector<size_t> lights;
  for (const auto& [importance, i] : ranked) lights.push_back(i);
  std::ranges::sort(lights);
  return lights;
}

std::vector<View> views_from(const Light& light, int side, double near_m) {
  const auto towards = [&](const glm::dvec3& direction, double half_rad) {
    Camera camera = look_at(light.position, light.position + direction);
    camera.fov_y_rad = 2 * half_rad;
    camera.near_m = near_m;
    return make_view(camera, side, side);
  };
  if (has_cone(light) && light.outer_cone_rad <= widest_view_rad)
    return {towards(glm::normalize(glm::dvec3(light.direction)), light.outer_cone_rad)};
  std::vector<View> views;
  for (const glm::dvec3 axis : {glm::dvec3(1, 0, 0), {0, 1, 0}, {0, 0, 1}}) {
    for (const double sign : {1.0, -1.0}) views.push_back(towards(sign * axis, std::numbers::pi / 4));
  }
  return views;
}

std::vector<Light> virtual_lights_of(const std::vector<ReflectedView>& views,
                                     const VirtualLightSettings& settings) {
  const Rows rows(views);
  std::vector<Light> lights(size_t(std::max(settings.count, 0)));
  // Successive seeds are far apart, and spread evenly: the additive recurrence of the plastic number.
  const double shift = fraction(double(settings.seed - 1) * 0.7548776662466927);
  const double column_shift = fraction(double(settings.seed - 1) * 0.5698402909980532);
  for (size_t i = 0; i < lights.size(); ++i) {
    Light& light = lights[i];
    light.name = fmt::format("virtual {}", i);
    make_virtual(light);
    if (!(rows.sum() > 0)) {
      light.intensity = 0;
      light.radius_m = 0;
      continue;
    }
    const double count = double(lights.size());
    const Rows::Pick at = rows.pick(fraction((double(i) + 0.5) / count + shift),
                                    fraction(radical_inverse(uint32_t(i)) + column_shift));
    const ReflectedPixel& p = *at.pixel;
    light.properties = at.of->properties;
    const View& view = at.of->view;
    const double of_pixel = rows.sum() / (weight_of(p) * count);  // the light's flux over the pixel's
    const glm::dmat3 world_from_view = glm::transpose(glm::dmat3(view.view_from_world));
    const double slope_x = ((at.x + 0.5) * 2 / view.width - 1) / view.clip_from_view[0][0];
    const double slope_y = ((at.y + 0.5) * 2 / view.height - 1) / view.clip_from_view[1][1];
    const glm::dvec3 normal = world_from_view * glm::dvec3(p.normal);
    const double width_m = 2 * double(p.ahead_m) / (view.clip_from_view[0][0] * view.width);
    light.position = view.eye + double(p.ahead_m) * (world_from_view * glm::dvec3(slope_x, slope_y, -1)) +
                     width_m / 64 * normal;
    light.direction = glm::vec3(glm::normalize(normal));
    const glm::dvec3 intensity = glm::dvec3(p.flux) * (of_pixel / std::numbers::pi);  // along the normal
    const double brightest = std::max({intensity.r, intensity.g, intensity.b});
    light.color = glm::vec3(intensity / brightest);
    light.intensity = float(brightest);
    light.nearest_m = settings.nearest_m >= 0
                          ? float(settings.nearest_m)
                          : float(std::sqrt(double(p.area_m2) * of_pixel / std::numbers::pi));
  }
  return lights;
}

}  // namespace lightgrid
