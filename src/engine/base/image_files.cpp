#include <fmt/format.h>
#include <png.h>
#include <stb_image.h>
#include <tinyexr.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cctype>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <unordered_map>

#include "base/error.h"
#include "base/exr_picture.h"
#include "base/image.h"
#include "base/json_file.h"
#include "base/write_file.h"

namespace lightgrid {
namespace {

// The largest side of a picture that is read, in pixels.
constexpr int max_picture_side = 8192;
constexpr size_t max_picture_bytes = size_t(1) << 30;

struct Palette {
  std::vector<png_color> colours;
  std::vector<uint8_t> indices;
};

// Heat maps and difference images have at most 256 colours; a palette cuts their size to a third. Returns no
// colours if there are more.
Palette find_palette(const std::vector<uint8_t>& rgb) {
  Palette palette;
  palette.indices.reserve(rgb.size() / 3);
  std::unordered_map<uint32_t, uint8_t> index_of;
  for (size_t i = 0; i < rgb.size(); i += 3) {
    const uint32_t key = rgb[i] | rgb[i + 1] << 8 | rgb[i + 2] << 16;
    auto found = index_of.find(key);
    if (found == index_of.end()) {
      if (index_of.size() == 256) return {};
      found = index_of.emplace(key, static_cast<uint8_t>(index_of.size())).first;
      palette.colours.push_back({rgb[i], rgb[i + 1], rgb[i + 2]});
    }
    palette.indices.push_back(found->second);
  }
  return palette;
}

[[noreturn]] void on_png_error(png_structp, png_const_charp message) {
  throw std::runtime_error(std::string("PNG: ") + message);
}

void append(png_structp png, png_bytep data, size_t size) {
  auto& out = *static_cast<std::vector<uint8_t>*>(png_get_io_ptr(png));
  out.insert(out.end(), data, data + size);
}

std::vector<uint32_t> turned_over(const std::vector<uint32_t>& words, int width, int height) {
  std::vector<uint32_t> rows;
  rows.reserve(words.size());
  for (int row = height - 1; row >= 0; --row) {
    const auto first = words.begin() + ptrdiff_t(row) * width;
    rows.insert(rows.end(), first, first + width);
  }
  return rows;
}

std::string extension_of(const std::filesystem::path& path) {
  auto extension = path.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

}  // namespace

std::vector<uint8_t> encode_png(int width, int height, int channels, const std::vector<uint8_t>& bytes) {
  assert(bytes.size() == size_t(width) * height * channels);
  constexpr std::array colour_types = {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB,
                                       PNG_COLOR_TYPE_RGB_ALPHA};
  const auto palette = channels == 3 ? find_palette(bytes) : Palette{};
  const bool indexed = !palette.colours.empty();

  std::vector<uint8_t> out;
  out.reserve(bytes.size() / 2);
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, on_png_error, nullptr);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(png, &out, append, nullptr);
  png_set_IHDR(png, info, width, height, 8, indexed ? PNG_COLOR_TYPE_PALETTE : colour_types.at(channels - 1),
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  if (indexed) png_set_PLTE(png, info, palette.colours.data(), static_cast<int>(palette.colours.size()));
  png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  // 1280x720 in 38 ms; level 6 with all filters takes 370 ms to save a tenth of the size.
  png_set_compression_level(png, indexed ? 6 : 1);
  png_set_filter(png, PNG_FILTER_TYPE_BASE, indexed ? PNG_FILTER_NONE : PNG_FILTER_AVG);
  png_write_info(png, info);
  const auto& source = indexed ? palette.indices : bytes;
  const size_t row_bytes = size_t(width) * (indexed ? 1 : channels);
  for (int row = 0; row < height; ++row) png_write_row(png, &source[row * row_bytes]);
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return out;
}

void save_png(const std::filesystem::path& path, const Image& image, const Exposure& exposure) {
  write_file(path, encode_png(image.width, image.height, 3, srgb_bytes(image, exposure)));
}

void save_png_as_is(const std::filesystem::path& path, const Image& image) {
  write_file(path, encode_png(image.width, image.height, 3, srgb_bytes_as_is(image)));
}

void save_exr(const std::filesystem::path& path, const Image& image) {
  std::vector<ExrChannel> channels;
  for (const auto& [name, channel] : {std::pair{"B", 2}, {"G", 1}, {"R", 0}}) {
    std::vector<uint32_t>& words = channels.emplace_back(ExrChannel{name, false, {}}).words;
    words.reserve(image.pixels.size());
    for (const glm::vec4& pixel : image.pixels) words.push_back(std::bit_cast<uint32_t>(pixel[channel]));
  }
  save_exr(path, image.width, image.height, channels);
}

void save_exr(const std::filesystem::path& path, int width, int height,
              const std::vector<ExrChannel>& channels) {
  std::vector<std::vector<uint32_t>> planes;  // row 0 at the top
  std::vector<unsigned char*> data;
  std::vector<EXRChannelInfo> infos(channels.size());
  std::vector<int> types;
  for (size_t c = 0; c < channels.size(); ++c) {
    planes.push_back(turned_over(channels[c].words, width, height));
    data.push_back(reinterpret_cast<unsigned char*>(planes.back().data()));
    channels[c].name.copy(infos[c].name, sizeof infos[c].name - 1);
    types.push_back(channels[c].whole ? TINYEXR_PIXELTYPE_UINT : TINYEXR_PIXELTYPE_FLOAT);
  }
  EXRImage exr;
  InitEXRImage(&exr);
  exr.num_channels = int(channels.size());
  exr.images = data.data();
  exr.width = width;
  exr.height = height;
  EXRHeader header;
  InitEXRHeader(&header);
  header.num_channels = exr.num_channels;
  header.channels = infos.data();
  header.pixel_types = types.data();
  header.requested_pixel_types = types.data();
  header.compression_type = TINYEXR_COMPRESSIONTYPE_ZIP;

  unsigned char* encoded = nullptr;
  const char* why = nullptr;
  const size_t size = SaveEXRImageToMemory(&exr, &header, &encoded, &why);
  if (!size) throw machine_error("{}: EXR: {}", path.string(), why ? why : "cannot be encoded");
  std::vector<uint8_t> bytes(encoded, encoded + size);
  std::free(encoded);
  write_file(path, bytes);
}

// As load_exr; `halves`: channels of 16 bits become floats. A width of 0: both become those of the file.
static std::vector<ExrChannel> read_exr(const std::filesystem::path& path, int& width, int& height,
                                        bool halves) {
  constexpr int max_channels = 16;
  const size_t most =
      width > 0 ? (size_t(width) * size_t(height) * max_channels + (1 << 20)) * 4 : max_picture_bytes;
  const std::string text = read_small_file(path, most, "an EXR file");
  const auto* bytes = reinterpret_cast<const unsigned char*>(text.data());
  const auto require = [&](bool good, const std::string& what) {
    if (!good) throw input_error("{}: {}", path.string(), what);
  };
  const char* why = nullptr;  // lost: a sentence of tinyexr's
  EXRVersion version;
  require(ParseEXRVersionFromMemory(&version, bytes, text.size()) == TINYEXR_SUCCESS, "is not an EXR file");
  require(!version.tiled && !version.multipart && !version.non_image, "has tiles or several parts");
  struct Read {
    EXRHeader header;
    EXRImage image;
    bool has_image = false;  // tinyexr frees what it could not read, and leaves the pointers
    Read() {
      InitEXRHeader(&header);
      InitEXRImage(&image);
    }
    ~Read() {
      if (has_image) FreeEXRImage(&image);
      FreeEXRHeader(&header);
    }
  } read;
  require(ParseEXRHeaderFromMemory(&read.header, &version, bytes, text.size(), &why) == TINYEXR_SUCCESS,
          "its header is broken");
  const EXRBox2i box = read.header.data_window;
  if (width == 0) {
    require(box.min_x == 0 && box.min_y == 0 && box.max_x < max_picture_side && box.max_y < max_picture_side,
            fmt::format("its pixels are {},{} to {},{}: they begin at 0,0 and end before {}", box.min_x,
                        box.min_y, box.max_x, box.max_y, max_picture_side));
    width = box.max_x + 1;
    height = box.max_y + 1;
  }
  const size_t pixels = size_t(width) * size_t(height);
  require(box.min_x == 0 && box.min_y == 0 && box.max_x == width - 1 && box.max_y == height - 1,
          fmt::format("has another size: pixels {},{} to {},{}, not 0,0 to {},{}", box.min_x, box.min_y,
                      box.max_x, box.max_y, width - 1, height - 1));
  require(read.header.num_channels <= max_channels, "has more than 16 channels");
  for (int c = 0; c < read.header.num_channels; ++c) {
    if (read.header.pixel_types[c] != TINYEXR_PIXELTYPE_HALF) continue;
    require(halves, "has a channel of 16 bits");
    read.header.requested_pixel_types[c] = TINYEXR_PIXELTYPE_FLOAT;
  }
  read.has_image =
      LoadEXRImageFromMemory(&read.image, &read.header, bytes, text.size(), &why) == TINYEXR_SUCCESS;
  require(read.has_image && read.image.images && read.image.width == width && read.image.height == height,
          "its pixels are broken");
  std::vector<ExrChannel> channels;
  for (int c = 0; c < read.header.num_channels; ++c) {
    const auto* words = reinterpret_cast<const uint32_t*>(read.image.images[c]);
    channels.push_back({read.header.channels[c].name, read.header.pixel_types[c] == TINYEXR_PIXELTYPE_UINT,
                        turned_over({words, words + pixels}, width, height)});
  }
  return channels;
}

std::vector<ExrChannel> load_exr(const std::filesystem::path& path, int width, int height) {
  return read_exr(path, width, height, false);
}

// A width of 0: of any size.
static Image read_exr_picture(const std::filesystem::path& path, int width, int height) {
  const std::vector<ExrChannel> channels = read_exr(path, width, height, true);
  Image image(width, height);
  std::string names;
  for (const ExrChannel& channel : channels) names += (names.empty() ? "" : ", ") + channel.name;
  for (const auto& [name, index] : {std::pair{"R", 0}, {"G", 1}, {"B", 2}}) {
    const auto found = std::ranges::find(channels, name, &ExrChannel::name);
    if (found == channels.end())
      throw input_error("{}: has no channel {}; its channels are {}", path.string(), name, names);
    if (found->whole)
      throw input_error("{}: channel {} holds whole numbers, not floats", path.string(), name);
    for (size_t i = 0; i < image.pixels.size(); ++i)
      image.pixels[i][index] = std::bit_cast<float>(found->words[i]);
  }
  for (glm::vec4& pixel : image.pixels) pixel.a = 1;
  return image;
}

Image load_exr_picture(const std::filesystem::path& path, int width, int height) {
  return read_exr_picture(path, width, height);
}

static Image read_hdr_picture(const std::filesystem::path& path) {
  const std::string text = read_small_file(path, max_picture_bytes, "an HDR file");
  const auto* bytes = reinterpret_cast<const stbi_uc*>(text.data());
  int width = 0, height = 0, channels = 0;
  const auto fail = [&](const std::string& what) { throw input_error("{}: {}", path.string(), what); };
  if (!stbi_is_hdr_from_memory(bytes, int(text.size()))) fail("is not an HDR file");
  if (!stbi_info_from_memory(bytes, int(text.size()), &width, &height, &channels) ||
      width > max_picture_side || height > max_picture_side)
    fail(fmt::format("its header is broken, or a side has more than {} pixels", max_picture_side));
  const std::unique_ptr<float, void (*)(void*)> pixels(
      stbi_loadf_from_memory(bytes, int(text.size()), &width, &height, &channels, 3), stbi_image_free);
  if (!pixels) fail(fmt::format("its pixels are broken: {}", stbi_failure_reason()));
  Image image(width, height);
  for (int row = 0; row < height; ++row) {
    const float* from = pixels.get() + size_t(height - 1 - row) * size_t(width) * 3;
    for (int column = 0; column < width; ++column)
      image.at(column, row) = {from[3 * column], from[3 * column + 1], from[3 * column + 2], 1};
  }
  return image;
}

Image load_radiance_picture(const std::filesystem::path& path) {
  const auto extension = extension_of(path);
  if (extension == ".hdr") return read_hdr_picture(path);
  if (extension == ".exr") return read_exr_picture(path, 0, 0);
  throw input_error("{}: radiance is read from .hdr or .exr, not \"{}\"", path.string(), extension);
}

void check_image_path(const std::filesystem::path& path) {
  const auto extension = extension_of(path);
  if (extension != ".png" && extension != ".exr") {
    throw input_error("{}: images are written as .png or .exr, not \"{}\"", path.string(), extension);
  }
}

bool is_exr(const std::filesystem::path& path) { return extension_of(path) == ".exr"; }

void save_image(const std::filesystem::path& path, const Image& image, const Exposure& exposure) {
  check_image_path(path);
  extension_of(path) == ".png" ? save_png(path, image, exposure) : save_exr(path, image);
}

}  // namespace lightgrid
