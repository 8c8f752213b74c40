#include "frontier/pictures.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>

#include "base/write_file.h"
#include "report/report.h"
#include "results/metrics.h"
#include "scene/random.h"

namespace lightgrid {
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

void save_as_is(const std::filesystem::path& path, const Image& image) {
  write_file(path, encode_png(image.width, image.height, 3, srgb_bytes_as_is(image)));
}

Image flip_picture(const std::vector<float>& map, int width, int height) {
  constexpr uint32_t top = 253;  // steps of the ramp
  std::vector<uint32_t> steps;
  for (const float value : map) steps.push_back(uint32_t(std::lround(double(value) * top)));
  return heat_map(width, height, steps, top);
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
  save_as_is(folder_ / (name + ".difference.png"), difference_image(image, truth));
  if (flip) save_as_is(folder_ / (name + ".flip.png"), flip_picture(map, image.width, image.height));
  return found->second;
}

}  // namespace lightgrid
