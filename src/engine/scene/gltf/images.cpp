// Images to RGBA8: PNG and JPEG through stb_image, WebP (EXT_texture_webp) through libwebp.
#include "scene/gltf/images.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <memory>
#include <optional>

#include <stb_image.h>
#include <webp/decode.h>

#include "base/parallel.h"
#include "base/resident.h"
#include "scene/gltf/accessor.h"
#include "scene/gltf/reduce_bitmap.h"

namespace lightgrid::gltf {
namespace {

constexpr size_t decoder_bytes_a_pixel = 12;  // its buffers and its result

struct Encoded {
  std::string place;
  std::vector<uint8_t> owned;
  std::span<const uint8_t> bytes;
  int width = 0, height = 0;
  bool has_16_bits = false;
  std::optional<float> glossiness;
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
  image.width = features.width;
  image.height = features.height;
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

size_t pixels_of(const Encoded& image) { return size_t(image.width) * size_t(image.height); }

void fetch(Document& doc, int index, uint64_t usable, Encoded& out) {
  const ImageEntry& entry = doc.images[index];
  if (entry.fault) throw *entry.fault;
  if (entry.roughness) {
    out.glossiness = entry.roughness->glossiness;
    index = entry.roughness->image;
  }
  const bool named_by_uri = entry.name.empty() && !entry.uri.starts_with("data:");
  out.place = label("image", index, named_by_uri ? entry.uri : entry.name);
  if (entry.view >= 0) {
    out.bytes = view_bytes(doc, entry.view, out.place);
  } else {
    out.owned = read_uri(doc, out.place + ": ", doc.reach, entry.uri, doc.limits.max_file_bytes);
    out.bytes = out.owned;
  }
  read_header(doc, out);
  if (pixels_of(out) * decoder_bytes_a_pixel > usable)
    throw doc.error("{}: is {} x {}: too large to decode in {}", out.place, out.width, out.height,
                    memory_text(usable));
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

void convert_to_roughness(Bitmap& bitmap, float glossiness) {
  for (size_t i = 0; i < bitmap.rgba.size(); i += 4) {
    const float roughness = 255 - glossiness * float(bitmap.rgba[i + 3]);
    bitmap.rgba[i] = 0;
    bitmap.rgba[i + 1] = uint8_t(roughness + 0.5f);
    bitmap.rgba[i + 2] = 0;
    bitmap.rgba[i + 3] = 255;
  }
}

// Keeps an input error as a fault.
template <typename Work>
void keep_fault(std::optional<Error>& fault, const Work& work) {
  try {
    work();
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::input) throw;
    fault = error;
  }
}

// Decoded bytes of all images with this largest side.
size_t bytes_at(const std::vector<Encoded>& images, int side) {
  size_t bytes = 0;
  for (const Encoded& image : images) {
    const BitmapSize size = reduced_size(image.width, image.height, side);
    bytes += size_t(size.width) * size_t(size.height) * 4;
  }
  return bytes;
}

// Twice to six times as much goes to the devices' copies, whose texels have 16 bits and mip levels.
size_t image_memory(const GltfLimits& limits) {
  if (limits.max_image_bytes > 0) return limits.max_image_bytes;
  const uint64_t usable = usable_memory();
  return size_t(std::max(usable / 8, std::min<uint64_t>(usable / 4, uint64_t(1) << 30)));
}

void check_image_memory(const Document& doc, const std::vector<Encoded>& images) {
  const size_t allowed = image_memory(doc.limits), needed = bytes_at(images, doc.limits.texture_side);
  if (needed <= allowed) return;
  int side = doc.limits.texture_side / 2;
  while (side > 1 && bytes_at(images, side) > allowed) side /= 2;
  // The devices' copies take at least twice as much again.
  const std::string more = needed <= usable_memory() / 3
                               ? fmt::format(", --image-memory {}M allows them", (needed >> 20) + 1)
                               : "";
  throw doc.error("{} images take {} decoded, but may take {}{}: --texture-size {} fits ({}){}",
                  images.size(), memory_text(needed), memory_text(allowed),
                  doc.limits.max_image_bytes ? "" : " of the memory that this process may use", side,
                  memory_text(bytes_at(images, side)), more);
}

// Decodes and averages down in parallel, as many at a time as their memory allows.
void decode_all(const Document& doc, std::vector<Encoded>& encoded, const std::vector<char>& colors,
                std::vector<DecodedImage>& out) {
  const size_t allowed = image_memory(doc.limits);
  for (size_t first = 0, end = 0; first < encoded.size(); first = end) {
    for (size_t bytes = 0; end < encoded.size(); ++end) {
      bytes += pixels_of(encoded[end]) * decoder_bytes_a_pixel;
      if (end > first && bytes > allowed) break;
    }
    parallel_for(static_cast<int>(end - first), [&](int i) {
      const size_t image = first + size_t(i);
      if (!out[image].fault)
        keep_fault(out[image].fault, [&] {
          Bitmap bitmap = decode(doc, encoded[image]);
          if (encoded[image].glossiness) convert_to_roughness(bitmap, *encoded[image].glossiness);
          out[image].bitmap = reduced(std::move(bitmap), doc.limits.texture_side, colors[image] != 0);
        });
      encoded[image] = {};
    });
  }
}

}  // namespace

ImageSet fetch_images(Document& doc, const std::vector<ImageUse>& uses) {
  ImageSet out;
  std::vector<Encoded> encoded;
  std::vector<char> colors;  // matters only for images that are averaged down
  std::map<std::tuple<std::string_view, bool, std::optional<float>>, size_t> known;  // by their bytes
  std::map<int, size_t> broken;                                                      // by index
  const uint64_t usable = usable_memory();
  for (const ImageUse& use : uses) {
    if (const auto found = broken.find(use.image); found != broken.end()) {
      out.bitmap_of_use.push_back(found->second);
      continue;
    }
    Encoded image;
    std::optional<Error> fault;
    keep_fault(fault, [&] { fetch(doc, use.image, usable, image); });
    const bool as_colors = use.colors && std::max(image.width, image.height) > doc.limits.texture_side;
    const std::string_view bytes(reinterpret_cast<const char*>(image.bytes.data()), image.bytes.size());
    const size_t next = encoded.size();
    const auto place =
        fault ? broken.emplace(use.image, next).first->second
              : known.emplace(std::tuple(bytes, as_colors, image.glossiness), next).first->second;
    out.bitmap_of_use.push_back(place);
    if (place != next) continue;
    if (fault) image = {};
    if (image.has_16_bits) doc.warn("16 bits", "{}: has 16 bits a channel, reduced to 8", image.place);
    const ImageEntry& entry = doc.images[size_t(use.image)];
    const bool has_name = !entry.name.empty() || entry.uri.starts_with("data:");
    out.images.push_back({.bitmap = {}, .name = has_name ? entry.name : entry.uri, .fault = fault});
    encoded.push_back(std::move(image));  // its bytes stay where they are
    colors.push_back(as_colors);
  }
  known.clear();
  check_image_memory(doc, encoded);
  decode_all(doc, encoded, colors, out.images);
  return out;
}

Bitmap decoded_image(std::span<const uint8_t> bytes, int max_side) {
  const Document doc("image", GltfLimits{.max_image_side = max_side});
  Encoded image{.place = "its file", .bytes = bytes};
  read_header(doc, image);
  return decode(doc, image);
}

}  // namespace lightgrid::gltf
