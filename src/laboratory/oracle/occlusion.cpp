#include "oracle/occlusion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "oracle/position.h"
#include "scene/ray_origin.h"

namespace lightgrid::lab {
namespace {

using glm::dvec3;

// Distance from a triangle's edges.
double to_edges(const Corners& c, const dvec3& p) {
  double nearest = std::numeric_limits<double>::infinity();
  for (size_t k = 0; k < 3; ++k) {
    const dvec3 along = c[(k + 1) % 3] - c[k], from = p - c[k];
    const double squared = glm::dot(along, along),
                 share = squared > 0 ? std::clamp(glm::dot(from, along) / squared, 0.0, 1.0) : 0;
    nearest = std::min(nearest, glm::length(from - along * share));
  }
  return nearest;
}

double greatest(const dvec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

}  // namespace

Occlusion::Occlusion(const Scene& scene, BlendedCasters by_blended)
    : scene_(scene), by_blended_(by_blended), masks_(scene), origin_(ray_origin(scene)) {
  const WorldBox box = world_box(scene);
  if (box.empty()) return;
  middle_ = (box.min + box.max) * 0.5;
  diagonal_m_ = glm::length(box.max - box.min);
  vertex_error_m_ = std::max(rounded(box.min).error_m, rounded(box.max).error_m);
  for (size_t i = 0; i < scene.instances.size(); ++i) {
    const Mesh& mesh = scene.meshes[scene.instances[i].mesh];
    const bool blended = scene.materials[mesh.material].alpha_mode == AlphaMode::blend;
    if ((blended && by_blended == BlendedCasters::none) || !scene.instances[i].casts_shadow) continue;
    for (uint32_t t = 0; t < mesh.indices.size() / 3; ++t) {
      const Corners c = corners_of({int(i), t});
      // Equal corners stay equal when they are rounded, and nothing meets a triangle without area.
      if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0]) continue;
      numbers_.push_back({int(i), t});
      corners_.push_back(c);
    }
  }
  tree_ = TriangleTree(corners_);
}

// Three coordinates relative to an origin that is itself rounded.
RoundedPoint Occlusion::rounded(const dvec3& place) const {
  const double size = greatest(place - origin_) + float_rounding * greatest(origin_);
  return {place, std::sqrt(3.0) * float_rounding * size};
}

Corners Occlusion::corners_of(const CastingTriangle& t) const {
  const Instance& instance = scene_.instances[t.instance];
  const Mesh& mesh = scene_.meshes[instance.mesh];
  Corners corners;
  for (size_t k = 0; k < 3; ++k) {
    const dvec3 p(mesh.positions[mesh.indices[3 * size_t(t.triangle) + k]]);
    corners[k] = dvec3(instance.world_from_object * glm::dvec4(p, 1));
  }
  return corners;
}

Receiver Occlusion::receiver(const View& view, int x, int y, double depth, const CastingTriangle& own) const {
  const dvec3 in_view = position_from_depth(view, x, y, depth);
  const glm::dmat3 world_from_view = glm::transpose(glm::dmat3(view.view_from_world));
  const dvec3 shaded = view.eye + world_from_view * in_view;
  const Corners c = corners_of(own);
  const dvec3 normal = glm::cross(c[1] - c[0], c[2] - c[0]);
  const double squared = glm::dot(normal, normal),
               off = squared > 0 ? glm::dot(shaded - c[0], normal) / squared : 0;
  Receiver r{.own = own};
  const Mesh& mesh = scene_.meshes[scene_.instances[own.instance].mesh];
  r.own_hides =
      by_blended_ == BlendedCasters::opaque || scene_.materials[mesh.material].alpha_mode != AlphaMode::blend;
  r.place.place = shaded - normal * off;
  // docs/details/oracle.md#shadows: a position in float, its turn to world axes, its way to the plane, and
  // the plane's tilt.
  const double tan_x =
                   std::max(std::abs(view_x_of_pixel(view, 0)), std::abs(view_x_of_pixel(view, view.width))),
               tan_y =
                   std::max(std::abs(view_y_of_pixel(view, 0)), std::abs(view_y_of_pixel(view, view.height)));
  const double slope = std::max(tan_x, tan_y), away = view.orthographic ? 1 : std::abs(in_view.z);
  const double depth_m = view.orthographic ? std::max(std::abs(in_view.z), view.far_m) : std::abs(in_view.z);
  const double edges = glm::length(c[1] - c[0]) + glm::length(c[2] - c[0]);
  const double of_vertices = std::max({rounded(c[0]).error_m, rounded(c[1]).error_m, rounded(c[2]).error_m});
  const double tilt = squared > 0 ? 2 * of_vertices * edges / std::sqrt(squared) : 1;
  r.place.error_m = float_rounding * (17 * slope * away + 4 * depth_m + 7 * glm::length(in_view) +
                                      glm::length(view.eye - origin_) + 2 * glm::length(shaded - origin_) +
                                      6 * glm::length(shaded - c[0])) +
                    of_vertices +
                    std::min(tilt, 1.0) * (std::abs(off) * std::sqrt(squared) + to_edges(c, r.place.place));
  r.gap_m = 1e-3 + 0x1p-20 * glm::length(shaded - origin_);
  if (view.orthographic) {
    const double far_m = beyond_all_m(r.place.place);
    r.eye = {r.place.place + world_from_view[2] * far_m, r.place.error_m};
  } else {
    r.eye = rounded(view.eye);
  }
  return r;
}

double Occlusion::beyond_all_m(const dvec3& place) const {
  return 2 * (diagonal_m_ + glm::length(place - middle_));
}

// A directional light is a point so far away that all triangles lie before it.
RoundedPoint Occlusion::source_of(const Light& light, const Receiver& receiver) const {
  if (!is_directional(light)) return rounded(light.position);
  const dvec3& place = receiver.place.place;
  const double far_m = beyond_all_m(place);
  return {place - glm::normalize(dvec3(light.direction)) * far_m,
          receiver.place.error_m + float_rounding * far_m};
}

Occlusion::Met Occlusion::meet(int number, const RoundedPoint& light, const RoundedPoint& end) const {
  const Corners& corners = corners_[size_t(number)];
  const RoundedPoint c[3] = {rounded(corners[0]), rounded(corners[1]), rounded(corners[2])};
  const SignedVolume from = side_of_triangle(c[0], c[1], c[2], light),
                     to = side_of_triangle(c[0], c[1], c[2], end);
  if (from.sign() * to.sign() > 0) return {};
  SignedVolume weights[3];  // weights of the corners, each with the edge that it faces
  int least = 1, most = -1, unsure = 0;
  Met met{.light_side = from.sign()};
  for (int k = 0; k < 3; ++k) {
    weights[k] = side_of_edge(light, c[(k + 1) % 3], c[(k + 2) % 3], end);
    const int sign = weights[k].sign();
    if (sign == 0) {
      ++unsure;
      met.of_edge = k;
    }
    least = std::min(least, sign);
    most = std::max(most, sign);
    if (least * most < 0) return {};
  }
  const bool crosses = from.sign() * to.sign() < 0;
  if (crosses) met.share = from.value / (from.value - to.value);
  met.meeting = crosses && unsure == 0 ? Meeting::crossed : Meeting::unsure;
  if (!crosses || unsure != 1) met.of_edge = -1;

  const double sum = weights[0].value + weights[1].value + weights[2].value,
               error = weights[0].error + weights[1].error + weights[2].error;
  dvec3 shares(1.0 / 3), errors(1);
  if (std::abs(sum) > 2 * error) {
    for (int k = 0; k < 3; ++k) {
      shares[k] = weights[k].value / sum;
      errors[k] = (weights[k].error + std::abs(shares[k]) * error) / (std::abs(sum) - error);
    }
  }
  met.weights = shares;
  met.errors = errors;
  const CastingTriangle& t = numbers_[size_t(number)];
  const Cover cover = masks_.at(t.instance, t.triangle, shares, errors);
  if (cover == Cover::clear) return {};
  if (cover == Cover::either) {
    met.meeting = Meeting::unsure;
    met.of_edge = -1;
  }
  return met;
}

// Two triangles on either side of a common edge, the only doubt of both: a segment passes through one of
// them, whichever way their vertices are rounded.
bool Occlusion::share_an_edge(int a, const Met& met_a, int b, const Met& met_b) const {
  if (met_a.of_edge < 0 || met_b.of_edge < 0) return false;
  const auto end = [&](int number, const Met& met, int k) {
    return corners_[size_t(number)][size_t((met.of_edge + k) % 3)];
  };
  const dvec3 a1 = end(a, met_a, 1), a2 = end(a, met_a, 2), b1 = end(b, met_b, 1), b2 = end(b, met_b, 2);
  if (a1 == b2 && a2 == b1) return met_a.light_side == met_b.light_side;
  return a1 == b1 && a2 == b2 && met_a.light_side != met_b.light_side;
}

// For a light with a place the end is a share of the way in float: three roundings of the share, two of the
// difference. For a directional light it is a step from the receiver.
RoundedPoint Occlusion::end_of(const Light& light, const RoundedPoint& source, const Receiver& r) const {
  const dvec3 step = source.place - r.place.place;
  const double length = glm::length(step),
               rounded_m = is_directional(light) ? glm::length(r.place.place - origin_) + r.gap_m : length;
  return {r.place.place + step * (r.gap_m / length), r.place.error_m + 6 * float_rounding * rounded_m};
}

// How near a triangle's box must be to a segment. A float method may leave a triangle to its box, which it
// may enlarge (docs/details/oracle.md#shadows).
double Occlusion::reach_of(const RoundedPoint& source, const RoundedPoint& end) const {
  return vertex_error_m_ + source.error_m + end.error_m +
         float_rounding *
             (32 * glm::length(source.place - end.place) + 8 * glm::length(source.place - origin_));
}

// near(source, end, reach, visit) calls visit for all triangles within reach, until it returns true.
template <typename Near>
SightAnswer Occlusion::sight_of(const Light& light, const Receiver& r, const Corners& own, int* last,
                                const Near& near) const {
  const RoundedPoint source = source_of(light, r);
  const auto side = [&](const RoundedPoint& p) {
    return side_of_triangle(rounded(own[0]), rounded(own[1]), rounded(own[2]), p).sign();
  };
  const int sides = r.own_hides ? side(source) * side(r.eye) : 1;
  const double length = glm::length(source.place - r.place.place);
  const auto distance_at = [&](double share) {
    const double from_light = share * (length - r.gap_m);
    return is_directional(light) ? length - from_light : from_light;
  };
  if (sides < 0) return {Sight::hidden, r.own, is_directional(light) ? 0 : length};
  const SightAnswer unhidden{sides > 0 ? Sight::seen : Sight::either, {}, 0};
  if (!(length > r.gap_m)) return unhidden;
  const RoundedPoint end = end_of(light, source, r);
  std::optional<SightAnswer> hidden;
  std::vector<std::pair<int, Met>> unsure;
  const auto meets = [&](int number) {
    if (numbers_[size_t(number)] == r.own || is_veil(numbers_[size_t(number)])) return false;
    const Met met = meet(number, source, end);
    if (met.meeting == Meeting::none) return false;
    bool certain = met.meeting == Meeting::crossed;
    for (const auto& [other, met_other] : unsure) certain |= share_an_edge(number, met, other, met_other);
    if (met.meeting == Meeting::unsure) unsure.emplace_back(number, met);
    if (!certain) return false;
    hidden = {Sight::hidden, numbers_[size_t(number)], distance_at(met.share)};
    if (last) *last = number;
    return true;
  };
  if (last && *last >= 0 && meets(*last)) return *hidden;
  unsure.clear();
  near(source, end, reach_of(source, end), meets);
  if (hidden) return *hidden;
  return unsure.empty() ? unhidden : SightAnswer{Sight::either, {}, 0};
}

SightAnswer Occlusion::sight(const Light& light, const Receiver& r, int* last) const {
  return through_veil(light, r,
                      sight_of(light, r, corners_of(r.own), last,
                               [&](const RoundedPoint& from, const RoundedPoint& to, double reach,
                                   const auto& visit) { tree_.walk(from.place, to.place, reach, visit); }));
}

SightAnswer Occlusion::through_veil(const Light& light, const Receiver& r, const SightAnswer& answer) const {
  if (by_blended_ != BlendedCasters::alpha || answer.sight != Sight::seen) return answer;
  constexpr double of_byte = 1.0 / 255;
  const Veil hidden = veil(light, r);
  if (hidden.most < 0.5 - of_byte) return answer;
  return {hidden.least > 0.5 + of_byte ? Sight::hidden : Sight::either, {}, 0};
}

bool Occlusion::is_veil(const CastingTriangle& t) const {
  if (by_blended_ != BlendedCasters::alpha) return false;
  const Mesh& mesh = scene_.meshes[scene_.instances[t.instance].mesh];
  return scene_.materials[mesh.material].alpha_mode == AlphaMode::blend;
}

Veil Occlusion::veil(const Light& light, const Receiver& r) const {
  const RoundedPoint source = source_of(light, r);
  double least = 1, most = 1;  // let through
  if (!(glm::length(source.place - r.place.place) > r.gap_m)) return {};
  const RoundedPoint end = end_of(light, source, r);
  tree_.walk(source.place, end.place, reach_of(source, end), [&](int number) {
    const CastingTriangle& t = numbers_[size_t(number)];
    if (t == r.own || !is_veil(t)) return false;
    const Met met = meet(number, source, end);
    if (met.meeting == Meeting::none) return false;
    const MaskCover::Range alpha = masks_.alpha(t.instance, t.triangle, met.weights, met.errors);
    least *= 1 - std::clamp(alpha.most, 0.0, 1.0);
    if (met.meeting == Meeting::crossed) most *= 1 - std::clamp(alpha.least, 0.0, 1.0);
    return false;
  });
  return {1 - most, 1 - least};
}

void Occlusion::sights(const Light& light, std::span<const Receiver* const> receivers,
                       std::span<SightAnswer> answers, int* last) const {
  std::optional<std::vector<int>> around;
  const auto look_around = [&] {
    WorldBox box{dvec3(1e300), dvec3(-1e300)};
    std::vector<RoundedPoint> ends;
    RoundedPoint source;
    double reach = 0;
    for (const Receiver* r : receivers) {
      source = source_of(light, *r);
      if (!(glm::length(source.place - r->place.place) > r->gap_m)) continue;
      ends.push_back(end_of(light, source, *r));
      box.min = glm::min(box.min, ends.back().place);
      box.max = glm::max(box.max, ends.back().place);
      reach = std::max(reach, reach_of(source, ends.back()));
    }
    // All ends as one that is known to within their distance: what it passes by, they do.
    RoundedPoint all{(box.min + box.max) * 0.5, 0};
    for (const RoundedPoint& end : ends)
      all.error_m = std::max(all.error_m, glm::length(end.place - all.place) + end.error_m);
    around.emplace();
    tree_.walk_shaft(source.place, box, reach, [&](int triangle) {
      if (meet(triangle, source, all).meeting != Meeting::none) around->push_back(triangle);
    });
  };
  CastingTriangle known;
  Corners own;
  for (size_t i = 0; i < receivers.size(); ++i) {
    const Receiver& r = *receivers[i];
    if (r.own != known) {
      own = corners_of(r.own);
      known = r.own;
    }
    answers[i] = through_veil(
        light, r,
        sight_of(light, r, own, last,
                 [&](const RoundedPoint& from, const RoundedPoint& to, double reach, const auto& visit) {
                   if (!around) look_around();
                   for (const int triangle : *around) {
                     if (tree_.is_near(triangle, from.place, to.place, reach) && visit(triangle)) return;
                   }
                 }));
  }
}

}  // namespace lightgrid::lab
