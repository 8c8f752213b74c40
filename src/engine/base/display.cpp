#include "base/display.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/parallel.h"
#include "shared/film_curve.h"

namespace lightgrid {
namespace {

bool can_spread(const glm::vec4& pixel) {
  for (int c = 0; c < 3; ++c)
    if (!std::isfinite(pixel[c]) || pixel[c] < 0) return false;
  return true;
}

// The means of 2 x 2 pixels; at odd sizes the last column and row count twice.
Image halved(const Image& image) {
  Image half((image.width + 1) / 2, (image.height + 1) / 2);
  parallel_for(half.height, [&](int y) {
    const int y0 = 2 * y, y1 = std::min(y0 + 1, image.height - 1);
    for (int x = 0; x < half.width; ++x) {
      const int x0 = 2 * x, x1 = std::min(x0 + 1, image.width - 1);
      half.at(x, y) = 0.25f * (image.at(x0, y0) + image.at(x1, y0) + image.at(x0, y1) + image.at(x1, y1));
    }
  });
  return half;
}

// Adds `coarse`, interpolated between its pixels, to an image of twice its size.
void add_doubled(Image& image, const Image& coarse) {
  const auto places = [](int fine, int size) {
    const int nearest = fine / 2, next = fine % 2 ? nearest + 1 : nearest - 1;
    return std::pair(std::min(nearest, size - 1), std::clamp(next, 0, size - 1));
  };
  parallel_for(image.height, [&](int y) {
    const auto [y0, y1] = places(y, coarse.height);
    for (int x = 0; x < image.width; ++x) {
      const auto [x0, x1] = places(x, coarse.width);
      image.at(x, y) += 0.5625f * coarse.at(x0, y0) + 0.1875f * (coarse.at(x1, y0) + coarse.at(x0, y1)) +
                        0.0625f * coarse.at(x1, y1);
    }
  });
}

Image film_mapped(const Image& image, float scale) {
  Image mapped(image.width, image.height);
  for (size_t i = 0; i < image.pixels.size(); ++i) {
    const glm::vec3 light(image.pixels[i]);
    const bool has_nan = std::isnan(light.x) || std::isnan(light.y) || std::isnan(light.z);
    mapped.pixels[i] = glm::vec4(has_nan ? light : tone::film_mapped(scale * light), image.pixels[i].w);
  }
  return mapped;
}

}  // namespace

Image with_glow(const Image& image, float share) {
  constexpr int min_side = 4;  // of the coarsest blur
  std::vector<Image> levels{image};
  for (glm::vec4& pixel : levels[0].pixels)
    if (!can_spread(pixel)) pixel = glm::vec4(0);
  while (std::min(levels.back().width, levels.back().height) > min_side)
    levels.push_back(halved(levels.back()));
  const auto blurs = float(levels.size() - 1);
  if (blurs == 0) return image;
  for (size_t i = levels.size() - 1; i > 1; --i) add_doubled(levels[i - 1], levels[i]);
  Image spread(image.width, image.height);
  add_doubled(spread, levels[1]);
  Image glowing = image;
  for (size_t i = 0; i < image.pixels.size(); ++i) {
    if (!can_spread(image.pixels[i])) continue;
    const glm::vec3 mixed = glm::mix(glm::vec3(image.pixels[i]), glm::vec3(spread.pixels[i]) / blurs, share);
    glowing.pixels[i] = glm::vec4(mixed, image.pixels[i].w);
  }
  return glowing;
}

void save_displayed(const std::filesystem::path& path, const Image& image, const Display& display) {
  if (is_exr(path)) return save_exr(path, image);
  const Image shown = display.glow > 0 ? with_glow(image, display.glow) : image;
  if (display.curve == DisplayCurve::neutral) return save_image(path, shown, display.exposure);
  save_png_as_is(path, film_mapped(shown, display.exposure.scale()));
}

}  // namespace lightgrid
