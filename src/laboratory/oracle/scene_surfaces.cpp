#include "oracle/scene_surfaces.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/facing.h"

namespace lightgrid::lab {
namespace {

using glm::dvec2, glm::dvec3, glm::dvec4, glm::dmat3, glm::dmat4;

dmat3 xyw_of(const std::array<dvec4, 3>& corners) {
  const auto xyw = [](const dvec4& c) { return dvec3(c.x, c.y, c.w); };
  return {xyw(corners[0]), xyw(corners[1]), xyw(corners[2])};
}

// The weighted mean of values at vertices.
template <typename Values>
auto mean(const TriangleInView& triangle, const dvec3& weights, const Values& values) {
  using Wide = glm::vec<Values::value_type::length(), double>;
  Wide sum(0);
  for (int k = 0; k < 3; ++k) sum += weights[k] * Wide(values[triangle.vertices[k]]);
  return sum;
}

// IEC 61966-2-1.
double decoded(double s) { return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4); }

const std::array<double, 256>& values_of_bytes(bool srgb) {
  static const auto tables = [] {
    std::array<std::array<double, 256>, 2> made{};
    for (int i = 0; i < 256; ++i) {
      made[0][i] = i / 255.0;
      made[1][i] = decoded(i / 255.0);
    }
    return made;
  }();
  return tables[srgb];
}

bool has_levels(Filter f) { return f != Filter::nearest && f != Filter::linear; }

bool linear_within_level(Filter f) {
  return f == Filter::linear || f == Filter::linear_mipmap_nearest || f == Filter::linear_mipmap_linear;
}

bool nearest_level(Filter f) {
  return f == Filter::nearest_mipmap_nearest || f == Filter::linear_mipmap_nearest;
}

int wrapped(double i, int size, Wrap wrap) {
  if (wrap == Wrap::clamp) return int(std::clamp(i, 0.0, size - 1.0));
  const double period = wrap == Wrap::repeat ? size : 2.0 * size, in = i - std::floor(i / period) * period;
  return in < size ? int(in) : int(2 * size - 1 - in);
}

}  // namespace

TextureSampler::TextureSampler(const Bitmap& bitmap, const Texture& texture)
    : bitmap_(bitmap), texture_(texture) {
  columns_.sizes = {bitmap.width};
  rows_.sizes = {bitmap.height};
  while (has_levels(texture.min_filter) && std::max(columns_.sizes.back(), rows_.sizes.back()) > 1) {
    for (Side* side : {&columns_, &rows_}) side->sizes.push_back(std::max(side->sizes.back() / 2, 1));
  }
  for (Side* side : {&columns_, &rows_}) side->shares.resize(side->sizes.size());
}

// The average of a rectangle is that of its columns and of its rows, one after the other.
const TextureSampler::Share& TextureSampler::Side::share(int level, int texel) {
  std::vector<Share>& made = shares[level];
  if (made.empty() && level == 0) {
    for (int i = 0; i < sizes[0]; ++i) made.push_back({i, {1}});
  } else if (made.empty()) {
    const double covered = double(sizes[level - 1]) / sizes[level];  // texels of the level before
    for (int i = 0; i < sizes[level]; ++i) {
      const double begin = i * covered, end = begin + covered;
      Share sum{share(level - 1, int(begin)).first, {}};
      for (int k = int(begin); k < sizes[level - 1] && k < end; ++k) {
        const double weight = (std::min(end, k + 1.0) - std::max(begin, double(k))) / covered;
        const Share& part = share(level - 1, k);
        const size_t offset = size_t(part.first - sum.first);
        sum.of_texel.resize(std::max(sum.of_texel.size(), offset + part.of_texel.size()));
        for (size_t j = 0; j < part.of_texel.size(); ++j)
          sum.of_texel[offset + j] += weight * part.of_texel[j];
      }
      made.push_back(std::move(sum));
    }
  }
  return made[texel];
}

dvec4 TextureSampler::stored(int x, int y) const {
  const uint8_t* bytes = &bitmap_.rgba[4 * (size_t(y) * bitmap_.width + x)];
  const auto& color = values_of_bytes(texture_.srgb);
  return {color[bytes[0]], color[bytes[1]], color[bytes[2]], bytes[3] / 255.0};
}

dvec4 TextureSampler::texel(int level, double x, double y) {
  const int column = wrapped(x, columns_.sizes[level], texture_.wrap_u),
            row = wrapped(y, rows_.sizes[level], texture_.wrap_v);
  if (level == 0) return stored(column, row);
  const uint64_t key = uint64_t(level) << 58 | uint64_t(row) << 29 | uint64_t(column);
  const auto [found, added] = averages_.try_emplace(key, dvec4(0));
  if (!added) return found->second;
  const Share &across = columns_.share(level, column), &down = rows_.share(level, row);
  dvec4 sum(0);
  for (size_t j = 0; j < down.of_texel.size(); ++j) {
    dvec4 of_row(0);
    for (size_t i = 0; i < across.of_texel.size(); ++i)
      of_row += across.of_texel[i] * stored(across.first + int(i), down.first + int(j));
    sum += down.of_texel[j] * of_row;
  }
  return found->second = sum;
}

dvec4 TextureSampler::filtered(int level, const dvec2& uv, bool linear) {
  const dvec2 at = uv * dvec2(columns_.sizes[level], rows_.sizes[level]);
  if (!linear) return texel(level, std::floor(at.x), std::floor(at.y));
  const dvec2 first = glm::floor(at - 0.5), t = at - 0.5 - first;
  const auto mixed_row = [&](double y) {
    return glm::mix(texel(level, first.x, y), texel(level, first.x + 1, y), t.x);
  };
  return glm::mix(mixed_row(first.y), mixed_row(first.y + 1), t.y);
}

dvec4 TextureSampler::at(const dvec2& uv, const dvec2& right, const dvec2& up) {
  const dvec2 size(bitmap_.width, bitmap_.height);
  const double detail = std::log2(std::max(glm::length(right * size), glm::length(up * size))),
               last = double(columns_.sizes.size() - 1);
  const Filter filter = texture_.min_filter;
  if (!(detail > 0)) return filtered(0, uv, texture_.mag_linear);
  const bool linear = linear_within_level(filter);
  if (!has_levels(filter)) return filtered(0, uv, linear);
  if (nearest_level(filter)) return filtered(int(std::min(std::floor(detail + 0.5), last)), uv, linear);
  const double level = std::min(detail, last), fine = std::floor(level);
  return glm::mix(filtered(int(fine), uv, linear), filtered(int(std::min(fine + 1, last)), uv, linear),
                  level - fine);
}

// The corners' weights at a place, and their change from there to the next pixel.
struct SceneSurfaces::Weights {
  dvec3 here, right, up;  // the first adds up to 1, the others to 0
  dvec3 unscaled;         // corners * unscaled: the place, with w = 1
};

double TriangleInView::turn() const { return glm::determinant(xyw_of(corners)); }

TriangleInView SceneSurfaces::triangle(int instance, const std::array<uint32_t, 3>& vertices) const {
  const Instance& shown = scene_.instances[instance];
  const dmat4 clip = view_.clip_from_view * view_from_object(view_, shown.world_from_object);
  TriangleInView made{instance, vertices, {}};
  for (int k = 0; k < 3; ++k)
    made.corners[k] = clip * dvec4(dvec3(scene_.meshes[shown.mesh].positions[vertices[k]]), 1);
  return made;
}

// Solves corners * weights = place, which is linear in the place, and divides by the sum.
SceneSurfaces::Weights SceneSurfaces::weights_at(const TriangleInView& triangle, const dvec2& place) const {
  const dmat3 solve = glm::inverse(xyw_of(triangle.corners));
  const dvec3 w = solve * dvec3(2 * place.x / view_.width - 1, 2 * place.y / view_.height - 1, 1);
  const dvec3 dx = solve[0] * (2.0 / view_.width), dy = solve[1] * (2.0 / view_.height);
  const auto sum = [](const dvec3& v) { return v.x + v.y + v.z; };
  const dvec3 here = w / sum(w);
  return {here, (dx - here * sum(dx)) / sum(w), (dy - here * sum(dy)) / sum(w), w};
}

std::optional<double> SceneSurfaces::depth_at(const TriangleInView& triangle, const dvec2& place) const {
  const Weights w = weights_at(triangle, place);
  if (!(w.unscaled.x >= 0 && w.unscaled.y >= 0 && w.unscaled.z >= 0)) return {};
  if (!(w.unscaled.x + w.unscaled.y + w.unscaled.z > 0)) return {};
  const auto& c = triangle.corners;
  return w.unscaled.x * c[0].z + w.unscaled.y * c[1].z + w.unscaled.z * c[2].z;
}

dvec4 SceneSurfaces::sampled(const TextureSlot& slot, const TriangleInView& triangle, const Weights& w) {
  const Mesh& mesh = scene_.meshes[scene_.instances[triangle.instance].mesh];
  const std::vector<glm::vec2>& set = slot.uv_set == 1 ? mesh.uv1 : mesh.uv0;
  auto found = samplers_.find(slot.texture);
  if (found == samplers_.end()) {
    const Texture& texture = scene_.textures[slot.texture];
    found = samplers_.try_emplace(slot.texture, scene_.bitmaps[texture.bitmap], texture).first;
  }
  const glm::dmat3x2 uv_from_vertex(slot.uv_from_vertex);
  const auto uv = [&](const dvec3& weights, double offset) {
    return uv_from_vertex * dvec3(set.empty() ? dvec2(0) : mean(triangle, weights, set), offset);
  };
  return found->second.at(uv(w.here, 1), uv(w.right, 0), uv(w.up, 0));
}

dvec4 SceneSurfaces::color_of(const TriangleInView& triangle, const Weights& w) {
  const Mesh& mesh = scene_.meshes[scene_.instances[triangle.instance].mesh];
  const Material& m = scene_.materials[mesh.material];
  dvec4 color(m.base_color);
  if (m.base_color_map.texture >= 0) color *= sampled(m.base_color_map, triangle, w);
  if (!mesh.colors.empty()) color *= mean(triangle, w.here, mesh.colors);
  return color;
}

dvec4 SceneSurfaces::base_color_at(const TriangleInView& triangle, const dvec2& place) {
  return color_of(triangle, weights_at(triangle, place));
}

Surface SceneSurfaces::surface_at(const TriangleInView& triangle, const dvec2& place) {
  const Weights w = weights_at(triangle, place);
  const Instance& instance = scene_.instances[triangle.instance];
  const Mesh& mesh = scene_.meshes[instance.mesh];
  const Material& m = scene_.materials[mesh.material];
  Surface s;
  s.unlit = m.unlit;
  s.mask = mask_of(instance);
  s.base_color = dvec3(color_of(triangle, w));
  if (m.unlit) return s;
  s.metallic = m.metallic;
  s.roughness = m.roughness;
  s.emissive = m.emissive;
  if (m.metallic_roughness_map.texture >= 0) {
    const dvec4 texel = sampled(m.metallic_roughness_map, triangle, w);
    s.roughness *= texel.g;
    s.metallic *= texel.b;
  }
  if (m.occlusion_map.texture >= 0)
    s.occlusion = 1 + m.occlusion_strength * (sampled(m.occlusion_map, triangle, w).r - 1);
  if (m.emissive_map.texture >= 0) s.emissive *= dvec3(sampled(m.emissive_map, triangle, w));

  const dmat3 directions(view_from_object(view_, instance.world_from_object));
  const bool mirrored = is_mirroring(dmat3(instance.world_from_object)),
             back = (triangle.turn() < 0) != mirrored;
  const dvec3 geometric =
      glm::normalize(normal_matrix(directions, mirrored) * mean(triangle, w.here, mesh.normals));
  const auto bent = [&](const TextureSlot& map, double scale) {
    dvec3 n = geometric;
    if (map.texture < 0) return back ? -n : n;
    const dvec4 tangent = mean(triangle, w.here, mesh.tangents);
    dvec3 t = directions * dvec3(tangent);
    t -= n * glm::dot(n, t);
    if (glm::dot(t, t) > 1e-12) {
      t = glm::normalize(t);
      const dvec3 bitangent = glm::cross(n, t) * tangent.w * (mirrored ? -1.0 : 1.0);
      dvec3 mapped = dvec3(sampled(map, triangle, w)) * 2.0 - 1.0;
      mapped.x *= scale;
      mapped.y *= scale;
      n = glm::normalize(mapped.x * t + mapped.y * bitangent + mapped.z * n);
    }
    return back ? -n : n;
  };
  s.normal = bent(m.normal_map, m.normal_scale);
  const double root = (m.ior - 1.0) / (m.ior + 1.0);
  dvec3 color_of_f0 = m.specular_color;
  s.f90 = m.specular;
  if (m.specular_map.texture >= 0) s.f90 *= sampled(m.specular_map, triangle, w).a;
  if (m.specular_color_map.texture >= 0) color_of_f0 *= dvec3(sampled(m.specular_color_map, triangle, w));
  s.f0 = glm::min(color_of_f0 * root * root, dvec3(1)) * s.f90;
  s.subsurface_color = m.model.subsurface_color;
  s.roll_off = m.model.roll_off;
  s.minnaert_k = m.model.minnaert_k;
  if (m.clearcoat == 0) return s;
  s.coat = m.clearcoat;
  s.coat_roughness = m.clearcoat_roughness;
  if (m.clearcoat_map.texture >= 0) s.coat *= sampled(m.clearcoat_map, triangle, w).r;
  if (m.clearcoat_roughness_map.texture >= 0)
    s.coat_roughness *= sampled(m.clearcoat_roughness_map, triangle, w).g;
  s.coat_normal = bent(m.clearcoat_normal_map, m.clearcoat_normal_scale);
  return s;
}

}  // namespace lightgrid::lab
