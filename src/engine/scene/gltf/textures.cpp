// Samplers, and the sharing of images between textures.
#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <tuple>

#include "scene/gltf/images.h"
#include "scene/gltf/materials.h"

namespace lightgrid::gltf {
namespace {

void warn_of_faults(const std::vector<DecodedImage>& images) {
  constexpr size_t max_named = 8;
  std::set<std::string> faults;  // two bitmaps can be made of one image
  for (const DecodedImage& image : images)
    if (image.fault && faults.insert(image.fault->what()).second && faults.size() <= max_named)
      log_warning_line(std::string(image.fault->what()) + "; a checkerboard is drawn in its place");
  if (faults.size() > max_named)
    log_warning("{} more images are missing or broken", faults.size() - max_named);
}

Bitmap checkerboard() {
  constexpr int side = 64, square = 8;
  Bitmap out{.width = side, .height = side};
  for (int i = 0; i < side * side; ++i) {
    const bool bright = (i / square + i / side / square) % 2 == 0;
    const uint8_t level = bright ? 255 : 64;
    out.rgba.insert(out.rgba.end(), {level, uint8_t(bright ? 0 : level), level, 255});
  }
  return out;
}

// The maps of images with a fault, other than the base colour's checkerboard, are left out: without them the
// surface is smooth, opaque to its coat, and neither metal nor glowing.
void leave_out_maps(Scene& scene, const std::vector<DecodedImage>& images) {
  const auto is_missing = [&](const TextureSlot& slot) {
    return slot.texture >= 0 && images[size_t(scene.textures[size_t(slot.texture)].bitmap)].fault;
  };
  for (Material& material : scene.materials) {
    if (is_missing(material.metallic_roughness_map)) material.metallic = 0;
    if (is_missing(material.emissive_map)) material.emissive = glm::vec3(0);
    if (is_missing(material.specular_color_map) && material.ior == 0) material.ior = 1.5f;  // not a mirror
    for (const SlotUse& use : material_slots)
      if (use.slot != &Material::base_color_map && is_missing(material.*use.slot)) material.*use.slot = {};
  }
}

Wrap read_wrap(const Document& doc, int value, const std::string& place, const char* what) {
  switch (value) {
    case TINYGLTF_TEXTURE_WRAP_REPEAT:
      return Wrap::repeat;
    case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
      return Wrap::clamp;
    case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
      return Wrap::mirror;
    default:
      throw doc.error("{}: {} is {}", place, what, value);
  }
}

Filter read_min_filter(const Document& doc, int value, const std::string& place) {
  switch (value) {
    case TINYGLTF_TEXTURE_FILTER_NEAREST:
      return Filter::nearest;
    case TINYGLTF_TEXTURE_FILTER_LINEAR:
      return Filter::linear;
    case TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST:
      return Filter::nearest_mipmap_nearest;
    case TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_NEAREST:
      return Filter::linear_mipmap_nearest;
    case TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_LINEAR:
      return Filter::nearest_mipmap_linear;
    case -1:
    case TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_LINEAR:
      return Filter::linear_mipmap_linear;
    default:
      throw doc.error("{}: minFilter is {}", place, value);
  }
}

void read_sampler(const Document& doc, const tinygltf::Sampler& in, const std::string& place, Texture& out) {
  out.wrap_u = read_wrap(doc, in.wrapS, place, "wrapS");
  out.wrap_v = read_wrap(doc, in.wrapT, place, "wrapT");
  out.min_filter = read_min_filter(doc, in.minFilter, place);
  if (in.magFilter != -1 && in.magFilter != TINYGLTF_TEXTURE_FILTER_NEAREST &&
      in.magFilter != TINYGLTF_TEXTURE_FILTER_LINEAR)
    throw doc.error("{}: magFilter is {}", place, in.magFilter);
  out.mag_linear = in.magFilter != TINYGLTF_TEXTURE_FILTER_NEAREST;
}

}  // namespace

int image_of_texture(const Document& doc, int index) {
  const tinygltf::Texture& texture = doc.model.textures[index];
  const tinygltf::Value* webp = find_extension(texture.extensions, "EXT_texture_webp");
  if (!webp || !webp->Has("source")) return texture.source;
  return static_cast<int>(
      size_or(doc, *webp, "source", 0, fmt::format("texture {}: EXT_texture_webp", index)));
}

namespace {

// The images that materials use, in the order of their slots.
std::vector<ImageUse> used_images(const Document& doc, const Scene& scene) {
  std::vector<ImageUse> uses;
  std::map<std::pair<int, bool>, bool> known;
  for (const Material& material : scene.materials) {
    for (const SlotUse& use : material_slots) {
      const int texture = (material.*use.slot).texture;
      if (texture < 0) continue;
      const int image = image_of_texture(doc, texture);
      checked(doc, doc.images, image, fmt::format("texture {}", texture), "source");
      if (!std::exchange(known[{image, use.srgb}], true)) uses.push_back({image, use.srgb});
    }
  }
  return uses;
}

}  // namespace

void add_textures(Document& doc, Scene& scene) {
  const std::vector<ImageUse> uses = used_images(doc, scene);
  ImageSet set = fetch_images(doc, uses);
  std::map<std::pair<int, bool>, int> bitmap_of_image;
  for (size_t i = 0; i < uses.size(); ++i)
    bitmap_of_image[{uses[i].image, uses[i].colors}] = static_cast<int>(set.bitmap_of_use[i]);
  std::map<std::tuple<int, int, bool>, int> textures;  // by bitmap, sampler and curve
  for (Material& material : scene.materials) {
    for (const SlotUse& use : material_slots) {
      TextureSlot& slot = material.*use.slot;
      if (slot.texture < 0) continue;
      const tinygltf::Texture& in = doc.model.textures[slot.texture];
      const int bitmap = bitmap_of_image.at({image_of_texture(doc, slot.texture), use.srgb});
      const std::string place = fmt::format("texture {}", slot.texture);
      const auto [known, is_new] =
          textures.try_emplace({bitmap, in.sampler, use.srgb}, static_cast<int>(scene.textures.size()));
      slot.texture = known->second;
      if (!is_new) continue;
      Texture texture{.bitmap = bitmap, .srgb = use.srgb};
      if (in.sampler >= 0)
        read_sampler(doc, checked(doc, doc.model.samplers, in.sampler, place, "sampler"),
                     fmt::format("sampler {}", in.sampler), texture);
      scene.textures.push_back(texture);
    }
  }
  warn_of_faults(set.images);
  leave_out_maps(scene, set.images);
  for (DecodedImage& image : set.images) {
    if (image.fault) image.bitmap = checkerboard();
    image.bitmap.name = std::move(image.name);
    scene.bitmaps.push_back(std::move(image.bitmap));
  }
}

}  // namespace lightgrid::gltf
