// Pictures of errors and counts, and pictures reduced for a page.
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

#include "measures/error_measures.h"
#include "measures/metrics.h"

namespace lightgrid::lab {
namespace {

constexpr int steps = 254;
constexpr double lowest_decade = -7;  // the difference image's lowest: 1e-7

template <typename Colour>
Ramp make_ramp(const Colour& colour_at) {
  Ramp ramp;
  for (int i = 0; i < steps; ++i) {
    const glm::vec3 colour = colour_at(i / float(steps - 1));
    ramp.push_back(glm::u8vec3(glm::clamp(colour, 0.f, 1.f) * 255.f + 0.5f));
  }
  return ramp;
}

glm::vec4 stored(glm::u8vec3 srgb) {
  glm::vec4 linear(1);
  for (int c = 0; c < 3; ++c) linear[c] = linear_from_srgb(srgb[c] / 255.f);
  return linear;
}

// Linear colours of a ramp, looked up by a value from 0 to 1.
class Lookup {
 public:
  explicit Lookup(const Ramp& ramp) {
    for (const auto& colour : ramp) linear_.push_back(stored(colour));
  }
  glm::vec4 operator()(double t) const {
    return linear_[static_cast<size_t>(std::clamp(t, 0.0, 1.0) * (steps - 1) + 0.5)];
  }

 private:
  std::vector<glm::vec4> linear_;
};

// Calls visit(block, pixel) for each pixel, block by block.
template <typename Visit>
void for_each_pixel(int width, int height, int factor, const Visit& visit) {
  const int across = blocks_along(width, factor);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      visit(size_t(y / factor) * across + x / factor, size_t(y) * width + x);
    }
  }
}

double distance(const glm::vec4& a, const glm::vec4& b) {
  double largest = 0;
  for (int c = 0; c < 3; ++c) {
    const double d = std::abs(double(a[c]) - double(b[c]));
    if (std::isnan(d) && a[c] != b[c]) return std::numeric_limits<double>::infinity();
    if (!std::isnan(d)) largest = std::max(largest, d);
  }
  return largest;
}

}  // namespace

const Ramp& difference_ramp() {
  static const Ramp ramp = make_ramp([](float t) {
    // Blue, cyan, green, yellow, red: all clearly brighter than black.
    constexpr std::array<glm::vec3, 5> stops = {{{0.20f, 0.32f, 0.95f},
                                                 {0.10f, 0.75f, 0.85f},
                                                 {0.30f, 0.75f, 0.25f},
                                                 {0.97f, 0.83f, 0.20f},
                                                 {0.88f, 0.12f, 0.10f}}};
    const float at = t * (stops.size() - 1);
    const int below = std::min<int>(static_cast<int>(at), stops.size() - 2);
    return glm::mix(stops[below], stops[below + 1], at - below);
  });
  return ramp;
}

const Ramp& viridis_ramp() {
  static const Ramp ramp = make_ramp([](float t) {
    // Polynomial fit of the matplotlib table by M. Zucker (shadertoy WlfXRN), within 2/255 of it.
    constexpr std::array<glm::vec3, 7> c = {{{0.2777273f, 0.0054073f, 0.3340998f},
                                             {0.1050930f, 1.4046135f, 1.3845902f},
                                             {-0.3308618f, 0.2148476f, 0.0950952f},
                                             {-4.6342305f, -5.7991010f, -19.3324410f},
                                             {6.2282699f, 14.1799334f, 56.6905526f},
                                             {4.7763850f, -13.7451454f, -65.3530326f},
                                             {-5.4354559f, 4.6458526f, 26.3124352f}}};
    return c[0] + t * (c[1] + t * (c[2] + t * (c[3] + t * (c[4] + t * (c[5] + t * c[6])))));
  });
  return ramp;
}

Image difference_image(const Image& image, const Image& reference) {
  assert(image.width == reference.width && image.height == reference.height);
  const Lookup colour_of(difference_ramp());
  const double brightest = brightest_channel(reference);
  Image result(image.width, image.height);
  for (size_t i = 0; i < image.pixels.size(); ++i) {
    double largest = 0;
    bool has_nan = false;
    for (int c = 0; c < 3; ++c) {
      const double a = image.pixels[i][c], b = reference.pixels[i][c];
      has_nan = has_nan || std::isnan(a) || std::isnan(b);
      if (a != b) largest = std::max(largest, std::abs(a - b));
    }
    auto& pixel = result.pixels[i];
    if (has_nan) {
      pixel = glm::vec4(1);
    } else if (largest == 0) {
      pixel = glm::vec4(0, 0, 0, 1);
    } else {
      pixel = brightest > 0 ? colour_of(1 - std::log10(largest / brightest) / lowest_decade) : colour_of(1);
    }
  }
  return result;
}

uint32_t top_of_scale(std::vector<uint32_t> counts) {
  std::erase(counts, 0u);
  if (counts.empty()) return 1;
  return percentile_99(std::move(counts));
}

Image heat_map(int width, int height, const std::vector<uint32_t>& counts, uint32_t top) {
  assert(counts.size() == size_t(width) * height);
  const Lookup colour_of(viridis_ramp());
  Image result(width, height);
  for (size_t i = 0; i < counts.size(); ++i) {
    result.pixels[i] = counts[i] ? colour_of(double(counts[i]) / std::max(top, 1u)) : glm::vec4(0, 0, 0, 1);
  }
  return result;
}

Image mean_of_blocks(const Image& image, int factor) {
  Image result(blocks_along(image.width, factor), blocks_along(image.height, factor));
  std::vector<float> count(result.pixels.size(), 0);
  for_each_pixel(image.width, image.height, factor, [&](size_t block, size_t pixel) {
    result.pixels[block] += image.pixels[pixel];
    count[block] += 1;
  });
  for (size_t i = 0; i < count.size(); ++i) result.pixels[i] /= count[i];
  return result;
}

std::vector<uint32_t> largest_of_blocks(const std::vector<uint32_t>& counts, int width, int height,
                                        int factor) {
  std::vector<uint32_t> result(size_t(blocks_along(width, factor)) * blocks_along(height, factor), 0);
  for_each_pixel(width, height, factor,
                 [&](size_t block, size_t pixel) { result[block] = std::max(result[block], counts[pixel]); });
  return result;
}

Image worst_of_blocks(const Image& picture, const Image& image, const Image& reference, int factor) {
  Image result(blocks_along(image.width, factor), blocks_along(image.height, factor));
  std::vector<double> worst(result.pixels.size(), -1);
  for_each_pixel(image.width, image.height, factor, [&](size_t block, size_t pixel) {
    const double d = distance(image.pixels[pixel], reference.pixels[pixel]);
    if (d > worst[block]) {
      worst[block] = d;
      result.pixels[block] = picture.pixels[pixel];
    }
  });
  return result;
}

}  // namespace lightgrid::lab
