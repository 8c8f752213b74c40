// Samplers and the sharing of images between textures.
#include <map>
#include <tuple>

#include "scene/gltf/images.h"
#include "scene/gltf/materials.h"

namespace lightgrid::gltf {
namespace {

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

void add_textures(Document& doc, Scene& scene) {
  std::vector<int> images;  // indices of the used images; bitmap i is images[i]
  std::map<int, int> bitmap_of_image;
  std::map<std::tuple<int, int, bool>, int> textures;  // by image, sampler and curve
  for (Material& material : scene.materials) {
    for (const SlotUse& use : material_slots) {
      TextureSlot& slot = material.*use.slot;
      if (slot.texture < 0) continue;
      const tinygltf::Texture& in = doc.model.textures[slot.texture];
      const std::string place = fmt::format("texture {}", slot.texture);
      const int image = image_of_texture(doc, slot.texture);
      checked(doc, doc.images, image, place, "source");
      const auto [bitmap, is_new_image] = bitmap_of_image.try_emplace(image, static_cast<int>(images.size()));
      if (is_new_image) images.push_back(image);
      const auto [known, is_new] =
          textures.try_emplace({image, in.sampler, use.srgb}, static_cast<int>(scene.textures.size()));
      slot.texture = known->second;
      if (!is_new) continue;
      Texture texture{.bitmap = bitmap->second, .srgb = use.srgb};
      if (in.sampler >= 0)
        read_sampler(doc, checked(doc, doc.model.samplers, in.sampler, place, "sampler"),
                     fmt::format("sampler {}", in.sampler), texture);
      scene.textures.push_back(texture);
    }
  }
  scene.bitmaps = decode_images(doc, images);
}

}  // namespace lightgrid::gltf
