// The oracle's answer whether each casting light is seen from each pixel: decided once, for the lists and
// shadows of many settings.
#pragma once

#include <functional>
#include <optional>
#include <span>

#include "oracle/occlusion.h"
#include "scene/host_shadows.h"
#include "scene/view_lights.h"

namespace lightgrid::lab {

// Surfaces that pixels show. Row 0 at the bottom; depth 0 for background.
struct ShownSurfaces {
  const View& view;
  const std::vector<float>& depth;
  const std::vector<CastingTriangle>& triangles;  // nearest opaque one of each pixel
};

// Lights in view space, and which of them cast: null, or the light in world space.
struct CastingLights {
  std::vector<ViewLight> in_view;
  std::vector<const Light*> casting;
};

class SeenPairs {
 public:
  // Takes `pixels` (y * width + x each, all covered), and of each the lights that cast and, with `in_range`,
  // are lit (lit_set.h). Occlusion decides on all cores: 1 to 2 million pairs a second and core in hall.
  // stops: called from several threads, once for each 16 x 16 tile; true leaves its pixels undecided.
  SeenPairs(const Occlusion& occlusion, const ShownSurfaces& shown, const CastingLights& lights,
            const std::vector<uint32_t>& pixels, bool in_range = true,
            const std::function<bool()>& stops = {});

  // Seen for a pair that was not decided, and either for a pixel without a triangle.
  Sight at(uint32_t pixel, uint32_t light) const;
  bool decided(uint32_t pixel) const { return of_pixel_[pixel].x != undecided; }
  bool has_either(uint32_t pixel) const;
  // For ShadeSettings. It outlives the result.
  std::function<bool(uint32_t pixel, uint32_t light)> hidden() const {
    return [this](uint32_t pixel, uint32_t light) { return at(pixel, light) == Sight::hidden; };
  }
  uint64_t pixels() const { return pixels_; }
  uint64_t pairs() const { return entries_.size(); }

 private:
  static constexpr uint32_t undecided = ~0u;
  std::span<const uint32_t> entries_of(uint32_t pixel) const;

  uint64_t pixels_ = 0;
  std::vector<glm::uvec2> of_pixel_;  // first entry, number of entries
  std::vector<uint32_t> entries_;     // light * 4 + Sight, ascending
};

// For a look at the shadows of one pixel. All outlive it.
struct PixelShadows {
  const Occlusion& occlusion;
  std::optional<Receiver> receiver;  // none: it shows no triangle
  const HostShadows* shaded;         // by the frame; null: it shades every light
};

}  // namespace lightgrid::lab
