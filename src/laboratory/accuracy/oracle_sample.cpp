#include "accuracy/oracle_sample.h"

#include <algorithm>
#include <cmath>

#include "measures/metrics.h"
#include "oracle/attenuation.h"
#include "oracle/position.h"
#include "plan/settings/model.h"

namespace lightgrid::lab {
namespace {

double largest_difference(const glm::vec4& a, const glm::vec4& b) {
  double largest = 0;
  for (int c = 0; c < 3; ++c) {
    const double difference = a[c] == b[c] ? 0 : std::abs(double(a[c]) - double(b[c]));
    largest =
        std::max(largest, std::isnan(difference) ? std::numeric_limits<double>::infinity() : difference);
  }
  return largest;
}

struct Sums {
  double largest = 0, squares = 0;
  void add(float value, double exact) {
    const double difference = std::abs(double(value) - exact);
    const double error = std::isnan(difference) ? std::numeric_limits<double>::infinity() : difference;
    largest = std::max(largest, error);
    squares += error * error;
  }
};

}  // namespace

SurfaceOracle::SurfaceOracle(RenderView& v, std::vector<float> depth, ShadowTruth* shadows)
    : v_(v),
      depth_(std::move(depth)),
      surfaces_(read_surfaces(v)),
      lights_(lights_in_view(v.scene, v.view, ranges_of(meant_by(v.plan.settings)))),
      own_shadows_(shadows ? nullptr : std::make_unique<ShadowTruth>(v.scene, 0)),
      shadows_(shadows ? shadows : own_shadows_.get()) {
  if (shadows_->casts() || v.plan.masks.needed) {
    const std::vector<SceneTriangle> shown = read_triangles(v).opaque;
    if (shadows_->casts()) triangles_ = casting_triangles(v.scene, shown);
    masks_ = masks_of_pixels(v.plan, v.scene, shown);
  }
  for (const uint32_t pixel : covered_pixels(depth_)) {
    surfaces_.blended[pixel] ? void(++left_out_) : pixels_.push_back(pixel);
  }
}

std::vector<uint32_t> SurfaceOracle::decided(std::vector<uint32_t> pixels, bool window) const {
  const std::unique_ptr<SeenPairs> seen = shadows_->at_pixels(v_, depth_, triangles_, pixels, window);
  if (seen) std::erase_if(pixels, [&](uint32_t pixel) { return seen->has_either(pixel); });
  std::vector<ViewLight> hard;
  std::ranges::copy_if(lights_, std::back_inserter(hard), has_hard_edge);
  if (hard.empty()) return pixels;
  const View& view = v_.view;
  std::erase_if(pixels, [&](uint32_t p) {
    const auto at = position_from_depth(view, int(p) % view.width, int(p) / view.width, depth_[p]);
    return std::ranges::any_of(hard, [&](const ViewLight& l) { return is_near_hard_edge(l, at); });
  });
  return pixels;
}

std::vector<glm::dvec3> SurfaceOracle::shade(const std::vector<uint32_t>& pixels, bool window) const {
  const auto surface_at = [&](uint32_t pixel) {
    Surface surface = surface_of(surfaces_, pixel);
    if (!masks_.empty()) surface.mask = masks_[pixel];
    return surface;
  };
  ShadeSettings settings{
      .brdf = v_.plan.settings[setting::brdf], .ambient = v_.scene.ambient, .window = window};
  settings.base = base_terms(v_.scene, v_.view, v_.plan);
  const std::unique_ptr<SeenPairs> seen = shadows_->at_pixels(v_, depth_, triangles_, pixels, window);
  if (seen) settings.hidden = seen->hidden();
  return shade_pixels(v_.view, depth_, surface_at, lights_, settings, pixels);
}

Image at_pixels(const Image& image, const std::vector<uint32_t>& pixels) {
  Image picked(int(pixels.size()), 1);
  for (size_t i = 0; i < pixels.size(); ++i) picked.pixels[i] = image.pixels[pixels[i]];
  return picked;
}

std::vector<uint32_t> most_different(const Image& image, const Image& reference,
                                     const std::vector<uint32_t>& among, size_t most) {
  std::vector<std::pair<double, uint32_t>> differences;
  for (const uint32_t pixel : among) {
    const double difference = largest_difference(image.pixels[pixel], reference.pixels[pixel]);
    if (difference > 0) differences.emplace_back(-difference, pixel);
  }
  const auto end = differences.begin() + std::ptrdiff_t(std::min(most, differences.size()));
  std::partial_sort(differences.begin(), end, differences.end());
  std::vector<uint32_t> pixels;
  for (auto at = differences.begin(); at != end; ++at) pixels.push_back(at->second);
  return pixels;
}

OracleError oracle_error(const Image& image, const Image& reference, const std::vector<uint32_t>& pixels,
                         const std::vector<glm::dvec3>& radiance) {
  Sums own, of_reference;
  for (size_t i = 0; i < pixels.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      own.add(image.pixels[pixels[i]][c], radiance[i][c]);
      of_reference.add(reference.pixels[pixels[i]][c], radiance[i][c]);
    }
  }
  const double brightest = brightest_channel(reference);
  const auto relative = [&](double error) {
    return error == 0 ? 0 : brightest > 0 ? error / brightest : std::numeric_limits<double>::infinity();
  };
  return {relative(own.largest),
          relative(std::sqrt(own.squares / double(std::max<size_t>(3 * pixels.size(), 1)))),
          relative(of_reference.largest)};
}

size_t affordable_samples(size_t most, const Scene& scene) {
  constexpr size_t max_pairs = 400'000'000, max_of_casters = 4'000'000, least = 100;
  const size_t casters = size_t(std::ranges::count_if(scene.lights, &Light::casts_shadow));
  return std::min({most, std::max(max_pairs / std::max<size_t>(scene.lights.size(), 1), least),
                   std::max(max_of_casters / std::max<size_t>(casters, 1), least)});
}

}  // namespace lightgrid::lab
