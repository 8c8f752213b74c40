// Depth bounds in double with, optionally, one fault of naive code (hard_cases/naive_culler.h).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "culling/cull_view.h"
#include "hard_cases/faults.h"
#include "verify/views.h"

namespace lightgrid::lab::verify {

struct DepthInterval64 {
  double near, far;
};

// A tile's surfaces, in 32 parts of its interval.
struct NaiveMask {
  double near = no_end, far = -no_end;
  uint32_t bits = 0;
  double bin(double distance) const { return (distance - near) / (far - near) * 32; }
};

class NaiveDepth {
 public:
  explicit NaiveDepth(Fault fault) : fault_(fault) {}

  DepthInterval scan(const CullerOptions& o, const CullView& view, const DepthImage& depth, size_t tile,
                     bool blend) const {
    double near = no_end, far = -no_end, farthest = 0;
    bool invalid = false, sky = false;
    int32_t least = std::numeric_limits<int32_t>::max();
    for_each_value(o, view, depth, tile, [&](float value) {
      int32_t bits;
      std::memcpy(&bits, &value, 4);
      if (!(value >= 0 && value <= 1)) {
        invalid |= fault_ != Fault::invalid_depth_ignored;
        if (fault_ == Fault::signed_minimum) least = std::min(least, bits);
      } else if (value == depth_of_nothing(view)) {
        sky = true;
        if (fault_ == Fault::signed_minimum && std::signbit(value)) least = std::min(least, bits);
      } else {
        widen(o, view, value, near, far);
        farthest = std::max(farthest, distance_at(view, value));
        least = std::min(least, bits);
      }
    });
    if (fault_ == Fault::signed_minimum && least < 0) return {down(near), down(near)};
    if (invalid || farthest > 1e15) return {is_orthographic(view) ? -1e18f : 0.0f, 1e18f};
    if (sky && fault_ == Fault::sky_in_maximum) {
      far = 1e18;
      near = std::min(near, 1e18);
    }
    if (blend) return {0, sky || near > far ? 1e18f : up(std::min(far, 1e18))};
    if (near > far) return {1e18f, -1e18f};
    if (fault_ == Fault::standard_depth_as_reversed && has_standard_depth(view)) std::swap(near, far);
    return {down(near), up(std::min(far, 1e18))};
  }

  // By half a step of the format, the largest change by rounding to it; for D32F too, because the surface's
  // own depth was rounded.
  void widen(const CullerOptions& o, const CullView& view, float value, double& near, double& far) const {
    double step = 0.5 * (std::nextafter(value, 2.0f) - value);
    if (o.depth_format == DepthFormat::d16) step = 0.5 / 65535;
    if (o.depth_format == DepthFormat::d24) step = 0.5 / 16777215 + 0x1p-25;
    if (fault_ == Fault::format_ignored) step = 0;
    for (const double v : {value - step, value + step}) {
      double d = distance_at(view, v);
      if (!is_orthographic(view) && !(d > 0)) d = 1e18;
      near = std::min(near, d);
      far = std::max(far, d);
    }
  }

  NaiveMask mask_of(const CullerOptions& o, const CullView& view, const DepthImage& depth,
                    size_t tile) const {
    NaiveMask mask;
    std::vector<double> distances;
    for_each_value(o, view, depth, tile, [&](float value) {
      if (!(value >= 0 && value <= 1) || value == depth_of_nothing(view)) return;
      const glm::dmat4& clip = view.clip_from_view;
      const bool in_float = fault_ == Fault::mask_in_float && is_orthographic(view);
      const float a = float(1 / clip[2][2]), b = float(clip[3][2] / clip[2][2]);
      distances.push_back(in_float ? double(b - value * a) : distance_at(view, value));
      if (fault_ == Fault::mask_of_stored_depth) widen(o, view, value, mask.near, mask.far);
      mask.near = std::min(mask.near, distances.back());
      mask.far = std::max(mask.far, distances.back());
    });
    for (const double d : distances) {
      const double bin = fault_ == Fault::mask_bin_32 ? mask.bin(d) : std::min(mask.bin(d), 31.0);
      if (bin >= 0 && bin < 32) mask.bits |= 1u << int(bin);
    }
    return mask;
  }

 private:
  static float down(double x) { return std::nextafter(float(x), -1e30f); }
  static float up(double x) { return std::nextafter(float(x), 1e30f); }

  template <typename Body>
  void for_each_value(const CullerOptions& o, const CullView& view, const DepthImage& depth, size_t tile,
                      const Body& body) const {
    const int x0 = int(tile % tiles_x(view, o.tile)) * o.tile,
              y0 = int(tile / tiles_x(view, o.tile)) * o.tile;
    const int x1 = std::min(x0 + o.tile, view.width), y1 = std::min(y0 + o.tile, view.height);
    const int row = depth.row_pixels ? depth.row_pixels : view.width;
    const bool whole = fault_ == Fault::viewport_ignored;
    if (fault_ == Fault::partial_tiles_dropped && (x1 - x0 < o.tile || y1 - y0 < o.tile)) return;
    for (int y = y0; y < y1; ++y) {
      for (int x = x0; x < x1; ++x) {
        if (fault_ == Fault::last_pixel_forgotten && x == x0 + o.tile - 1 && y == y0 + o.tile - 1) continue;
        for (int s = 0; s < (fault_ == Fault::first_sample_only ? 1 : depth.samples); ++s)
          body(depth.values[((size_t(y) + (whole ? 0 : depth.y)) * row + x + (whole ? 0 : depth.x)) *
                                depth.samples +
                            s]);
      }
    }
  }

  Fault fault_;
};

}  // namespace lightgrid::lab::verify
