#include "frontier/pictures.h"

#include <png.h>
#include <webp/encode.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

#include "base/parallel.h"
#include "report/page_template.h"
#include "results/reduce.h"

namespace lightgrid {
namespace {

constexpr int most_reduction = 8;
constexpr float fine_quality = 85, coarse_quality = 60;  // of WebP

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
  picture.width = int(header.width), picture.height = int(header.height);
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

PagePictures page_pictures(const std::filesystem::path& folder, const std::vector<std::string>& names,
                           size_t most_bytes) {
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
  while (size_of_all(pictures.urls) > most_bytes && pictures.reduced < most_reduction) {
    pictures.urls = webp_urls(distinct, pictures.reduced, coarse_quality);
    if (size_of_all(pictures.urls) <= most_bytes) break;
    pictures.urls = webp_urls(distinct, ++pictures.reduced, fine_quality);
  }
  return pictures;
}

}  // namespace lightgrid
