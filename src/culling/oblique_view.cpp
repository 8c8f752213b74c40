#include "culling/oblique_view.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace lightgrid {
namespace {

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
  const double least_tilt =
      std::min(tilt_x * x.low, tilt_x * x.high) + std::min(tilt_y * y.low, tilt_y * y.high);
  const double most_tilt =
      std::max(tilt_x * x.low, tilt_x * x.high) + std::max(tilt_y * y.low, tilt_y * y.high);
  const double largest = b > 0 ? 1 + a - least_tilt : a - most_tilt;
  if (!(b / largest > 0)) {
    throw input_error(
        "view: clip_from_view's depth row [{} {} {} {}] gives no depth to surfaces in front of the eye",
        tilt_x, tilt_y, a, b);
  }
  StraightView s{.view = view};
  s.view.clip_from_view[0][2] = s.view.clip_from_view[1][2] = s.view.clip_from_view[2][2] = 0;
  s.view.clip_from_view[3][2] = b / largest;
  s.tilt_x = float(tilt_x), s.tilt_y = float(tilt_y), s.offset = float(a), s.scale = float(1 / largest);
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
