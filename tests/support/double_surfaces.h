// Surfaces of a scene in double: which triangle is nearest at a pixel, its attributes there, and its textures
// filtered as OpenGL 4.6 says (8.14), with mip levels averaged by area and derivatives from differences over
// a ten-thousandth of a pixel. Shares the plain structs that describe a scene with the renderer, and nothing
// else. Blended surfaces are left out.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "reference/shading.h"
#include "scene/camera.h"
#include "scene/scene.h"

namespace lightgrid::double_surfaces {

using glm::dvec2, glm::dvec3, glm::dvec4, glm::dmat3, glm::dmat4;

// --- Textures
// --------------------------------------------------------------------------------------------------------

struct Level {
  int width, height;
  std::vector<dvec4> texels;
};

inline double decoded(double s) { return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4); }

inline Level half_of(const Level& from) {
  Level to{std::max(from.width / 2, 1), std::max(from.height / 2, 1), {}};
  const double sx = double(from.width) / to.width, sy = double(from.height) / to.height;
  const auto overlap = [](double begin, double end, int i) {
    return std::max(std::min(end, i + 1.0) - std::max(begin, double(i)), 0.0);
  };
  for (int y = 0; y < to.height; ++y) {
    for (int x = 0; x < to.width; ++x) {
      dvec4 sum(0);
      for (int j = int(y * sy); j < from.height && j < (y + 1) * sy; ++j) {
        for (int i = int(x * sx); i < from.width && i < (x + 1) * sx; ++i) {
          sum += from.texels[size_t(j) * from.width + i] *
                 (overlap(x * sx, (x + 1) * sx, i) * overlap(y * sy, (y + 1) * sy, j) / (sx * sy));
        }
      }
      to.texels.push_back(sum);
    }
  }
  return to;
}

class Sampler {
 public:
  Sampler(const Scene& scene, const Texture& texture) : texture_(texture) {
    const Bitmap& bitmap = scene.bitmaps[texture.bitmap];
    Level level{bitmap.width, bitmap.height, {}};
    for (size_t i = 0; i < bitmap.rgba.size(); i += 4) {
      dvec4 texel;
      for (int c = 0; c < 4; ++c)
        texel[c] = texture.srgb && c < 3 ? decoded(bitmap.rgba[i + c] / 255.0) : bitmap.rgba[i + c] / 255.0;
      level.texels.push_back(texel);
    }
    levels_.push_back(std::move(level));
    const bool mips = texture.min_filter != Filter::nearest && texture.min_filter != Filter::linear;
    while (mips && std::max(levels_.back().width, levels_.back().height) > 1)
      levels_.push_back(half_of(levels_.back()));
  }

  dvec4 at(const dvec2& uv, const dvec2& right, const dvec2& up) const {
    const dvec2 size(levels_[0].width, levels_[0].height);
    const double lod = std::log2(std::max(glm::length(right * size), glm::length(up * size))),
                 last = double(levels_.size() - 1);
    const Filter f = texture_.min_filter;
    if (!(lod > 0)) return within(0, uv, texture_.mag_linear);
    const bool linear =
        f == Filter::linear || f == Filter::linear_mipmap_nearest || f == Filter::linear_mipmap_linear;
    if (f == Filter::nearest || f == Filter::linear) return within(0, uv, linear);
    if (f == Filter::nearest_mipmap_nearest || f == Filter::linear_mipmap_nearest) {
      return within(int(std::min(std::floor(lod + 0.5), last)), uv, linear);
    }
    const double level = std::min(lod, last), fine = std::floor(level);
    return glm::mix(within(int(fine), uv, linear), within(int(std::min(fine + 1, last)), uv, linear),
                    level - fine);
  }

 private:
  static int texel_of(double i, int size, Wrap wrap) {
    if (wrap == Wrap::clamp) return int(std::clamp(i, 0.0, size - 1.0));
    const double period = wrap == Wrap::repeat ? size : 2.0 * size, in = i - std::floor(i / period) * period;
    return in < size ? int(in) : int(2 * size - 1 - in);
  }
  dvec4 texel(const Level& level, double x, double y) const {
    return level.texels[size_t(texel_of(y, level.height, texture_.wrap_v)) * level.width +
                        texel_of(x, level.width, texture_.wrap_u)];
  }
  dvec4 within(int number, const dvec2& uv, bool linear) const {
    const Level& level = levels_[number];
    const dvec2 at = uv * dvec2(level.width, level.height);
    if (!linear) return texel(level, std::floor(at.x), std::floor(at.y));
    const dvec2 first = glm::floor(at - 0.5), t = at - 0.5 - first;
    return glm::mix(glm::mix(texel(level, first.x, first.y), texel(level, first.x + 1, first.y), t.x),
                    glm::mix(texel(level, first.x, first.y + 1), texel(level, first.x + 1, first.y + 1), t.x),
                    t.y);
  }

  const Texture& texture_;
  std::vector<Level> levels_;
};

// --- Triangles
// -------------------------------------------------------------------------------------------------------

// What is nearest at a pixel.
struct Hit {
  int instance = -1;      // of the scene; -1: nothing
  uint32_t triangle = 0;  // of its mesh
  double depth = 0;
};

class Surfaces {
 public:
  // `instances`: those that may be drawn, in drawing order.
  Surfaces(const Scene& scene, const View& view, const std::vector<int>& instances)
      : scene_(scene), view_(view) {
    hits_.resize(size_t(view.width) * view.height);
    for (const int instance : instances) draw(instance);
  }

  const std::vector<Hit>& hits() const { return hits_; }  // row 0 at the bottom

  // The surface in view space at a pixel that has one.
  Surface surface_at(uint32_t pixel) {
    const Hit& hit = hits_[pixel];
    const dvec2 at = centre_of(pixel);
    const Mesh& mesh = scene_.meshes[scene_.instances[hit.instance].mesh];
    const Material& m = scene_.materials[mesh.material];
    const dmat4 to_view =
        lightgrid::view_from_object(view_, scene_.instances[hit.instance].world_from_object);
    const dmat3 directions(to_view), normals = glm::transpose(glm::inverse(directions));
    const Corners corners = corners_of(hit);
    const dvec3 b = weights(corners, at);
    const auto mean = [&](const auto& values) {
      const uint32_t* index = &mesh.indices[3 * hit.triangle];
      return dvec4(glm::vec4(0)) + b[0] * wide(values[index[0]]) + b[1] * wide(values[index[1]]) +
             b[2] * wide(values[index[2]]);
    };
    const bool mirrored = glm::determinant(directions) < 0, back = (determinant_of(corners) < 0) != mirrored;
    Surface s;
    s.unlit = m.unlit;
    const dvec4 color = base_color(hit, at);
    s.base_color = dvec3(color);
    if (m.unlit) return s;
    s.metallic = m.metallic, s.roughness = m.roughness, s.emissive = m.emissive;
    if (m.metallic_roughness_map.texture >= 0) {
      const dvec4 t = sampled(m.metallic_roughness_map, hit, at);
      s.roughness *= t.g, s.metallic *= t.b;
    }
    if (m.occlusion_map.texture >= 0)
      s.occlusion = 1 + m.occlusion_strength * (sampled(m.occlusion_map, hit, at).r - 1);
    if (m.emissive_map.texture >= 0) s.emissive *= dvec3(sampled(m.emissive_map, hit, at));
    const dvec3 geometric = glm::normalize(normals * dvec3(mean(mesh.normals)));
    const auto bent = [&](const TextureSlot& map, double scale) {
      dvec3 n = geometric;
      if (map.texture < 0) return back ? -n : n;
      const dvec4 tangent = mean(mesh.tangents);
      dvec3 t = directions * dvec3(tangent);
      t -= n * glm::dot(n, t);
      if (glm::dot(t, t) > 1e-12) {
        t = glm::normalize(t);
        const dvec3 bitangent = glm::cross(n, t) * tangent.w * (mirrored ? -1.0 : 1.0);
        dvec3 mapped = dvec3(sampled(map, hit, at)) * 2.0 - 1.0;
        mapped.x *= scale, mapped.y *= scale;
        n = glm::normalize(mapped.x * t + mapped.y * bitangent + mapped.z * n);
      }
      return back ? -n : n;
    };
    s.normal = bent(m.normal_map, m.normal_scale);
    const double slower = m.ior, root = (slower - 1) / (slower + 1);
    dvec3 color_of_f0 = m.specular_color;
    s.f90 = m.specular;
    if (m.specular_map.texture >= 0) s.f90 *= sampled(m.specular_map, hit, at).a;
    if (m.specular_color_map.texture >= 0) color_of_f0 *= dvec3(sampled(m.specular_color_map, hit, at));
    s.f0 = glm::min(color_of_f0 * root * root, dvec3(1)) * s.f90;
    s.subsurface_color = m.model.subsurface_color, s.roll_off = m.model.roll_off,
    s.minnaert_k = m.model.minnaert_k;
    if (m.clearcoat == 0) return s;
    s.coat = m.clearcoat, s.coat_roughness = m.clearcoat_roughness;
    if (m.clearcoat_map.texture >= 0) s.coat *= sampled(m.clearcoat_map, hit, at).r;
    if (m.clearcoat_roughness_map.texture >= 0)
      s.coat_roughness *= sampled(m.clearcoat_roughness_map, hit, at).g;
    s.coat_normal = bent(m.clearcoat_normal_map, m.clearcoat_normal_scale);
    return s;
  }

 private:
  using Corners = std::array<dvec4, 3>;  // clip space

  static dvec4 wide(const glm::vec2& v) { return {v.x, v.y, 0, 0}; }
  static dvec4 wide(const glm::vec3& v) { return {v.x, v.y, v.z, 0}; }
  static dvec4 wide(const glm::vec4& v) { return v; }

  dvec2 centre_of(uint32_t pixel) const {
    return {pixel % uint32_t(view_.width) + 0.5, pixel / uint32_t(view_.width) + 0.5};
  }

  Corners corners_of(const Hit& hit) const {
    const Instance& instance = scene_.instances[hit.instance];
    const Mesh& mesh = scene_.meshes[instance.mesh];
    const dmat4 clip = view_.clip_from_view * lightgrid::view_from_object(view_, instance.world_from_object);
    Corners corners;
    for (int k = 0; k < 3; ++k)
      corners[k] = clip * dvec4(dvec3(mesh.positions[mesh.indices[3 * hit.triangle + k]]), 1);
    return corners;
  }

  static double determinant_of(const Corners& c) {
    const auto xyw = [](const dvec4& v) { return dvec3(v.x, v.y, v.w); };
    return glm::determinant(dmat3(xyw(c[0]), xyw(c[1]), xyw(c[2])));
  }

  // Of the corners at a place on the screen, pixels: the solution of corners * weights = the place, scaled to
  // a sum of 1. `scale`: their sum before that.
  dvec3 weights(const Corners& c, const dvec2& at, double* scale = nullptr) const {
    const dvec3 place(2 * at.x / view_.width - 1, 2 * at.y / view_.height - 1, 1);
    const auto xyw = [](const dvec4& v) { return dvec3(v.x, v.y, v.w); };
    const dvec3 w = glm::inverse(dmat3(xyw(c[0]), xyw(c[1]), xyw(c[2]))) * place;
    if (scale) *scale = w.x + w.y + w.z;
    return w / (w.x + w.y + w.z);
  }

  const Sampler& sampler(int texture) {
    auto found = samplers_.find(texture);
    if (found == samplers_.end())
      found = samplers_.try_emplace(texture, scene_, scene_.textures[texture]).first;
    return found->second;
  }

  dvec2 uv_at(const TextureSlot& slot, const Hit& hit, const Corners& corners, const dvec2& at) const {
    const Mesh& mesh = scene_.meshes[scene_.instances[hit.instance].mesh];
    const std::vector<glm::vec2>& set = slot.uv_set == 1 ? mesh.uv1 : mesh.uv0;
    const dvec3 b = weights(corners, at);
    dvec2 uv(0);
    for (int k = 0; k < 3 && !set.empty(); ++k) uv += b[k] * dvec2(set[mesh.indices[3 * hit.triangle + k]]);
    return glm::dmat3x2(slot.uv_from_vertex) * dvec3(uv, 1);
  }

  dvec4 sampled(const TextureSlot& slot, const Hit& hit, const dvec2& at) {
    const Corners corners = corners_of(hit);
    constexpr double step = 1e-4;
    const auto uv = [&](double dx, double dy) { return uv_at(slot, hit, corners, at + dvec2(dx, dy)); };
    return sampler(slot.texture)
        .at(uv(0, 0), (uv(step, 0) - uv(-step, 0)) / (2 * step), (uv(0, step) - uv(0, -step)) / (2 * step));
  }

  dvec4 base_color(const Hit& hit, const dvec2& at) {
    const Mesh& mesh = scene_.meshes[scene_.instances[hit.instance].mesh];
    const Material& m = scene_.materials[mesh.material];
    dvec4 color(m.base_color);
    if (m.base_color_map.texture >= 0) color *= sampled(m.base_color_map, hit, at);
    if (!mesh.colors.empty()) {
      const dvec3 b = weights(corners_of(hit), at);
      dvec4 mean(0);
      for (int k = 0; k < 3; ++k) mean += b[k] * dvec4(mesh.colors[mesh.indices[3 * hit.triangle + k]]);
      color *= mean;
    }
    return color;
  }

  void draw(int number) {
    const Instance& instance = scene_.instances[number];
    const Mesh& mesh = scene_.meshes[instance.mesh];
    const Material& m = scene_.materials[mesh.material];
    const bool mirrored = glm::determinant(dmat3(instance.world_from_object)) < 0;
    for (uint32_t t = 0; t < mesh.indices.size() / 3; ++t) {
      const Hit hit{number, t, 0};
      const Corners c = corners_of(hit);
      const double turn = determinant_of(c) * (mirrored ? -1 : 1);
      if (turn == 0 || (turn < 0 && !m.double_sided)) continue;
      // All in front of the eye: the pixels between the corners. Else all of them.
      dvec2 low(0), high(view_.width - 1, view_.height - 1);
      if (c[0].w > 1e-6 && c[1].w > 1e-6 && c[2].w > 1e-6) {
        dvec2 least(1e30), most(-1e30);
        for (const dvec4& v : c) {
          const dvec2 pixel = (dvec2(v) / v.w * 0.5 + 0.5) * dvec2(view_.width, view_.height);
          least = glm::min(least, pixel), most = glm::max(most, pixel);
        }
        low = glm::max(low, glm::floor(least) - 1.0), high = glm::min(high, glm::ceil(most));
      }
      for (int y = int(low.y); y <= int(high.y); ++y) {
        for (int x = int(low.x); x <= int(high.x); ++x) {
          double scale = 0;
          const dvec3 b = weights(c, {x + 0.5, y + 0.5}, &scale);
          if (!(scale > 0) || b.x < 0 || b.y < 0 || b.z < 0) continue;
          const double depth = (b.x * c[0].z + b.y * c[1].z + b.z * c[2].z) * scale;
          Hit& nearest = hits_[size_t(y) * view_.width + x];
          if (!(depth > nearest.depth) || depth > 1) continue;
          if (m.alpha_mode == AlphaMode::mask && base_color(hit, {x + 0.5, y + 0.5}).a < m.alpha_cutoff)
            continue;
          nearest = {number, t, depth};
        }
      }
    }
  }

  const Scene& scene_;
  const View& view_;
  std::vector<Hit> hits_;
  std::map<int, Sampler> samplers_;
};

}  // namespace lightgrid::double_surfaces
