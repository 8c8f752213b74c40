#include "frontier/pictures.h"

#include <fmt/format.h>
#include <png.h>
#include <webp/encode.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>

#include "base/parallel.h"
#include "base/text.h"
#include "base/write_file.h"
#include "measures/metrics.h"
#include "report/report.h"
#include "scene/random.h"

namespace lightgrid::lab {
namespace {

uint64_t hash_of(const Image& image) {
  uint64_t hash = Random::mix(uint64_t(image.width) << 32 | uint64_t(image.height));
  for (const glm::vec4& pixel : image.pixels) {
    uint64_t words[2];
    std::memcpy(words, &pixel, sizeof words);
    for (const uint64_t word : words) hash = Random::mix(hash ^ word) + 0x9e3779b97f4a7c15;
  }
  return hash;
}

constexpr int max_reduction = 8;
constexpr float fine_quality = 85, coarse_quality = 60;  // WebP quality

struct RgbPicture {
  int width = 0, height = 0;
  std::vector<uint8_t> rgb;
};

std::string bytes_of_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// Empty if it is no PNG.
RgbPicture decoded(const std::string& png) {
  RgbPicture picture;
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  if (!png_image_begin_read_from_memory(&header, png.data(), png.size())) return picture;
  header.format = PNG_FORMAT_RGB;
  picture.rgb.resize(PNG_IMAGE_SIZE(header));
  if (!png_image_finish_read(&header, nullptr, picture.rgb.data(), 0, nullptr)) return {};
  picture.width = int(header.width);
  picture.height = int(header.height);
  return picture;
}

// Each block's mean, the last blocks cut.
RgbPicture reduced_by(const RgbPicture& picture, int factor) {
  if (factor == 1) return picture;
  RgbPicture small{blocks_along(picture.width, factor), blocks_along(picture.height, factor), {}};
  small.rgb.reserve(size_t(small.width) * small.height * 3);
  for (int y = 0; y < picture.height; y += factor) {
    for (int x = 0; x < picture.width; x += factor) {
      const int right = std::min(x + factor, picture.width), bottom = std::min(y + factor, picture.height);
      for (int channel = 0; channel < 3; ++channel) {
        int sum = 0;
        for (int row = y; row < bottom; ++row) {
          for (int column = x; column < right; ++column)
            sum += picture.rgb[(size_t(row) * picture.width + column) * 3 + channel];
        }
        small.rgb.push_back(uint8_t(sum / ((right - x) * (bottom - y))));
      }
    }
  }
  return small;
}

std::string webp_url(const RgbPicture& picture, int reduced, float quality) {
  const RgbPicture shown = reduced_by(picture, reduced);
  uint8_t* bytes = nullptr;
  const size_t size =
      WebPEncodeRGB(shown.rgb.data(), shown.width, shown.height, shown.width * 3, quality, &bytes);
  std::string url = size ? "data:image/webp;base64," + base64({bytes, bytes + size}) : "";
  WebPFree(bytes);
  return url;
}

std::vector<std::string> webp_urls(const std::vector<RgbPicture>& pictures, int reduced, float quality) {
  std::vector<std::string> urls(pictures.size());
  parallel_for(int(pictures.size()), [&](int i) { urls[i] = webp_url(pictures[i], reduced, quality); });
  return urls;
}

size_t size_of_all(const std::vector<std::string>& urls) {
  size_t bytes = 0;
  for (const std::string& url : urls) bytes += url.size();
  return bytes;
}

}  // namespace

PictureFiles::PictureFiles(std::filesystem::path folder) : folder_(std::move(folder)) {
  if (!folder_.empty()) make_folder(folder_);
}

PictureFiles::Written PictureFiles::write(const std::string& scene, const Image& image, const Image& truth,
                                          const HdrFlip* flip) {
  const std::string stem = file_stem(std::filesystem::path(scene).stem().string());
  const std::string name = fmt::format("{}-{:016x}-{:04x}", stem, hash_of(image), hash_of(truth) & 0xffff);
  const auto [found, added] = written_.try_emplace(name, Written{name, {}});
  if (!added) return found->second;
  const std::vector<float> map = flip ? flip->map(image) : std::vector<float>();
  if (flip) found->second.flip_mean = mean_of(map);
  if (folder_.empty()) {
    found->second.name.clear();
    return found->second;
  }
  save_png(folder_ / (name + ".png"), image, exposure_);
  save_png_as_is(folder_ / (name + ".difference.png"), difference_image(image, truth));
  if (flip) save_png_as_is(folder_ / (name + ".flip.png"), flip_picture(map, image.width, image.height));
  return found->second;
}

PagePictures page_pictures(const std::filesystem::path& folder, const std::vector<std::string>& names,
                           size_t max_bytes) {
  PagePictures pictures;
  std::vector<RgbPicture> distinct;
  std::map<std::string, int> index_of;  // by the bytes of the file
  for (const std::string& name : names) {
    if (name.empty() || pictures.by_name.contains(name)) continue;
    std::array<int, 3>& indices = pictures.by_name[name];
    for (size_t i = 0; i < picture_suffixes.size(); ++i) {
      const std::string png = bytes_of_file(folder / (name + picture_suffixes[i]));
      const auto known = index_of.find(png);
      if (known != index_of.end()) {
        indices[i] = known->second;
        continue;
      }
      RgbPicture picture = decoded(png);
      indices[i] = picture.rgb.empty() ? -1 : int(distinct.size());
      index_of[png] = indices[i];
      if (!picture.rgb.empty()) distinct.push_back(std::move(picture));
    }
  }
  pictures.urls = webp_urls(distinct, 1, fine_quality);
  while (size_of_all(pictures.urls) > max_bytes && pictures.reduced < max_reduction) {
    pictures.urls = webp_urls(distinct, pictures.reduced, coarse_quality);
    if (size_of_all(pictures.urls) <= max_bytes) break;
    pictures.urls = webp_urls(distinct, ++pictures.reduced, fine_quality);
  }
  return pictures;
}

}  // namespace lightgrid::lab
