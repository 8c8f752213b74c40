#include "results/flicker.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>

#include "base/parallel.h"
#include "results/metrics.h"

namespace lightgrid {
namespace {

constexpr size_t run_of_pixels = 4096;

void for_each_pixel(const Image& image, const auto& body) {
  parallel_runs(image.pixels.size(), run_of_pixels, [&](size_t first, size_t end) {
    for (size_t i = first; i < end; ++i) body(i);
  });
}

// Values of the frame before at what pixel `i` shows; empty: it does not show it. In double: adding and
// subtracting floats is then exact unless they are very different, so that an error that stays leaves
// nothing.
std::optional<glm::dvec3> carried(const TruthFrame& truth, size_t i, const auto& value_at) {
  if (truth.carried.empty()) return value_at(i);
  const CarriedPixel& from = truth.carried[i];
  std::optional<glm::dvec3> sum;
  for (int k = 0; k < 4; ++k) {
    if (from.weights[k] == 0) continue;
    const size_t x = size_t(from.x + k % 2), y = size_t(from.y + k / 2);
    if (!sum) sum = glm::dvec3(0);
    *sum += double(from.weights[k]) * value_at(y * size_t(truth.shown.width) + x);
  }
  return sum;
}

bool is_finite(const glm::dvec3& v) { return std::isfinite(v.x + v.y + v.z); }

void add(DisplayedFlip& sum, const DisplayedFlip& flip) {
  sum.mean += flip.mean, sum.visible += flip.visible;
}

DisplayedFlip mean_flip(const DisplayedFlip& sum, int count) {
  return count == 0 ? DisplayedFlip() : DisplayedFlip{sum.mean / count, sum.visible / count};
}

}  // namespace

Image shown_image(const Image& image, const Exposure& exposure) {
  Image shown(image.width, image.height);
  const float scale = exposure.scale();
  for_each_pixel(image, [&](size_t i) {
    shown.pixels[i] = glm::vec4(tone_map_neutral(scale * glm::vec3(image.pixels[i])), 1);
  });
  return shown;
}

Image FlickerMeter::filtered(const Image& shown, const TruthFrame& truth) const {
  Image mean = shown;
  const double newest = std::max(double(newest_frame_counts), 1.0 / (frames_ + 1));
  for_each_pixel(shown, [&](size_t i) {
    const auto before = carried(truth, i, [&](size_t k) { return glm::dvec3(last_.pixels[k]); });
    if (!before || !is_finite(*before)) return;
    const glm::dvec3 mixed = *before + newest * (glm::dvec3(shown.pixels[i]) - *before);
    mean.pixels[i] = glm::vec4(glm::vec3(mixed), 1);
  });
  return mean;
}

// The frame as it would be with the error of the frame before.
Image FlickerMeter::expected(const Image& picture, const TruthFrame& truth) const {
  Image expected = picture;
  for_each_pixel(picture, [&](size_t i) {
    const auto error = carried(
        truth, i, [&](size_t k) { return glm::dvec3(last_.pixels[k]) - glm::dvec3(truth.before.pixels[k]); });
    if (!error) return;
    const glm::dvec3 value = glm::dvec3(truth.shown.pixels[i]) + *error;
    // NaN that stays is no flicker; FLIP counts it as an error.
    if (has_nan(picture.pixels[i]) && !is_finite(value)) return;
    expected.pixels[i] = glm::vec4(glm::clamp(glm::vec3(value), 0.0f, 1.0f), 1);
  });
  return expected;
}

void FlickerMeter::add(const Image& shown, const TruthFrame& truth, bool counts) {
  assert(shown.pixels.size() == truth.shown.pixels.size());
  const bool first = last_.pixels.empty();
  Image picture = filtered_ && !first ? filtered(shown, truth) : shown;
  if (counts) {
    std::optional<SeenByFlip> seen;
    const auto flip_against = [&](const SeenByFlip& other) {
      if (!seen) seen.emplace(picture);
      return displayed_flip_of(seen->map(other));
    };
    const bool rests = !first && truth.same && picture.pixels == last_.pixels && counted_ > 0;
    if (!rests) error_ = picture.pixels == truth.shown.pixels ? DisplayedFlip() : flip_against(*truth.seen);
    lightgrid::add(sums_.displayed, error_);
    ++counted_;
    if (!first) {
      const Image without_flicker = expected(picture, truth);
      const DisplayedFlip step = picture.pixels == without_flicker.pixels
                                     ? DisplayedFlip()
                                     : flip_against(SeenByFlip(without_flicker));
      lightgrid::add(sums_.flicker, step);
      sums_.largest_flicker = std::max(sums_.largest_flicker, step.mean);
      ++steps_;
    }
  }
  last_ = std::move(picture);
  ++frames_;
}

SequenceFigures FlickerMeter::figures() const {
  return {mean_flip(sums_.flicker, steps_), sums_.largest_flicker, mean_flip(sums_.displayed, counted_)};
}

}  // namespace lightgrid
