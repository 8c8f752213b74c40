#include "culling/view_depth.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "culling/light_arrays.h"
#include "shared/cull_constants.h"

namespace lightgrid {
namespace {

constexpr float widen = WIDEN;

float rounded_down(double value) {
  return std::nextafter(float(value), -std::numeric_limits<float>::infinity());
}

struct Slopes {
  double low, high;
  double largest() const { return std::max(std::abs(low), std::abs(high)); }
};

// The slopes of the image's two sides: NDC = clip[axis][axis] * slope - clip[2][axis].
Slopes slopes_of(const CullView& view, int axis) {
  const double scale = view.clip_from_view[axis][axis], offset = view.clip_from_view[2][axis];
  return {(-1 + offset) / scale, (1 + offset) / scale};
}

}  // namespace

float rounded_up(double value) {
  return std::nextafter(float(value), std::numeric_limits<float>::infinity());
}

TwoFloats two_floats(double number) {
  const float value = float(number);
  return {value, float(number - double(value))};
}

float depth_step(DepthFormat format, bool standard_depth) {
  if (format == DepthFormat::d16) return 1.0f / 65535;
  if (format == DepthFormat::d24) return 1.0f / 16777215;
  return standard_depth ? float(half_ulp) : 0.0f;
}

std::vector<cl_float2> ranges_between(const CullView& view, const std::vector<float>& edges,
                                      std::span<const float> keys, const CullParams& p) {
  const double margin = p.orthographic ? widen * std::abs(double(p.depth_b) * p.depth_a) : 0.0;
  const double step = p.depth_step;
  std::vector<cl_float2> ranges;
  float near = p.orthographic ? -far_away : 0.0f;
  for (size_t i = 0; i < edges.size(); ++i) {
    const double limit = 2.0 * far_away;
    const double nearest = std::min(distance_of_key(view, keys[i] - step), limit);
    const double farthest = std::min(distance_of_key(view, keys[i] + step), limit);
    const double far = farthest + widen * std::abs(farthest) + margin;
    ranges.push_back({{near, far < far_away ? rounded_up(far) : far_away}});
    near = rounded_down(std::min(nearest - widen * std::abs(nearest) - margin, double(far_away)));
  }
  ranges.push_back({{near, far_away}});
  return ranges;
}

bool is_oblique(const CullView& view) {
  return !is_orthographic(view) && (view.clip_from_view[0][2] != 0 || view.clip_from_view[1][2] != 0);
}

// A surface at distance D has depth = tilt + b / D - a with tilt = tilt_x x + tilt_y y, a = clip[2][2], b =
// clip[3][2]. So u = depth + a - tilt = b / D. Dividing u by its largest value in the image gives the
// reversed depth of a view whose near plane is at the least distance.
StraightView straightened(const CullView& view, DepthFormat format, int samples) {
  const glm::dmat4& clip = view.clip_from_view;
  const double tilt_x = clip[0][2], tilt_y = clip[1][2], a = clip[2][2], b = clip[3][2];
  const Slopes x = slopes_of(view, 0), y = slopes_of(view, 1);
  const double min_tilt =
      std::min(tilt_x * x.low, tilt_x * x.high) + std::min(tilt_y * y.low, tilt_y * y.high);
  const double max_tilt =
      std::max(tilt_x * x.low, tilt_x * x.high) + std::max(tilt_y * y.low, tilt_y * y.high);
  const double largest = b > 0 ? 1 + a - min_tilt : a - max_tilt;
  if (!(b / largest > 0)) {
    throw input_error(
        "view: clip_from_view's depth row [{} {} {} {}] gives no depth to surfaces in front of the eye",
        tilt_x, tilt_y, a, b);
  }
  StraightView s{.view = view};
  s.view.clip_from_view[0][2] = s.view.clip_from_view[1][2] = s.view.clip_from_view[2][2] = 0;
  s.view.clip_from_view[3][2] = b / largest;
  s.tilt_x = float(tilt_x);
  s.tilt_y = float(tilt_y);
  s.offset = float(a);
  s.scale = float(1 / largest);
  s.nothing = b > 0 ? 0.0f : 1.0f;
  // Each coefficient, product and sum rounds once; a slope p * scale + offset by 3u (|slope| + |offset|).
  const double rounding = 8 * 0x1p-24 *
                          (1 + std::abs(a) + std::abs(tilt_x) * (x.largest() + std::abs(x.low)) +
                           std::abs(tilt_y) * (y.largest() + std::abs(y.low)));
  const double half_pixel =
      std::abs(tilt_x) / (clip[0][0] * view.width) + std::abs(tilt_y) / (clip[1][1] * view.height);
  const double stored = format == DepthFormat::d16   ? 1.0 / 65535
                        : format == DepthFormat::d24 ? 1.0 / 16777215
                                                     : 0;
  s.depth_step = float((rounding + stored + (samples > 1 ? half_pixel : 0)) / std::abs(largest));
  return s;
}

}  // namespace lightgrid
