#include "renderer/upload/scene_surfaces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <set>

#include "base/error.h"
#include "plan/settings/surfaces.h"
#include "renderer/upload/texel_chain.h"

namespace lightgrid {
namespace {

constexpr int packable = 3;  // base colour, metallic-roughness, normal

std::array<const TextureSlot*, SURFACE_MAPS> maps_of(const Material& m) {
  return {&m.base_color_map,          &m.metallic_roughness_map, &m.normal_map,
          &m.occlusion_map,           &m.emissive_map,           &m.clearcoat_map,
          &m.clearcoat_roughness_map, &m.clearcoat_normal_map,   &m.specular_map,
          &m.specular_color_map};
}

// An unlit surface does not read the maps that lighting needs.
bool reads_map(const Material& m, int map) {
  if (m.unlit) return map == SURFACE_BASE_COLOR;
  if (map >= SURFACE_SPECULAR) return has_specular(m);
  return map < SURFACE_COAT || m.clearcoat > 0;
}

bool has_mips(const Texture& texture) {
  return texture.min_filter != Filter::nearest && texture.min_filter != Filter::linear;
}

uint sampler_flags(const Texture& t) {
  uint flags = 0;
  if (t.wrap_u != Wrap::repeat) flags |= t.wrap_u == Wrap::clamp ? MAP_CLAMP_U : MAP_MIRROR_U;
  if (t.wrap_v != Wrap::repeat) flags |= t.wrap_v == Wrap::clamp ? MAP_CLAMP_V : MAP_MIRROR_V;
  if (!t.mag_linear) flags |= MAP_MAGNIFY_NEAREST;
  const Filter f = t.min_filter;
  if (f == Filter::nearest || f == Filter::nearest_mipmap_nearest || f == Filter::nearest_mipmap_linear) {
    flags |= MAP_MINIFY_NEAREST;
  }
  if (f == Filter::nearest_mipmap_nearest || f == Filter::linear_mipmap_nearest) flags |= MAP_LEVEL_NEAREST;
  return flags;
}

// A chain's contents, without the place where it lies.
struct PlacedChain {
  uint base;
  TexelChain chain;  // without its values
};

class TexelWriter {
 public:
  TexelWriter(const Scene& scene, TexelLayout layout, bool blended_alphas, SurfaceTexels& out)
      : scene_(scene), layout_(layout), blended_alphas_(blended_alphas), out_(out) {}

  void add_textures(const Material& m, SurfaceMaterial& record) {
    const auto maps = maps_of(m);
    const bool packed = packs(m);
    for (int i = 0; i < SURFACE_MAPS; ++i) {
      if (maps[i]->texture < 0 || !reads_map(m, i)) continue;
      record.flags |= 1u << i;
      if (!packed || i >= packable) record.maps[i] = map(*maps[i], chain_of(maps[i]->texture));
    }
    if (packed) {
      record.flags |= SURFACE_PACKED;
      record.maps[0] = map(*packed_maps(m).front(), packed_chain(m));
    }
    const bool alphas =
        m.alpha_mode == AlphaMode::mask || (blended_alphas_ && m.alpha_mode == AlphaMode::blend);
    if (alphas && m.base_color_map.texture >= 0) record.alpha_base = alphas_of(m.base_color_map.texture);
  }

  // Makes room for the chains of these materials: a vector that grows by doubling would hold up to three
  // times as much while it is copied.
  void reserve(const std::vector<Material>& materials, const std::vector<bool>& used) {
    std::set<int> separate;
    std::set<std::array<int, packable>> packed;
    size_t texels_4 = 0, texels_8 = 0;
    for (size_t k = 0; k < materials.size(); ++k) {
      if (!used[k]) continue;
      const Material& m = materials[k];
      const auto maps = maps_of(m);
      const bool packs_first = packs(m);
      if (packs_first && packed.insert(key_of(m)).second)
        texels_8 += texels_of(packed_maps(m).front()->texture);
      for (int i = packs_first ? packable : 0; i < SURFACE_MAPS; ++i)
        if (maps[i]->texture >= 0 && reads_map(m, i) && separate.insert(maps[i]->texture).second)
          texels_4 += texels_of(maps[i]->texture);
    }
    out_.texels_4.reserve(4 * texels_4);
    layout_ == TexelLayout::packed_8 ? out_.small_texels_8.reserve(8 * texels_8)
                                     : out_.texels_8.reserve(8 * texels_8);
  }

 private:
  // A packed texel has no alpha, which blending takes from the base colour.
  bool packs(const Material& m) const {
    return !m.unlit && m.alpha_mode != AlphaMode::blend && layout_ != TexelLayout::separate && can_pack(m);
  }

  static std::array<int, packable> key_of(const Material& m) {
    return {m.base_color_map.texture, m.metallic_roughness_map.texture, m.normal_map.texture};
  }

  // The number of texels in a texture's chain.
  size_t texels_of(int texture) const {
    const Bitmap& bitmap = scene_.bitmaps[scene_.textures[texture].bitmap];
    size_t texels = 0;
    for (int width = bitmap.width, height = bitmap.height;;
         width = std::max(width / 2, 1), height = std::max(height / 2, 1)) {
      texels += size_t(width + 1) * size_t(height + 1);
      if (!has_mips(scene_.textures[texture]) || std::max(width, height) == 1) return texels;
    }
  }

  const Texture& texture_of(const TextureSlot& slot) const { return scene_.textures[slot.texture]; }
  const Bitmap& bitmap_of(const TextureSlot& slot) const { return scene_.bitmaps[texture_of(slot).bitmap]; }

  // The material's maps that fit into a packed texel.
  static std::vector<const TextureSlot*> packed_maps(const Material& m) {
    std::vector<const TextureSlot*> slots;
    for (const TextureSlot* slot : {&m.base_color_map, &m.metallic_roughness_map, &m.normal_map}) {
      if (slot->texture >= 0) slots.push_back(slot);
    }
    return slots;
  }

  bool looked_up_alike(const TextureSlot& a, const TextureSlot& b) const {
    const Bitmap &p = bitmap_of(a), &q = bitmap_of(b);
    const Texture &s = texture_of(a), &t = texture_of(b);
    return p.width == q.width && p.height == q.height && sampler_flags(s) == sampler_flags(t) &&
           has_mips(s) == has_mips(t) && a.uv_set == b.uv_set && a.uv_from_vertex == b.uv_from_vertex;
  }

  bool can_pack(const Material& m) const {
    const auto slots = packed_maps(m);
    const auto alike = [&](const TextureSlot* slot) { return looked_up_alike(*slot, *slots[0]); };
    return slots.size() > 1 && std::all_of(slots.begin(), slots.end(), alike);
  }

  SurfaceMap map(const TextureSlot& slot, const PlacedChain& placed) const {
    SurfaceMap record{};
    record.base = placed.base;
    record.width = placed.chain.width;
    record.height = placed.chain.height;
    record.last_level = placed.chain.last_level;
    std::copy(placed.chain.level_first.begin(), placed.chain.level_first.end(), record.level_first);
    record.flags = sampler_flags(texture_of(slot));
    if (slot.uv_set == 1) record.flags |= MAP_UV1;
    if (slot.transformed()) record.flags |= MAP_TRANSFORM;
    static_assert(sizeof slot.uv_from_vertex == sizeof record.uv_linear + sizeof record.uv_offset);
    std::memcpy(record.uv_linear, &slot.uv_from_vertex[0], sizeof record.uv_linear);
    std::memcpy(record.uv_offset, &slot.uv_from_vertex[2], sizeof record.uv_offset);
    return record;
  }

  static PlacedChain append(TexelChain chain, size_t channels, BufferVector<uint16_t>& to) {
    const size_t first = to.size() / channels, end = first + chain.values.size() / channels;
    if (end > 0x7fffffffu) throw machine_error("textures: more than 2^31 texels for the resolve pass");
    to.insert(to.end(), chain.values.begin(), chain.values.end());
    std::vector<uint16_t>().swap(chain.values);  // frees its memory
    return {uint(first), std::move(chain)};
  }

  // Packed chains as bytes.
  static PlacedChain append_small(TexelChain chain, BufferVector<uint8_t>& to) {
    static const std::vector<uint8_t> roots = [] {
      std::vector<uint8_t> bytes(65536);
      for (size_t i = 0; i < bytes.size(); ++i)
        bytes[i] = uint8_t(std::lround(255 * std::sqrt(double(i) / 65535)));
      return bytes;
    }();
    const size_t first = to.size() / 8;
    if (first + chain.values.size() / 8 > 0x7fffffffu)
      throw machine_error("textures: more than 2^31 texels for the resolve pass");
    to.reserve(to.size() + chain.values.size());
    for (size_t i = 0; i < chain.values.size(); ++i) {
      const uint16_t value = chain.values[i];
      to.push_back(i % 8 < 3 ? roots[value] : uint8_t((value + 128) / 257));
    }
    std::vector<uint16_t>().swap(chain.values);  // frees its memory
    return {uint(first), std::move(chain)};
  }

  TexelChain make_texture_chain(int texture) const {
    const Texture& t = scene_.textures[texture];
    return make_chain(linear_texels(scene_.bitmaps[t.bitmap], t.srgb), t.wrap_u, t.wrap_v, has_mips(t));
  }

  const PlacedChain& chain_of(int texture) {
    const auto found = chains_.find(texture);
    if (found != chains_.end()) return found->second;
    return chains_.emplace(texture, append(make_texture_chain(texture), 4, out_.texels_4)).first->second;
  }

  const PlacedChain& packed_chain(const Material& m) {
    const std::array<int, packable> key = key_of(m);
    const auto found = packed_.find(key);
    if (found != packed_.end()) return found->second;
    const TextureSlot& first = *packed_maps(m).front();
    TexelImage image{bitmap_of(first).width, bitmap_of(first).height, 8, {}};
    image.values.assign(size_t(image.width) * image.height * 8, 65535);
    const auto put = [&](const TextureSlot& slot, std::initializer_list<std::pair<int, int>> channels) {
      if (slot.texture < 0) return;
      const TexelImage from = linear_texels(bitmap_of(slot), texture_of(slot).srgb);
      for (size_t i = 0; i < from.values.size() / 4; ++i) {
        for (const auto& [source, target] : channels)
          image.values[8 * i + target] = from.values[4 * i + source];
      }
    };
    put(m.base_color_map, {{0, 0}, {1, 1}, {2, 2}});
    put(m.normal_map, {{0, 3}, {1, 4}, {2, 5}});
    put(m.metallic_roughness_map, {{1, 6}, {2, 7}});
    const Texture& t = texture_of(first);
    TexelChain chain = make_chain(std::move(image), t.wrap_u, t.wrap_v, has_mips(t));
    return packed_
        .emplace(key, layout_ == TexelLayout::packed_8 ? append_small(std::move(chain), out_.small_texels_8)
                                                       : append(std::move(chain), 8, out_.texels_8))
        .first->second;
  }

  // Its levels lie as those of the base colour map, packed or not.
  uint alphas_of(int texture) {
    const auto found = alphas_.find(texture);
    if (found != alphas_.end()) return found->second;
    const std::vector<uint32_t> quads = alpha_quads(make_texture_chain(texture));
    const uint first = uint(out_.alphas.size());
    out_.alphas.insert(out_.alphas.end(), quads.begin(), quads.end());
    return alphas_.emplace(texture, first).first->second;
  }

  const Scene& scene_;
  TexelLayout layout_;
  bool blended_alphas_;
  SurfaceTexels& out_;
  std::map<int, PlacedChain> chains_;                        // by texture
  std::map<std::array<int, packable>, PlacedChain> packed_;  // by the textures
  std::map<int, uint> alphas_;                               // by texture
};

SurfaceMaterial factors_of(const Material& m, int model) {
  SurfaceMaterial record{};
  std::memcpy(record.base_color, &m.base_color, sizeof record.base_color);
  std::memcpy(record.emissive, &m.emissive, sizeof record.emissive);
  record.metallic = m.metallic;
  record.roughness = m.roughness;
  record.normal_scale = m.normal_scale;
  record.occlusion_strength = m.occlusion_strength;
  record.alpha_cutoff = m.alpha_cutoff;
  record.coat = m.clearcoat;
  record.coat_roughness = m.clearcoat_roughness;
  record.coat_normal_scale = m.clearcoat_normal_scale;
  const glm::vec3 f0 = dielectric_f0(m);
  std::memcpy(record.f0, &f0, sizeof record.f0);
  record.specular = m.specular;
  std::memcpy(record.subsurface, &m.model.subsurface_color, sizeof record.subsurface);
  record.roll_off = m.model.roll_off;
  record.minnaert_k = m.model.minnaert_k;
  record.model = float(model);
  if (m.unlit) record.flags |= SURFACE_UNLIT;
  if (m.double_sided) record.flags |= SURFACE_DOUBLE_SIDED;
  return record;
}

}  // namespace

SurfaceTexels surface_texels(const Scene& scene, const std::vector<bool>& used_materials, TexelLayout layout,
                             bool blended_alphas) {
  SurfaceTexels texels;
  TexelWriter writer(scene, layout, blended_alphas, texels);
  writer.reserve(scene.materials, used_materials);
  const std::vector<MaterialModel> models = material_models(scene);
  for (size_t i = 0; i < scene.materials.size(); ++i) {
    const Material& m = scene.materials[i];
    texels.materials.push_back(factors_of(m, m.unlit ? 0 : model_number(models, m.model)));
    if (used_materials[i]) writer.add_textures(scene.materials[i], texels.materials.back());
  }
  return texels;
}

std::vector<bool> shown_meshes(const Scene& scene) {
  std::vector<bool> shown(scene.meshes.size(), false);
  for (const Instance& instance : scene.instances)
    shown[instance.mesh] = !scene.meshes[instance.mesh].indices.empty();
  return shown;
}

std::vector<MaterialModelRecord> model_records(const Scene& scene) {
  const std::vector<MaterialModel> models = material_models(scene);
  std::vector<MaterialModelRecord> records(MOST_MODELS + 1,
                                           {.subsurface = {}, .roll_off = 0, .minnaert_k = 1, .spare = {}});
  for (size_t i = 0; i < std::min(models.size(), records.size()); ++i) {
    std::memcpy(records[i].subsurface, &models[i].subsurface_color, sizeof records[i].subsurface);
    records[i].roll_off = models[i].roll_off;
    records[i].minnaert_k = models[i].minnaert_k;
  }
  return records;
}

}  // namespace lightgrid
