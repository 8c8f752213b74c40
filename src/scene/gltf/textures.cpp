// Images to RGBA8 (PNG and JPEG through stb_image, WebP (EXT_texture_webp) through libwebp), samplers, and
// the sharing of images between textures.
#include <algorithm>
#include <cstring>
#include <map>
#include <tuple>

#include <stb_image.h>
#include <webp/decode.h>

#include "base/parallel.h"
#include "scene/gltf/accessor.h"
#include "scene/gltf/materials.h"

namespace lightgrid::gltf {
namespace {

struct Encoded {
  std::string place;
  std::vector<uint8_t> owned;
  std::span<const uint8_t> bytes;
  int width = 0, height = 0;
  bool has_16_bits = false;
};

bool starts_with(std::span<const uint8_t> bytes, std::string_view magic) {
  return bytes.size() >= magic.size() && std::memcmp(bytes.data(), magic.data(), magic.size()) == 0;
}

bool is_png(std::span<const uint8_t> bytes) { return starts_with(bytes, "\x89PNG\r\n\x1a\n"); }

bool is_webp(std::span<const uint8_t> bytes) {
  return bytes.size() >= 12 && starts_with(bytes, "RIFF") && starts_with(bytes.subspan(8), "WEBP");
}

bool uses_webp(const Document& doc) {
  const auto& used = doc.model.extensionsUsed;
  return std::find(used.begin(), used.end(), "EXT_texture_webp") != used.end();
}

void read_webp_header(const Document& doc, Encoded& image) {
  if (!uses_webp(doc))
    throw doc.error("{}: is WebP, but extensionsUsed does not name EXT_texture_webp", image.place);
  WebPBitstreamFeatures features;
  if (WebPGetFeatures(image.bytes.data(), image.bytes.size(), &features) != VP8_STATUS_OK)
    throw doc.error("{}: cannot be decoded: its WebP header is broken", image.place);
  if (features.has_animation) throw doc.error("{}: is an animated WebP image", image.place);
  image.width = features.width, image.height = features.height;
}

// glTF allows these two of stb_image's formats.
void read_stb_header(const Document& doc, Encoded& image) {
  if (!is_png(image.bytes) && !starts_with(image.bytes, "\xff\xd8\xff"))
    throw doc.error("{}: is neither PNG nor JPEG{}", image.place, uses_webp(doc) ? " nor WebP" : "");
  const auto size = static_cast<int>(image.bytes.size());
  int channels = 0;
  if (!stbi_info_from_memory(image.bytes.data(), size, &image.width, &image.height, &channels))
    throw doc.error("{}: cannot be decoded: {}", image.place, stbi_failure_reason());
  image.has_16_bits = stbi_is_16_bit_from_memory(image.bytes.data(), size);
}

void read_header(const Document& doc, Encoded& image) {
  if (image.bytes.size() > size_t(std::numeric_limits<int>::max()))
    throw doc.error("{}: is of {} bytes", image.place, image.bytes.size());
  if (is_webp(image.bytes))
    read_webp_header(doc, image);
  else
    read_stb_header(doc, image);
  if (image.width < 1 || image.height < 1 || std::max(image.width, image.height) > doc.limits.max_image_side)
    throw doc.error("{}: is {} x {}; a side of at most {} is read", image.place, image.width, image.height,
                    doc.limits.max_image_side);
}

Encoded fetch(Document& doc, int index) {
  const ImageEntry& entry = doc.images[index];
  if (entry.fault) throw *entry.fault;
  const bool named_by_uri = entry.name.empty() && !entry.uri.starts_with("data:");
  Encoded out{.place = label("image", index, named_by_uri ? entry.uri : entry.name)};
  if (entry.view >= 0) {
    out.bytes = view_bytes(doc, entry.view, out.place);
  } else {
    out.owned = read_uri(doc, out.place + ": ", doc.folder, entry.uri, doc.limits.max_image_bytes);
    out.bytes = out.owned;
  }
  read_header(doc, out);
  return out;
}

// A PNG's compressed data can inflate to a thousand times its size, whatever the header says, and stb_image
// grows its buffer accordingly. If that could be much, the data is first inflated within the size from the
// header.
void check_png_inflates_to_its_size(const Document& doc, const Encoded& image) {
  std::vector<char> packed;
  for (size_t at = 8; at + 12 <= image.bytes.size();) {
    const uint8_t* head = image.bytes.data() + at;
    const size_t length = size_t(head[0]) << 24 | head[1] << 16 | head[2] << 8 | head[3];
    if (length > image.bytes.size() - at - 12) break;  // stb_image reports the fault
    if (std::memcmp(head + 4, "IDAT", 4) == 0) packed.insert(packed.end(), head + 8, head + 8 + length);
    at += 12 + length;
  }
  constexpr size_t inflate_factor = 1032, harmless_bytes = size_t(64) << 20;
  if (packed.size() * inflate_factor <= harmless_bytes) return;
  // Four channels of 16 bits, a filter byte a row, and the rows of seven passes for interlaced images.
  const size_t allowed = size_t(image.width) * image.height * 8 + size_t(image.height) * 2 + image.width + 64;
  const auto room = std::make_unique_for_overwrite<char[]>(allowed);
  if (stbi_zlib_decode_buffer(room.get(), static_cast<int>(std::min<size_t>(allowed, INT32_MAX)),
                              packed.data(), static_cast<int>(packed.size())) < 0)
    throw doc.error("{}: its data is broken, or more than {} x {} pixels need", image.place, image.width,
                    image.height);
}

Bitmap decode_webp(const Document& doc, const Encoded& image) {
  Bitmap out{.width = image.width, .height = image.height};
  out.rgba.resize(size_t(image.width) * image.height * 4);
  if (!WebPDecodeRGBAInto(image.bytes.data(), image.bytes.size(), out.rgba.data(), out.rgba.size(),
                          image.width * 4))
    throw doc.error("{}: cannot be decoded: its WebP data is broken", image.place);
  return out;
}

Bitmap decode(const Document& doc, const Encoded& image) {
  if (is_webp(image.bytes)) return decode_webp(doc, image);
  if (is_png(image.bytes)) check_png_inflates_to_its_size(doc, image);
  Bitmap out{.width = image.width, .height = image.height};
  int width = 0, height = 0, channels = 0;
  const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
      stbi_load_from_memory(image.bytes.data(), static_cast<int>(image.bytes.size()), &width, &height,
                            &channels, 4),
      stbi_image_free);
  if (!pixels) throw doc.error("{}: cannot be decoded: {}", image.place, stbi_failure_reason());
  if (width != image.width || height != image.height) throw doc.error("{}: changes its size", image.place);
  out.rgba.assign(pixels.get(), pixels.get() + size_t(width) * height * 4);
  return out;
}

// The images of the file at these indices, in that order. The format is detected from the content; WebP is
// read only if the file uses EXT_texture_webp. Sizes are checked before decoding: each side against
// limits.max_image_side, the sum against limits.max_image_bytes. 16 bits become 8, with a warning.
std::vector<Bitmap> decode_images(Document& doc, const std::vector<int>& images) {
  std::vector<Encoded> encoded;
  size_t bytes_left = doc.limits.max_image_bytes;
  for (int index : images) {
    encoded.push_back(fetch(doc, index));
    const Encoded& image = encoded.back();
    const size_t needed = size_t(image.width) * image.height * 4 + image.owned.size();
    if (needed > bytes_left)
      throw doc.error("{}: with it, images take more than {} bytes", image.place, doc.limits.max_image_bytes);
    bytes_left -= needed;
    if (image.has_16_bits) doc.warn("16 bits", "{}: has 16 bits a channel, reduced to 8", image.place);
  }
  std::vector<Bitmap> out(images.size());
  parallel_for(static_cast<int>(images.size()), [&](int i) {
    out[i] = decode(doc, encoded[i]);
    const ImageEntry& entry = doc.images[images[i]];
    out[i].name = !entry.name.empty() || entry.uri.starts_with("data:") ? entry.name : entry.uri;
    encoded[i] = {};
  });
  return out;
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
