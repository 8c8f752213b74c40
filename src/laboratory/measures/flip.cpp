#include "measures/flip.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <memory>
#include <numbers>
#include <numeric>

#include <glm/gtc/matrix_inverse.hpp>

#include "base/parallel.h"
#include "measures/metrics.h"

namespace lightgrid::lab {
namespace {

using std::numbers::pi;

// Three channels of so many pixels each.
struct Planes {
  Planes(int width, int height) : width(width), height(height) {
    for (std::vector<double>& channel : channels) channel.resize(size_t(width) * size_t(height));
  }
  size_t pixels() const { return channels[0].size(); }
  glm::dvec3 at(size_t i) const { return {channels[0][i], channels[1][i], channels[2][i]}; }
  void set(size_t i, const glm::dvec3& color) {
    for (int c = 0; c < 3; ++c) channels[c][i] = color[c];
  }

  int width, height;
  std::vector<double> channels[3];
};

// --- Colour spaces
// ---------------------------------------------------------------------------------------------------

// Linear sRGB to CIE XYZ (D65), column by column: the rational numbers that follow from the primaries.
const glm::dmat3 xyz_from_rgb(10135552.0 / 24577794, 2613072.0 / 12288897, 1425312.0 / 73733382,  //
                              8788810.0 / 24577794, 8788810.0 / 12288897, 8788810.0 / 73733382,   //
                              4435075.0 / 24577794, 887015.0 / 12288897, 70074185.0 / 73733382);
const glm::dmat3 rgb_from_xyz = glm::inverse(xyz_from_rgb);
const glm::dvec3 white = xyz_from_rgb * glm::dvec3(1);

// Linearised CIELAB (Flohr et al. 1993), the space in which eyes filter.
glm::dvec3 ycxcz_from_rgb(const glm::dvec3& rgb) {
  const glm::dvec3 v = xyz_from_rgb * rgb / white;
  return {116 * v.y - 16, 500 * (v.x - v.y), 200 * (v.y - v.z)};
}

glm::dvec3 rgb_from_ycxcz(const glm::dvec3& color) {
  const double y = (color.x + 16) / 116;
  return rgb_from_xyz * (glm::dvec3(y + color.y / 500, y, y - color.z / 200) * white);
}

double lab_curve(double t) {
  constexpr double delta = 6.0 / 29;
  return t > delta * delta * delta ? std::cbrt(t) : t / (3 * delta * delta) + 4.0 / 29;
}

// CIELAB with a and b scaled by lightness, after Hunt: colours look less colourful in the dark.
glm::dvec3 hunt_lab_from_rgb(const glm::dvec3& rgb) {
  const glm::dvec3 v = xyz_from_rgb * rgb / white;
  const double x = lab_curve(v.x), y = lab_curve(v.y), z = lab_curve(v.z), lightness = 116 * y - 16;
  return {lightness, 0.01 * lightness * 500 * (x - y), 0.01 * lightness * 200 * (y - z)};
}

// Abasi et al. 2020: a distance that holds for large differences too.
double hyab(const glm::dvec3& a, const glm::dvec3& b) {
  return std::abs(a.x - b.x) + glm::distance(glm::dvec2(a.y, a.z), glm::dvec2(b.y, b.z));
}

// --- Filters
// ---------------------------------------------------------------------------------------------------------

constexpr size_t rows_at_once = 16, pixels_at_once = 4096;

using Kernel = std::vector<double>;  // from -radius to radius

Kernel sampled(int radius, const auto& function) {
  Kernel kernel;
  for (int i = -radius; i <= radius; ++i) kernel.push_back(function(double(i)));
  return kernel;
}

// Positive weights then add up to 1, negative ones to -1.
void normalize(Kernel& kernel) {
  double positive = 0, negative = 0;
  for (const double w : kernel) (w > 0 ? positive : negative) += w;
  for (double& w : kernel) w /= w > 0 ? positive : -negative;
}

// to[x] is the sum of kernel[i] * from[x + i * stride]. Sixteen sums at once stay in registers.
void filter_row(const double* from, size_t stride, const Kernel& kernel, int width, double* to) {
  constexpr int block = 16;
  int x = 0;
  for (; x + block <= width; x += block) {
    double sums[block] = {};
    for (size_t i = 0; i < kernel.size(); ++i) {
      for (int k = 0; k < block; ++k) sums[k] += kernel[i] * from[size_t(x) + i * stride + size_t(k)];
    }
    for (int k = 0; k < block; ++k) to[x + k] = sums[k];
  }
  for (; x < width; ++x) {
    to[x] = 0;
    for (size_t i = 0; i < kernel.size(); ++i) to[x] += kernel[i] * from[size_t(x) + i * stride];
  }
}

// Values of one channel, filtered along rows, with `radius` rows more at each end. Beyond the image its edge
// goes on.
struct FilteredRows {
  int width, radius;
  std::vector<double> values;
};

FilteredRows filtered_rows(const std::vector<double>& in, int width, int height, const Kernel& across,
                           int radius) {
  const int padded = height + 2 * radius, reach = int(across.size() / 2);
  FilteredRows rows{width, radius, std::vector<double>(size_t(padded) * size_t(width))};
  parallel_runs(size_t(padded), rows_at_once, [&](size_t first, size_t end) {
    std::vector<double> row(size_t(width) + across.size() - 1);
    for (size_t y = first; y < end; ++y) {
      const double* from = in.data() + std::clamp(int(y) - radius, 0, height - 1) * std::ptrdiff_t(width);
      for (size_t x = 0; x < row.size(); ++x) row[x] = from[std::clamp(int(x) - reach, 0, width - 1)];
      filter_row(row.data(), 1, across, width, rows.values.data() + y * size_t(width));
    }
  });
  return rows;
}

// The row of that number, filtered along columns by a kernel of the rows' radius.
void filter_column(const FilteredRows& rows, const Kernel& up, size_t y, double* to) {
  filter_row(rows.values.data() + y * size_t(rows.width), size_t(rows.width), up, rows.width, to);
}

// One Gaussian of a contrast sensitivity function: a sqrt(pi / b) exp(-pi^2 d^2 / b), d in degrees.
struct Sensitivity {
  double a, b;
};

Kernel root_of_gaussian(const Sensitivity& s, int radius, double pixels_per_degree) {
  return sampled(radius, [&](double i) {
    const double d = i / pixels_per_degree;
    return std::sqrt(s.a * std::sqrt(pi / s.b)) * std::exp(-pi * pi * d * d / s.b);
  });
}

// The image as an eye sees it: each opponent channel blurred by its contrast sensitivity (2020,
// section 4.1.1).
Planes seen(const Planes& ycxcz, double pixels_per_degree) {
  static const std::vector<Sensitivity> sensitivities[3] = {
      {{1, 0.0047}}, {{1, 0.0053}}, {{34.1, 0.04}, {13.5, 0.025}}};
  constexpr double widest = 0.04;
  const int radius = int(std::ceil(3 * std::sqrt(widest / (2 * pi * pi)) * pixels_per_degree));
  Planes out(ycxcz.width, ycxcz.height);
  for (int channel = 0; channel < 3; ++channel) {
    double weights = 0;
    std::vector<Kernel> kernels;
    std::vector<FilteredRows> rows;
    for (const Sensitivity& s : sensitivities[channel]) {
      kernels.push_back(root_of_gaussian(s, radius, pixels_per_degree));
      const double sum = std::accumulate(kernels.back().begin(), kernels.back().end(), 0.0);
      weights += sum * sum;
      rows.push_back(
          filtered_rows(ycxcz.channels[channel], ycxcz.width, ycxcz.height, kernels.back(), radius));
    }
    parallel_runs(size_t(ycxcz.height), rows_at_once, [&](size_t first, size_t end) {
      std::vector<double> blurred(size_t(ycxcz.width));
      for (size_t y = first; y < end; ++y) {
        double* to = out.channels[channel].data() + y * size_t(ycxcz.width);
        for (size_t i = 0; i < kernels.size(); ++i) {
          filter_column(rows[i], kernels[i], y, blurred.data());
          for (size_t x = 0; x < blurred.size(); ++x) to[x] += blurred[x];
        }
        for (size_t x = 0; x < blurred.size(); ++x) to[x] /= weights;
      }
    });
  }
  return out;
}

// Magnitudes of first and second derivatives of lightness: edges and points (2020, section 4.2).
struct Features {
  std::vector<double> edges, points;
};

Features features_of(const Planes& ycxcz, double pixels_per_degree) {
  constexpr double feature_degrees = 0.082;
  const double sigma = 0.5 * feature_degrees * pixels_per_degree;
  const int radius = int(std::ceil(3 * sigma));
  const auto gaussian = [&](double x) { return std::exp(-x * x / (2 * sigma * sigma)); };
  Kernel smooth = sampled(radius, gaussian);
  Kernel edge = sampled(radius, [&](double x) { return -x * gaussian(x); });
  Kernel point = sampled(radius, [&](double x) { return (x * x / (sigma * sigma) - 1) * gaussian(x); });
  for (Kernel* kernel : {&smooth, &edge, &point}) normalize(*kernel);
  std::vector<double> lightness(ycxcz.pixels());
  parallel_runs(lightness.size(), pixels_at_once, [&](size_t first, size_t end) {
    for (size_t i = first; i < end; ++i) lightness[i] = (ycxcz.channels[0][i] + 16) / 116;
  });
  const auto rows_of = [&](const Kernel& across) {
    return filtered_rows(lightness, ycxcz.width, ycxcz.height, across, radius);
  };
  const FilteredRows smoothed = rows_of(smooth);
  const auto magnitude = [&](const Kernel& derivative) {
    const FilteredRows derived = rows_of(derivative);
    std::vector<double> out(lightness.size());
    parallel_runs(size_t(ycxcz.height), rows_at_once, [&](size_t first, size_t end) {
      std::vector<double> up(size_t(ycxcz.width));
      for (size_t y = first; y < end; ++y) {
        double* across = out.data() + y * size_t(ycxcz.width);
        filter_column(derived, smooth, y, across);
        filter_column(smoothed, derivative, y, up.data());
        for (size_t x = 0; x < up.size(); ++x) across[x] = std::sqrt(across[x] * across[x] + up[x] * up[x]);
      }
    });
    return out;
  };
  return {magnitude(edge), magnitude(point)};
}

// --- The difference
// --------------------------------------------------------------------------------------------------

constexpr double color_exponent = 0.7;

// The colour difference of two pixels in Hunt-adjusted CIELAB, from 0 to 1: large differences are compressed,
// since they all look large.
double color_difference(const glm::dvec3& test, const glm::dvec3& reference) {
  constexpr double knee_in = 0.4, knee_out = 0.95;
  static const double largest =
      std::pow(hyab(hunt_lab_from_rgb({0, 1, 0}), hunt_lab_from_rgb({0, 0, 1})), color_exponent);
  const double error = std::pow(hyab(test, reference), color_exponent);
  const double knee = knee_in * largest;
  return error < knee ? error * knee_out / knee
                      : knee_out + (error - knee) / (largest - knee) * (1 - knee_out);
}

Planes ycxcz_of(const Image& image) {
  Planes planes(image.width, image.height);
  parallel_runs(image.pixels.size(), pixels_at_once, [&](size_t first, size_t end) {
    for (size_t i = first; i < end; ++i) {
      const glm::vec4& pixel = image.pixels[i];
      const glm::dvec3 rgb = has_nan(pixel) ? glm::dvec3(0) : glm::clamp(glm::dvec3(pixel), 0.0, 1.0);
      planes.set(i, ycxcz_from_rgb(rgb));
    }
  });
  return planes;
}

}  // namespace

// FLIP compares these parts of an image.
struct SeenImage {
  Planes color;  // Hunt-adjusted CIELAB of what an eye sees
  Features features;
  std::vector<uint8_t> nan;  // 1: the pixel is
};

namespace {

SeenImage seen_image(const Image& image, double pixels_per_degree) {
  const Planes opponent = ycxcz_of(image);
  SeenImage s{seen(opponent, pixels_per_degree), features_of(opponent, pixels_per_degree),
              std::vector<uint8_t>(image.pixels.size())};
  parallel_runs(image.pixels.size(), pixels_at_once, [&](size_t first, size_t end) {
    for (size_t i = first; i < end; ++i) {
      s.color.set(i, hunt_lab_from_rgb(glm::clamp(rgb_from_ycxcz(s.color.at(i)), 0.0, 1.0)));
      s.nan[i] = has_nan(image.pixels[i]);
    }
  });
  return s;
}

std::vector<float> difference_map(const SeenImage& test, const SeenImage& reference) {
  assert(test.color.width == reference.color.width && test.color.height == reference.color.height);
  const Features &f = test.features, &g = reference.features;
  std::vector<float> map(test.color.pixels());
  parallel_runs(map.size(), pixels_at_once, [&](size_t first, size_t end) {
    for (size_t i = first; i < end; ++i) {
      const double color = color_difference(test.color.at(i), reference.color.at(i));
      const double difference =
          std::max(std::abs(f.edges[i] - g.edges[i]), std::abs(f.points[i] - g.points[i]));
      const double feature = std::sqrt(difference / std::numbers::sqrt2);
      map[i] = test.nan[i] || reference.nan[i] ? 1.0f : float(std::pow(color, 1 - feature));
    }
  });
  return map;
}

// --- Exposures
// -------------------------------------------------------------------------------------------------------

// Narkowicz' fit of ACES with the factor 0.6 that the authors use: (a x^2 + b x) / (c x^2 + d x + e).
constexpr double aces_a = 0.6 * 0.6 * 2.51, aces_b = 0.6 * 0.03, aces_c = 0.6 * 0.6 * 2.43,
                 aces_d = 0.6 * 0.59, aces_e = 0.14;

double aces(double x) { return (aces_a * x * x + aces_b * x) / (aces_c * x * x + aces_d * x + aces_e); }

// The value that the tone map brings to `out`.
double inverse_aces(double out) {
  const double a = aces_a - out * aces_c, b = aces_b - out * aces_d, c = -out * aces_e;
  return (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a);
}

Image exposed(const Image& image, double stops) {
  const double factor = std::exp2(stops);
  Image out = image;
  parallel_runs(out.pixels.size(), pixels_at_once, [&](size_t first, size_t end) {
    for (size_t i = first; i < end; ++i) {
      glm::vec4& pixel = out.pixels[i];
      for (int c = 0; c < 3; ++c) {
        const double x = std::max(double(pixel[c]), 0.0) * factor;
        if (!std::isnan(pixel[c])) pixel[c] = std::isinf(x) ? 1.0f : float(aces(x));
      }
    }
  });
  return out;
}

// From a PNG file's bytes, row 0 at the top as there.
SeenImage seen_on_display(const std::vector<uint8_t>& bytes, int width, int height) {
  std::array<float, 256> linear_of;
  for (size_t byte = 0; byte < linear_of.size(); ++byte)
    linear_of[byte] = linear_from_srgb(float(byte) / 255);
  Image linear(width, height);
  parallel_runs(linear.pixels.size(), pixels_at_once, [&](size_t first, size_t end) {
    for (size_t i = first; i < end; ++i) {
      for (int c = 0; c < 3; ++c) linear.pixels[i][c] = linear_of[bytes[3 * i + size_t(c)]];
    }
  });
  return seen_image(linear, default_pixels_per_degree);
}

}  // namespace

std::vector<float> flip_map(const Image& test, const Image& reference, double pixels_per_degree) {
  return difference_map(seen_image(test, pixels_per_degree), seen_image(reference, pixels_per_degree));
}

SeenByFlip::SeenByFlip(const Image& image, double pixels_per_degree)
    : seen_(std::make_shared<const SeenImage>(seen_image(image, pixels_per_degree))) {}

std::vector<float> SeenByFlip::map(const SeenByFlip& other) const {
  return difference_map(*seen_, *other.seen_);
}

std::optional<FlipExposures> flip_exposures(const Image& reference) {
  if (reference.pixels.empty()) return {};
  std::vector<double> luminances;
  for (const glm::vec4& p : reference.pixels)
    luminances.push_back(0.2126 * p.r + 0.7152 * p.g + 0.0722 * p.b);
  const auto middle = luminances.begin() + luminances.size() / 2;
  std::ranges::nth_element(luminances, middle);
  const double median = *middle, most = std::ranges::max(luminances), x = inverse_aces(0.85);
  if (!(median > 0) || !(most < std::numeric_limits<double>::infinity())) return {};
  FlipExposures e{std::log2(x / most), std::log2(x / median), 0};
  e.count = std::max(2, int(std::ceil(e.stop - e.start)));
  return e;
}

HdrFlip::HdrFlip(const Image& reference, const FlipExposures& exposures, double pixels_per_degree) {
  const auto images = std::make_shared<std::vector<SeenImage>>();  // one an exposure
  const auto seen_at = [=](const Image& image, int i) {
    const double step = exposures.count > 1 ? (exposures.stop - exposures.start) / (exposures.count - 1) : 0;
    return seen_image(exposed(image, exposures.start + i * step), pixels_per_degree);
  };
  for (int i = 0; i < exposures.count; ++i) images->push_back(seen_at(reference, i));
  map_at_ = [=](const Image& test, int i) { return difference_map(seen_at(test, i), images->at(size_t(i))); };
  count_ = exposures.count;
}

std::vector<float> HdrFlip::map(const Image& test) const {
  std::vector<float> worst(test.pixels.size(), 0.0f);
  for (int i = 0; i < count_; ++i) {
    const std::vector<float> map = map_at_(test, i);
    for (size_t k = 0; k < map.size(); ++k) worst[k] = std::max(worst[k], map[k]);
  }
  return worst;
}

std::vector<float> hdr_flip_map(const Image& test, const Image& reference, const FlipExposures& exposures,
                                double pixels_per_degree) {
  return HdrFlip(reference, exposures, pixels_per_degree).map(test);
}

std::vector<float> displayed_flip_map(const Image& image, const Image& reference, const Exposure& exposure) {
  const auto seen = [&](const Image& picture) {
    return seen_on_display(srgb_bytes(picture, exposure), picture.width, picture.height);
  };
  const std::vector<float> from_the_top = difference_map(seen(image), seen(reference));
  std::vector<float> map;
  map.reserve(from_the_top.size());
  for (auto row = from_the_top.end(); row != from_the_top.begin();) {
    row -= image.width;
    map.insert(map.end(), row, row + image.width);
  }
  return map;
}

DisplayedFlip displayed_flip_of(const std::vector<float>& map) {
  const auto visible = std::ranges::count_if(map, [](float flip) { return flip > visible_flip; });
  return {mean_of(map), double(visible) / double(map.size())};
}

Image flip_picture(const std::vector<float>& map, int width, int height) {
  constexpr uint32_t top = 253;  // steps of the ramp
  std::vector<uint32_t> steps;
  for (const float value : map) steps.push_back(uint32_t(std::lround(double(value) * top)));
  return heat_map(width, height, steps, top);
}

ShownReference::ShownReference(const Image& reference, const Exposure& exposure) {
  const int width = reference.width, height = reference.height;
  const auto expected = std::make_shared<std::vector<uint8_t>>(srgb_bytes(reference, exposure));
  const auto seen_reference = std::make_shared<SeenImage>(seen_on_display(*expected, width, height));
  flip_of_ = [=](const Image& image) -> DisplayedFlip {
    const std::vector<uint8_t> shown = srgb_bytes(image, exposure);
    if (shown == *expected) return {};
    return displayed_flip_of(difference_map(seen_on_display(shown, width, height), *seen_reference));
  };
}

DisplayedFlip ShownReference::flip_of(const Image& image) const { return flip_of_(image); }

DisplayedFlip displayed_flip(const Image& image, const Image& reference, const Exposure& exposure) {
  return ShownReference(reference, exposure).flip_of(image);
}

double mean_of(const std::vector<float>& map) {
  return map.empty() ? 0 : std::accumulate(map.begin(), map.end(), 0.0) / double(map.size());
}

}  // namespace lightgrid::lab
