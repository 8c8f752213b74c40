#include "oracle/mask_cover.h"

#include <algorithm>
#include <cmath>

#include "oracle/signed_volume.h"

namespace lightgrid::lab {
namespace {

using glm::dvec2, glm::dvec3;

// Rounding of a lookup in float: sixteen operations on values of this size.
constexpr double of_lookup = 16 * float_rounding;

const Material& material_of(const Scene& scene, int instance) {
  return scene.materials[scene.meshes[scene.instances[instance].mesh].material];
}

// Where a filter's piecewise linear (or constant) rows begin anew: at the ends of [x - error, x + error] and
// at the texels' centres (edges) between, in texels. Empty if there are too many.
std::vector<double> places_in(double x, double error, bool linear) {
  const double low = x - error, high = x + error, shift = linear ? 0.5 : 0;
  if (!(high - low <= 2)) return {};
  std::vector<double> places = {low, high};
  for (double k = std::ceil(low - shift); k + shift < high; ++k) places.push_back(k + shift);
  return places;
}

}  // namespace

MaskCover::MaskCover(const Scene& scene) : scene_(scene) {
  for (const Instance& instance : scene.instances) {
    const Material& m = scene.materials[scene.meshes[instance.mesh].material];
    const int texture = m.base_color_map.texture;
    if (m.alpha_mode != AlphaMode::opaque && texture >= 0)
      samplers_.try_emplace(texture, scene.bitmaps[scene.textures[texture].bitmap], scene.textures[texture]);
  }
}

// A bilinear function has its extremes over a rectangle at the corners.
MaskCover::Range MaskCover::alpha_of_map(const TextureSlot& slot, const dvec2& uv, const dvec2& error) const {
  const Texture& texture = scene_.textures[slot.texture];
  const Bitmap& bitmap = scene_.bitmaps[texture.bitmap];
  const dvec2 size(bitmap.width, bitmap.height);
  const std::vector<double> columns = places_in(uv.x * size.x, error.x * size.x, texture.mag_linear),
                            rows = places_in(uv.y * size.y, error.y * size.y, texture.mag_linear);
  if (columns.empty() || rows.empty()) return {0, 1};
  TextureSampler& sampler = samplers_.at(slot.texture);
  Range range{1, 0};
  for (const double x : columns) {
    for (const double y : rows) {
      const double alpha = sampler.at(dvec2(x, y) / size, dvec2(0), dvec2(0)).a;
      range.least = std::min(range.least, alpha);
      range.most = std::max(range.most, alpha);
    }
  }
  return range;
}

Cover MaskCover::at(int instance, uint32_t triangle, const dvec3& weights, const dvec3& error) const {
  const Material& m = material_of(scene_, instance);
  if (m.alpha_mode != AlphaMode::mask) return Cover::opaque;
  const Range range = alpha(instance, triangle, weights, error);
  if (range.least >= m.alpha_cutoff) return Cover::opaque;
  return range.most < m.alpha_cutoff ? Cover::clear : Cover::either;
}

MaskCover::Range MaskCover::alpha(int instance, uint32_t triangle, const dvec3& weights,
                                  const dvec3& error) const {
  const Material& m = material_of(scene_, instance);
  const Mesh& mesh = scene_.meshes[scene_.instances[instance].mesh];
  const uint32_t* v = &mesh.indices[3 * size_t(triangle)];
  double alpha = m.base_color.a, factor_error = 0;
  if (!mesh.colors.empty()) {
    double color = 0, color_error = 0;
    for (int k = 0; k < 3; ++k) {
      color += weights[k] * mesh.colors[v[k]].a;
      color_error += error[k] * std::abs(mesh.colors[v[k]].a);
    }
    factor_error = color_error * std::abs(alpha);
    alpha *= color;
  }
  Range range{1, 1};
  if (m.base_color_map.texture >= 0) {
    const TextureSlot& slot = m.base_color_map;
    const std::vector<glm::vec2>& set = slot.uv_set == 1 ? mesh.uv1 : mesh.uv0;
    const glm::dmat3x2 place_of(slot.uv_from_vertex);
    dvec2 uv = place_of[2], uv_error = of_lookup * glm::abs(uv);
    for (int k = 0; k < 3 && !set.empty(); ++k) {
      const dvec2 corner = glm::dmat2(place_of) * dvec2(set[v[k]]);
      uv += weights[k] * corner;
      uv_error += error[k] * glm::abs(corner - glm::dmat2(place_of) * dvec2(set[v[0]])) +
                  of_lookup * (glm::abs(place_of[0] * double(set[v[k]].x)) +
                               glm::abs(place_of[1] * double(set[v[k]].y)));
    }
    range = alpha_of_map(slot, uv, uv_error);
  }
  const double slack = factor_error + of_lookup * (std::abs(alpha) + 1);
  return {alpha * range.least - slack, alpha * range.most + slack};
}

}  // namespace lightgrid::lab
