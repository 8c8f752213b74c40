#include "oracle/primary_rays.h"

#include <algorithm>

#include "base/facing.h"
#include "oracle/position.h"

namespace lightgrid::lab {

using glm::dvec2, glm::dvec3;

PrimaryRays::PrimaryRays(const Scene& scene, const View& view, RayTargets targets)
    : scene_(scene), view_(view) {
  for (int i = 0; i < int(scene.instances.size()); ++i) {
    const Mesh& mesh = scene.meshes[size_t(scene.instances[size_t(i)].mesh)];
    const bool blended = scene.materials[size_t(mesh.material)].alpha_mode == AlphaMode::blend;
    if (blended != (targets == RayTargets::blended)) continue;
    for (uint32_t t = 0; t < mesh.indices.size() / 3; ++t) numbers_.push_back({i, t});
  }
  std::vector<Corners> corners;
  for (const CastingTriangle& number : numbers_) {
    const Instance& instance = scene.instances[size_t(number.instance)];
    Corners& of = corners.emplace_back();
    for (size_t k = 0; k < 3; ++k) {
      const dvec3 p(scene.meshes[size_t(instance.mesh)].positions[vertices_of(number)[k]]);
      of[k] = dvec3(instance.world_from_object * glm::dvec4(p, 1));
    }
  }
  tree_ = TriangleTree(corners);
  const WorldBox box = world_box(scene);
  if (!box.empty()) far_m_ = 2 * (glm::length(box.max - box.min) + glm::length(view.eye - box.min));
}

std::array<uint32_t, 3> PrimaryRays::vertices_of(const CastingTriangle& t) const {
  const std::vector<uint32_t>& indices =
      scene_.meshes[size_t(scene_.instances[size_t(t.instance)].mesh)].indices;
  const size_t first = 3 * size_t(t.triangle);
  return {indices[first], indices[first + 1], indices[first + 2]};
}

template <typename Visit>
void PrimaryRays::each_hit(SceneSurfaces& surfaces, const dvec2& place, const Visit& visit) const {
  const dvec3 across(view_x_of_pixel(view_, place.x), view_y_of_pixel(view_, place.y), 0);
  const dvec3 ahead = view_.orthographic ? dvec3(0, 0, -1) : glm::normalize(across + dvec3(0, 0, -1));
  const dvec3 from = view_.orthographic ? across : dvec3(0), to = from + ahead * far_m_;
  const auto in_world = [&](const dvec3& p) {
    return view_.eye + glm::transpose(glm::dmat3(view_.view_from_world)) * p;
  };
  // The boxes' reach covers the rounding of the ray; the triangle decides.
  tree_.walk(in_world(from), in_world(to), 1e-9 * far_m_, [&](int number) {
    if (const std::optional<Hit> found = hit(surfaces, numbers_[size_t(number)], place)) visit(*found);
    return false;
  });
}

std::optional<PrimaryRays::Hit> PrimaryRays::at(SceneSurfaces& surfaces, const dvec2& place) const {
  std::optional<Hit> nearest;
  each_hit(surfaces, place, [&](const Hit& found) {
    if (!nearest || found.depth > nearest->depth) nearest = found;
  });
  return nearest;
}

std::vector<PrimaryRays::Hit> PrimaryRays::all_at(SceneSurfaces& surfaces, const dvec2& place,
                                                  double depth) const {
  std::vector<Hit> all;
  each_hit(surfaces, place, [&](const Hit& found) {
    if (found.depth >= depth) all.push_back(found);
  });
  std::ranges::stable_sort(all, {}, &Hit::depth);
  return all;
}

// None where the triangle is not drawn.
std::optional<PrimaryRays::Hit> PrimaryRays::hit(SceneSurfaces& surfaces, const CastingTriangle& t,
                                                 const dvec2& place) const {
  const Instance& instance = scene_.instances[size_t(t.instance)];
  const Material& material = scene_.materials[size_t(scene_.meshes[size_t(instance.mesh)].material)];
  const TriangleInView triangle = surfaces.triangle(t.instance, vertices_of(t));
  const dvec2 of_surfaces = place * dvec2(surfaces.size()) / dvec2(view_.width, view_.height);
  const auto depth = surfaces.depth_at(triangle, of_surfaces);
  if (!depth || !(*depth > 0 && *depth <= 1)) return {};
  const bool mirrored = is_mirroring(glm::dmat3(instance.world_from_object));
  if (!material.double_sided && (triangle.turn() < 0) != mirrored) return {};
  if (material.alpha_mode == AlphaMode::mask &&
      surfaces.base_color_at(triangle, of_surfaces).a < double(material.alpha_cutoff))
    return {};
  return Hit{t, triangle, *depth};
}

}  // namespace lightgrid::lab
