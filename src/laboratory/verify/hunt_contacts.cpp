#include "verify/hunt_space.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/parallel.h"
#include "oracle/lit_set.h"
#include "oracle/position.h"
#include "run/frames.h"

namespace lightgrid::lab::verify {
namespace {

using std::numbers::pi;
constexpr size_t lights_at_once = 2048;  // lights from one sequence of random numbers

float stored_at(const HuntView& h, const HuntContact& c) {
  return h.depth.values[(size_t(c.y) * h.view.width + c.x) * h.depth.samples + c.sample];
}

// The point of the image, pixels, whose depth is c.depth.
glm::dvec2 place_of_depth(const HuntView& h, const HuntContact& c) {
  const bool centre = h.depth.samples == 1;
  return {c.x + (centre ? 0.5 : double(c.in_x)), c.y + (centre ? 0.5 : double(c.in_y))};
}

// Generates the lights of one view, a batch at a time.
class Maker {
 public:
  Maker(const HuntView& view, const HuntSetting& setting, uint64_t seed)
      : h_(view),
        setting_(setting),
        v_(oracle_view(view.view)),
        seed_(seed),
        world_from_view_(glm::transpose(glm::dmat3(view.view.view_from_world))) {
    Random random(seed);
    elsewhere_ = view.view.eye + any_direction(random) * view.elsewhere_m;
  }

  void fill(HuntLights& made, std::vector<HuntContact>& contacts, size_t begin, size_t end) const {
    Random random(Random::mix(seed_ + begin));
    for (size_t i = begin; i < end; ++i) {
      Light& light = made.lights[i];
      const bool single = h_.elsewhere > 0 && i == 0;
      if (single || chance(random, h_.elsewhere))
        light = light_elsewhere(random);
      else if (const auto contact = light_at_pixel(light, random)) {
        contacts.push_back(*contact);
        contacts.back().light = uint32_t(i);
      }
    }
  }

 private:
  struct Corner {
    int x = 0, y = 0;  // -1, 0, 1: the end of its tile that the pixel is at
  };

  Light light_elsewhere(Random& random) const {
    Light light;
    light.position = elsewhere_;
    const double most = std::numeric_limits<float>::max();
    for (int a = 0; a < 3; ++a) {
      light.position[a] =
          std::clamp(light.position[a] + 1e-3 * h_.elsewhere_m * between(random, -1, 1), -most, most);
    }
    light.radius_m = float(h_.elsewhere_radius_m);
    return light;
  }

  // A pixel with a surface, mostly at an end of its tile.
  std::optional<HuntContact> pixel(Corner& corner, Random& random) const {
    const int tile = setting_.options.tile;
    const auto choose = [&](int pixels, int& end) {
      int at = int(random.next() % uint64_t(pixels));
      end = 0;
      if (chance(random, 0.7)) {
        end = random.next() & 1 ? 1 : -1;
        at = at / tile * tile;
        if (end > 0) at = std::min(at + tile, pixels) - 1;
      }
      return at;
    };
    for (int attempt = 0; attempt < 8; ++attempt) {
      HuntContact c;
      c.x = uint16_t(choose(h_.view.width, corner.x));
      c.y = uint16_t(choose(h_.view.height, corner.y));
      c.sample = uint16_t(random.next() % uint64_t(h_.depth.samples));
      if (!setting_.options.pixel_centres || h_.depth.samples > 1) {
        c.in_x = float(corner.x ? (corner.x + 1) / 2 : unit(random));
        c.in_y = float(corner.y ? (corner.y + 1) / 2 : unit(random));
      }
      c.depth = stored_at(h_, c);
      if (h_.blended) {
        const glm::dvec2 at = place_of_depth(h_, c);
        c.depth = random_blended_depth(h_, c.depth, at.x, at.y, random);
      }
      if (position_of(h_, c)) return c;
    }
    return {};
  }

  // A direction away from the cell at this corner: a side's normal, the view axis, a mix of both, or any.
  glm::dvec3 outward(const glm::dvec3& p, const Corner& corner, Random& random) const {
    const double style = unit(random);
    if (style < 0.15) return any_direction(random);
    const bool flat = v_.orthographic;
    const auto sign = [&](int end) { return end ? end : (random.next() & 1 ? 1 : -1); };
    const auto normal = [&](int axis, double coordinate, int end) {
      glm::dvec3 n(0);
      n[axis] = end;
      n.z = flat ? 0 : end * coordinate / -p.z;
      return glm::normalize(n);
    };
    const glm::dvec3 nx = normal(0, p.x, sign(corner.x)), ny = normal(1, p.y, sign(corner.y));
    const glm::dvec3 nz(0, 0, random.next() & 1 ? 1 : -1);
    if (style < 0.3) return nx;
    if (style < 0.4) return ny;
    if (style < 0.55) return nz;
    const double wx = corner.x || chance(random, 0.5) ? std::exp2(-8 * unit(random)) : 0;
    const double wy = corner.y || chance(random, 0.5) ? std::exp2(-8 * unit(random)) : 0;
    const glm::dvec3 mixed = wx * nx + wy * ny + std::exp2(-8 * unit(random)) * nz;
    const double length = glm::length(mixed);
    return length > 1e-6 ? mixed / length : nz;
  }

  // Sizes range from far below the cell's width to far past the eye's distance; large ones are rare, because
  // long lists take time.
  double random_size(const glm::dvec3& p, Random& random) const {
    const double d = v_.orthographic ? 1 : std::abs(p.z), pixels = setting_.options.tile;
    const double wide = 2 / (v_.clip_from_view[0][0] * v_.width),
                 high = 2 / (v_.clip_from_view[1][1] * v_.height);
    double one = std::log2(std::min(wide, high) * pixels * d);
    if (!v_.orthographic) one = std::min(one, std::log2(d));
    const double least = std::max(one - 16, std::log2(glm::length(p)) - 30), share = unit(random);
    if (share < 0.65) return std::exp2(between(random, std::min(least, one), one));
    if (share < 0.95) return std::exp2(between(random, one, one + 1.5));
    if (share < 0.99) return std::exp2(between(random, one + 1, one + 4));
    return std::exp2(between(random, one + 3, one + 40));
  }

  // A relative excess: 1e-3 to 65536 units in the last place, or up to 1e-4.
  static double hair(Random& random) {
    if (chance(random, 0.3)) return 1e-4 * unit(random);
    return std::exp2(-24 + between(random, -10, 16));
  }

  std::optional<HuntContact> light_at_pixel(Light& light, Random& random) const {
    Corner corner;
    const auto contact = pixel(corner, random);
    light.radius_m = 0;
    if (!contact) return {};
    const glm::dvec3 p = *position_of(h_, *contact), away = outward(p, corner, random);
    const double size = random_size(p, random);
    const float wanted = float(std::clamp(size, 1e-36, 1e36));
    glm::dvec3 in_view = p + away * (wanted * (1 - hair(random)));
    light.position = h_.view.eye + world_from_view_ * in_view;
    // Computed from the light's world position as rounded to double.
    in_view = glm::dmat3(v_.view_from_world) * (light.position - v_.eye);
    const glm::dvec3 way = p - in_view;
    const double distance = glm::length(way);
    light.radius_m = distance < wanted ? wanted : float(distance * (1 + hair(random)));
    while (!(distance < light.radius_m)) light.radius_m = std::nextafter(light.radius_m, float(no_end));
    if (setting_.spots && chance(random, 0.5)) make_spot(light, way, outward(p, corner, random), random);
    if (!(light.radius_m < float(no_end)) || !is_lit_there(h_, light, p)) return {};
    return contact;
  }

  // A cone whose side passes the end of `way` by a tiny margin, turned towards `side`.
  void make_spot(Light& light, const glm::dvec3& way, const glm::dvec3& side, Random& random) const {
    const double length = glm::length(way);
    if (!(length > 0)) return;
    const double half = chance(random, 0.85) ? log_between(random, 0.1, 90) : between(random, 90, 179);
    const glm::dvec3 to = way / length, up = glm::abs(to.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    glm::dvec3 across = side - to * glm::dot(side, to);
    if (!(glm::dot(across, across) > 1e-6)) across = glm::cross(to, up);
    across = glm::normalize(across);
    const double angle = half * pi / 180;
    light.type = LightType::spot;
    light.direction =
        glm::vec3(glm::normalize(world_from_view_ * (to * std::cos(angle) + across * std::sin(angle))));
    if (chance(random, 0.5)) light.radius_m *= float(between(random, 1.1, 3));
    // The angle is measured from the rounded direction.
    const glm::dvec3 axis =
        glm::normalize(glm::dmat3(v_.view_from_world) * glm::normalize(glm::dvec3(light.direction)));
    const double off = std::atan2(glm::length(glm::cross(axis, to)), glm::dot(axis, to));
    float outer = float(std::min(off * (1 + hair(random)), pi));
    const double cosine = glm::dot(axis, to);
    while (outer < 3.14159f && !(std::cos(double(outer)) < cosine))
      outer = std::nextafter(outer, float(no_end));
    light.outer_cone_rad = std::min(outer, 3.1415925f);
    light.inner_cone_rad = light.outer_cone_rad / 2;
  }

  const HuntView& h_;
  const HuntSetting& setting_;
  const View v_;
  const uint64_t seed_;
  const glm::dmat3 world_from_view_;
  glm::dvec3 elsewhere_{0};
};

}  // namespace

HuntLights random_contacts(const HuntView& view, const HuntSetting& setting, size_t count, uint64_t seed) {
  const Maker maker(view, setting, seed);
  HuntLights made;
  made.lights.resize(count);
  std::vector<std::vector<HuntContact>> parts((count + lights_at_once - 1) / lights_at_once);
  parallel_for(int(parts.size()), [&](int i) {
    parts[i].reserve(lights_at_once);
    maker.fill(made, parts[i], size_t(i) * lights_at_once, std::min(count, size_t(i + 1) * lights_at_once));
  });
  for (const auto& part : parts) made.contacts.insert(made.contacts.end(), part.begin(), part.end());
  return made;
}

std::vector<CullLight> cull_lights(std::span<const Light> lights) {
  std::vector<CullLight> made;
  made.reserve(lights.size());
  for (const Light& light : lights) made.push_back(cull_light(bounds_of(light, light.radius_m)));
  return made;
}

std::optional<glm::dvec3> position_of(const HuntView& h, const HuntContact& c) {
  if (c.depth == depth_of_nothing(h.view)) return {};
  const glm::dvec2 at = place_of_depth(h, c);
  const double d = distance_of(h, c.depth, at.x, at.y);
  const View view = oracle_view(h.view);
  if (!(std::abs(d) < 1e30) || (!view.orthographic && !(d > 0))) return {};
  const double x = view_x_of_pixel(view, c.x + double(c.in_x)),
               y = view_y_of_pixel(view, c.y + double(c.in_y));
  const double scale = view.orthographic ? 1 : d;
  return glm::dvec3(x * scale, y * scale, -d);
}

bool is_lit_there(const HuntView& h, const Light& light, const glm::dvec3& position) {
  const glm::dmat3 turn(h.view.view_from_world);
  ViewLight seen;
  seen.type = light.type;
  seen.position = turn * (light.position - h.view.eye);
  seen.radius_m = light.radius_m;
  if (has_cone(light)) {
    seen.direction = glm::normalize(turn * glm::dvec3(light.direction));
    seen.cos_outer = cone_cosine(light.outer_cone_rad);
  }
  return is_lit(seen, position);
}

}  // namespace lightgrid::lab::verify
