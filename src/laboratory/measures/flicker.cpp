#include "measures/flicker.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>

#include "base/parallel.h"
#include "measures/metrics.h"

namespace lightgrid::lab {
namespace {

constexpr size_t run_of_pixels = 4096;

void for_each_pixel(const Image& image, const auto& body) {
  parallel_runs(image.pixels.size(), run_of_pixels, [&](size_t first, size_t end) {
    for (size_t i = first; i < end; ++i) body(i);
  });
}

// The values of `before` at what pixel `i` shows; empty: it does not show it.
std::optional<glm::dvec3> carried_value(const Image& before, const std::vector<CarriedPixel>& carried,
                                        size_t i) {
  if (carried.empty()) return glm::dvec3(before.pixels[i]);
  const CarriedPixel& from = carried[i];
  std::optional<glm::dvec3> sum;
  for (int k = 0; k < 4; ++k) {
    if (from.weights[k] == 0) continue;
    if (!sum) sum = glm::dvec3(0);
    *sum += double(from.weights[k]) * glm::dvec3(before.at(from.x + k % 2, from.y + k / 2));
  }
  return sum;
}

bool is_finite(const glm::dvec3& v) { return std::isfinite(v.x + v.y + v.z); }

void add_to(DisplayedFlip& sum, const DisplayedFlip& flip) {
  sum.mean += flip.mean;
  sum.visible += flip.visible;
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

std::vector<float> step_map(const Image& frame, const SeenByFlip& seen, const Image& before,
                            const std::vector<CarriedPixel>& carried) {
  Image there = frame;
  for_each_pixel(frame, [&](size_t i) {
    if (const auto value = carried_value(before, carried, i))
      there.pixels[i] = glm::vec4(glm::vec3(*value), 1);
  });
  return seen.map(SeenByFlip(there));
}

Image FlickerMeter::filtered(const Image& shown, const TruthFrame& truth) const {
  Image mean = shown;
  const double newest = std::max(double(newest_frame_counts), 1.0 / (frames_ + 1));
  for_each_pixel(shown, [&](size_t i) {
    const auto before = carried_value(last_, truth.carried, i);
    if (!before || !is_finite(*before)) return;
    const glm::dvec3 mixed = *before + newest * (glm::dvec3(shown.pixels[i]) - *before);
    mean.pixels[i] = glm::vec4(glm::vec3(mixed), 1);
  });
  return mean;
}

// A picture that is the truth, or rests, does not flicker.
DisplayedFlip FlickerMeter::flicker(const Image& picture, const TruthFrame& truth,
                                    const std::function<const SeenByFlip&()>& seen) const {
  if (truth.carried.empty() && picture.pixels == last_.pixels) return {};
  std::vector<float> excess = step_map(picture, seen(), last_, truth.carried);
  for (size_t i = 0; i < excess.size() && !truth.step.empty(); ++i)
    excess[i] = std::max(excess[i] - truth.step[i], 0.0f);
  return displayed_flip_of(excess);
}

void FlickerMeter::add(const Image& shown, const TruthFrame& truth, bool counts) {
  assert(shown.pixels.size() == truth.shown.pixels.size());
  const bool first = last_.pixels.empty();
  Image picture = filtered_ && !first ? filtered(shown, truth) : shown;
  if (counts) {
    std::optional<SeenByFlip> seen;
    const auto seen_picture = [&]() -> const SeenByFlip& { return seen ? *seen : seen.emplace(picture); };
    const bool rests = !first && truth.step.empty() && picture.pixels == last_.pixels && counted_ > 0;
    if (!rests)
      error_ = picture.pixels == truth.shown.pixels ? DisplayedFlip()
                                                    : displayed_flip_of(seen_picture().map(*truth.seen));
    add_to(sums_.displayed, error_);
    ++counted_;
    if (!first) {
      const DisplayedFlip step = flicker(picture, truth, seen_picture);
      add_to(sums_.flicker, step);
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

}  // namespace lightgrid::lab
