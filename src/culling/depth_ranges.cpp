#include "culling/depth_ranges.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "culling/light_arrays.h"
#include "shared/cull_constants.h"

namespace lightgrid {
namespace {

constexpr float widen = WIDEN;

float rounded_down(double value) {
  return std::nextafter(float(value), -std::numeric_limits<float>::infinity());
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

}  // namespace lightgrid
