#include "passes/shadows/certificates.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

#include "cl/transfer.h"
#include "shared/shadow_certificates.h"

namespace lightgrid {

static const OwnSetting<size_t> shadow_kept{
    "shadow-kept",
    "portable",
    "memory for what is kept of shadows while nothing moves, which then need fewer rays; of CPUs only",
    {{"off", 0},
     {"1M", 1 << 20},
     {"4M", 4 << 20},
     {"16M", 16 << 20},
     {"64M", 64 << 20},
     {"256M", 256 << 20}}};

namespace {

constexpr uint32_t frames_a_step = 4;  // of the time by which slots age

// Most metres between what pixels of the view show of the box and the box itself, since rasterisers move
// corners by a part of a pixel.
double snapping(const View& view, const WorldBox& box) {
  const double pixel =
      2 / std::min(view.clip_from_view[0][0] * view.width, view.clip_from_view[1][1] * view.height);
  if (view.orthographic) return pixel;
  return pixel * glm::length(glm::max(glm::abs(box.min - view.eye), glm::abs(box.max - view.eye)));
}

// Whether what is kept of the light may depend on what the box holds. The polygons of pieces are within
// CERTIFICATE_FARTHEST times the range, and so is all between them and the light. Pixels that the light may
// shade are within the range and as near to what they show as snapping() says. slack: rounding of positions.
bool may_reach(const CullLight& light, const WorldBox& box, const glm::dvec3& origin, const View& view) {
  if (box.empty()) return false;
  const double farthest = glm::length(glm::max(glm::abs(box.min - origin), glm::abs(box.max - origin)));
  const double slack =
      1e-5 * (farthest + glm::length(light.position - origin) + glm::length(light.position - view.eye)) +
      snapping(view, box);
  const glm::dvec3 nearest = glm::clamp(light.position, box.min, box.max);
  return !(glm::length(light.position - nearest) >
           1.001 * double(CERTIFICATE_FARTHEST) * light.radius_m + slack);
}

// Its contents are zeros where it is replaced.
cl::Buffer& zeros_at_least(ClDevice& device, GrowingBuffer& buffer, size_t bytes) {
  const cl_mem before = buffer.get()();
  cl::Buffer& now = buffer.at_least(device, bytes);
  if (now() != before) fill_buffer(device, "clearing kept tiles", now, 0, lightgrid::bytes_of(now));
  return now;
}

}  // namespace

bool ShadowSight::operator==(const ShadowSight& other) const {
  return std::memcmp(&view, &other.view, sizeof view) == 0 &&
         std::memcmp(&params, &other.params, sizeof params) == 0 && layers == other.layers &&
         number_offsets == other.number_offsets &&
         defines == other.defines;
}

size_t ShadowCertificates::bytes_of(const Settings& settings) { return shadow_kept.of(settings); }

ShadowCertificates::ShadowCertificates(ClDevice& device, size_t bytes)
    : table_(device_buffer(device, bytes)) {
  fill_buffer(device, "clearing certificates", table_, 0, bytes);
}

// A light that moved, or whose range or cone changed, has none of its certificates any more. Nor has one with
// an instance in its reach, before or after it moved or its mesh deformed, as a caster or as a receiver.
void ShadowCertificates::follow(Work& work, const RayScene& rays, const std::vector<CullLight>& all_lights,
                                ShadowSight sight) {
  if (sight_stamp_ == 0 || !(sight == sight_)) ++sight_stamp_, sight_ = std::move(sight);
  const auto moved = moved_.since_last(work, rays);
  bool all = !moved;
  if (last_stamp_ > 0xffffffffu - all_lights.size() - 1) {
    fill_buffer(*work.renderer.cl, "clearing certificates", table_, 0, lightgrid::bytes_of(table_));
    last_stamp_ = 0, all = true, ++sight_stamp_;
  }
  const size_t known = std::min(lights_.size(), all_lights.size());
  stamps_.resize(all_lights.size());
  for (size_t i = 0; i < all_lights.size(); ++i) {
    const auto reaches = [&](const WorldBox& box) {
      return may_reach(all_lights[i], box, rays.origin(), work.view);
    };
    if (all || i >= known || lights_[i] != all_lights[i] || std::ranges::any_of(*moved, reaches)) renew(i);
  }
  lights_ = all_lights;
}

ClArguments ShadowCertificates::arguments(ClDevice& device, size_t tiles, size_t pairs) {
  tile_count_ = tiles;
  const auto sets = cl_uint(lightgrid::bytes_of(table_) / (CERTIFICATE_SET * sizeof(PieceCertificates)));
  const uint32_t frame = frames_++;
  return {{"certificates", table_},
          {"certificate_sets", sets},
          {"certificate_time", cl_uint(1 + frame / frames_a_step)},
          {"decided", decided_.at_least(device, tiles * sizeof(uint32_t))},
          {"kept_tiles", zeros_at_least(device, tiles_, tiles * sizeof(KeptTile))},
          {"kept_surfaces", surfaces_.at_least(device, tiles * KEPT_SURFACE_WORDS * sizeof(uint32_t))},
          {"last_shadows", bits_[(frame + 1) % 2].at_least(device, sizeof(KeptShadow))},
          {"next_shadows", bits_[frame % 2].at_least(device, pairs * sizeof(KeptShadow))}};
}

size_t ShadowCertificates::decided(ClDevice& device) const {
  std::vector<uint32_t> counts(tile_count_);
  read_buffer(device, "counting decided pairs", decided_.get(), counts.data(),
              counts.size() * sizeof counts[0]);
  return std::accumulate(counts.begin(), counts.end(), size_t(0));
}

size_t ShadowCertificates::memory_bytes() const {
  return lightgrid::bytes_of(table_) + decided_.bytes() + tiles_.bytes() + surfaces_.bytes() +
         bits_[0].bytes() + bits_[1].bytes();
}

}  // namespace lightgrid
