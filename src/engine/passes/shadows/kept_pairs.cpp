#include "passes/shadows/kept_pairs.h"

#include <algorithm>
#include <cmath>

#include "cl/transfer.h"
#include "plan/settings/shadows.h"
#include "shared/kept_shadows.h"
#include "shared/shadow_bits.h"

namespace lightgrid {
namespace {

size_t words_of(size_t lights) { return (lights + 31) / 32; }

std::vector<int> numbers_of(const FramePlan& plan) {
  std::vector<int> numbers(plan.lights.local.begin(), plan.lights.local.end());
  numbers.insert(numbers.end(), plan.lights.directional.begin(), plan.lights.directional.end());
  return numbers;
}

// Returns false only if the light shades no surface in the box and none of its rays meets the box. Rays end at
// pixels in the light's reach. The rasteriser moves these by less than a pixel, and the rounding of depths by
// less than 2^-20 of their distance.
bool may_meet(const ShadowLight& light, const WorldBox& box, const View& view, const glm::dvec3& origin) {
  if (box.empty()) return false;
  if (light.w == 0) return true;
  const glm::dvec3 at(light.x, light.y, light.z),
      low = box.min - origin, high = box.max - origin,
      far = glm::abs(at) + glm::max(glm::abs(low), glm::abs(high));
  const double reach = std::sqrt(std::max(double(light.reach_squared), 0.0)) + double(light.source_m);
  const glm::dmat4& clip = view.clip_from_view;
  const double pixel = 2 / std::min(std::abs(clip[0][0]) * view.width, std::abs(clip[1][1]) * view.height),
               distance =
                   view.orthographic ? view.far_m - view.near_m : glm::length(at + origin - view.eye) + reach,
               moved = 0x1p-20 * distance + (view.orthographic ? pixel : pixel * distance);
  const double away = glm::length(at - glm::clamp(at, low, high));
  return !(away > 1.001 * reach + moved + 1e-5 * (far.x + far.y + far.z));
}

}  // namespace

bool KeptPairs::serve(const Settings& settings) {
  return settings[setting::shadows] == ShadowMethod::exact && !picks_shadows(settings);
}

std::vector<uint32_t> KeptPairs::kept_lights(const PassContext& work, const std::vector<ShadowLight>& records,
                                             const std::vector<int>& numbers, const glm::dvec3& origin,
                                             const std::vector<WorldBox>& moved) const {
  std::vector<uint32_t> before(work.scene.lights.size(), NOT_KEPT), kept;
  for (size_t i = 0; i < numbers_.size(); ++i)
    if (size_t(numbers_[i]) < before.size()) before[size_t(numbers_[i])] = uint32_t(i);
  for (size_t i = 0; i < records.size(); ++i) {
    const uint32_t old = before[size_t(numbers[i])];
    // The places of rays on a light's sphere depend on the light's number.
    const bool is_same = old != NOT_KEPT && have_same_shadows(records[i], records_[old]) &&
                         (old == i || !work.plan.shadows.bytes);
    const auto meets = [&](const WorldBox& box) { return may_meet(records[i], box, work.view, origin); };
    kept.push_back(is_same && std::ranges::none_of(moved, meets) ? old : NOT_KEPT);
  }
  return kept;
}

void KeptPairs::look(PassContext& work, const RayScene& rays, const std::vector<ShadowLight>& records) {
  std::vector<int> numbers = numbers_of(work.plan);
  const auto moved = moved_.since_last(work.gpu, rays);
  keeps_ = is_found_ && moved && view_ == work.view && origin_ == rays.origin() &&
           words_of(records_.size()) == words_of(records.size());
  if (keeps_) {
    has_same_receivers_ = moved->empty();
    lights_.put(*work.renderer.cl, "uploading lights that keep shadows",
                kept_lights(work, records, numbers, rays.origin(), *moved));
  }
  view_ = work.view;
  origin_ = rays.origin();
  records_ = records;
  numbers_ = std::move(numbers);
}

void KeptPairs::begin(PassContext& work, size_t images, size_t bytes) {
  is_found_ = false;
  ShadowMemory& shadows = work.shadows;
  const size_t together = shadows.tiles.bytes() + shadows.bits.bytes() + bytes;
  keeps_ = keeps_ && images_ == images && together <= work.plan.settings[setting::shadow_memory];
  images_ = images;
  if (keeps_) {
    std::swap(tiles_, shadows.tiles);
    std::swap(bits_, shadows.bits);
    return;
  }
  tiles_ = {};
  bits_ = {};
  has_numbers_shown_ = false;
}

void KeptPairs::compare(PassContext& work, const ClArguments& receivers, bool is_numbered) {
  if (!keeps_ || has_same_receivers_) return;
  ClDevice& device = *work.renderer.cl;
  const size_t width = size_t(work.grid().width), height = size_t(work.grid().height),
               across = (width + SHADOW_TILE - 1) / SHADOW_TILE,
               up = (height + SHADOW_TILE - 1) / SHADOW_TILE, tile_bytes = across * up * sizeof(uint32_t),
               pixel_bytes = width * height * sizeof(uint32_t);
  fill_buffer(device, "tiles that keep shadows", same_tiles_.at_least(device, tile_bytes), 1, tile_bytes);
  if (!compare_)
    compare_ =
        NamedKernel(*work.renderer.kernels, "shadows/same_receivers", is_numbered ? " -DNUMBERED" : "");
  compare_.launch(device, "same_receivers", cl::NDRange(across * SHADOW_TILE, up * SHADOW_TILE),
                  cl::NDRange(SHADOW_TILE, SHADOW_TILE),
                  receivers + ClArguments{{"view", work.cl_lights().view.buffer()},
                                          {"is_known", cl_uint(has_numbers_shown_)},
                                          {"numbers", numbers_shown_.at_least(device, pixel_bytes)},
                                          {"depth_bits", depths_shown_.at_least(device, pixel_bytes)},
                                          {"same_receivers", same_tiles_.get()}});
  has_numbers_shown_ = true;
}

ClArguments KeptPairs::arguments(ClDevice& device, size_t tiles, bool may_keep) {
  const bool keeps = keeps_ && may_keep;
  const cl::Buffer none;
  return {{"kept_tiles", keeps ? tiles_.buffer->cl_buffer() : none},
          {"kept_bits", keeps ? bits_.buffer->cl_buffer() : none},
          {"kept_lights", keeps ? lights_.buffer() : none},
          {"same_receivers", keeps && !has_same_receivers_ ? same_tiles_.get() : none},
          {"kept", outcome_.at_least(device, tiles * sizeof(uint32_t))}};
}

size_t KeptPairs::kept_tiles(ClDevice& device, size_t tiles, bool is_unchanged) const {
  std::vector<uint32_t> outcome(tiles);
  read_buffer(device, "counting kept tiles", outcome_.get(), outcome.data(), tiles * sizeof outcome[0]);
  return size_t(std::ranges::count_if(outcome, [&](uint32_t tile) {
    return is_unchanged ? tile != TILE_HAS_NO_PAIR : tile == TILE_IS_KEPT;
  }));
}

size_t KeptPairs::memory_bytes() const {
  return kept_bytes() + lights_.bytes() + numbers_shown_.bytes() + depths_shown_.bytes() +
         same_tiles_.bytes() + outcome_.bytes();
}

}  // namespace lightgrid
