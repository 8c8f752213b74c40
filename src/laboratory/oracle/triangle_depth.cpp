#include "oracle/triangle_depth.h"

#include <algorithm>
#include <cmath>

namespace lightgrid::lab {
namespace {

using Real = long double;
using Vector = std::array<Real, 3>;  // x, y and w in clip space

constexpr Real float_error = 0x1p-24L;  // the relative error of a rounded float

Vector vector_of(const glm::vec4& v) { return {v.x, v.y, v.w}; }
Vector difference(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// A float vector product, whose members err by 2 roundings, and how far from the exact one it may be. Given
// are rounded and exact factors.
struct Product {
  Vector value{}, bound{};
};

Product product_of(const Vector& a, const Vector& b, const Vector& rounded_a, const Vector& rounded_b) {
  const Vector exact = cross(a, b), of_rounded = cross(rounded_a, rounded_b);
  Product p{exact, {}};
  for (int i = 0; i < 3; ++i)
    p.bound[i] = std::abs(of_rounded[i] - exact[i]) + 2 * float_error * std::abs(of_rounded[i]);
  return p;
}

Vector in_float(const Vector& v) { return {float(v[0]), float(v[1]), float(v[2])}; }

Real size_of(const Vector& v) { return std::abs(v[0]) + std::abs(v[1]) + std::abs(v[2]); }

// The depth of the part in front of the near plane. Deeper corners than -2^64 count as that deep.
Real depth_in_view(const glm::vec4& v) {
  return v.w > 0 ? std::clamp(Real(v.z) / v.w, -0x1p64L, 1.0L) : 1.0L;
}

// The eye's distance from the plane of the corners v, times their normal n, and how far from it a float sum
// from the corner of the least size may be.
struct Distance {
  Real value = 0, bound = 0;
};

Distance distance_from_eye(const std::array<Vector, 3>& v, const Product& n) {
  const Real least = std::min({size_of(v[0]), size_of(v[1]), size_of(v[2])});
  Distance d;
  for (const Vector& corner : v) {
    if (size_of(corner) > least * (1 + 8 * float_error)) continue;
    Real bound = 0;
    d.value = 0;
    for (int i = 0; i < 3; ++i) {
      d.value += n.value[i] * corner[i];
      bound += (n.bound[i] + 3 * float_error * std::abs(n.value[i])) * std::abs(corner[i]);
    }
    d.bound = std::max(d.bound, bound);
  }
  d.value = std::abs(d.value);
  return d;
}

}  // namespace

TriangleDepth::TriangleDepth(const std::array<glm::vec4, 3>& clip, const std::array<glm::vec4, 3>& part,
                             const std::array<SnappedPoint, 3>& snapped, const PixelGrid& grid) {
  const auto [least, greatest] =
      std::minmax({depth_in_view(clip[0]), depth_in_view(clip[1]), depth_in_view(clip[2])});
  least_ = least;
  greatest_ = greatest;
  find_box(snapped, grid);
  find_snapped(part, snapped);
  find_exact(clip, grid);
}

void TriangleDepth::find_box(const std::array<SnappedPoint, 3>& p, const PixelGrid& grid) {
  const auto [left, right] = std::minmax({p[0].x, p[1].x, p[2].x});
  const auto [bottom, top] = std::minmax({p[0].y, p[1].y, p[2].y});
  const auto first = [](int64_t units) { return int(std::max<int64_t>((units + 127) >> 8, 0)); };
  const auto last = [](int64_t units, int size) {
    return int(std::min<int64_t>((units - 128) >> 8, size - 1));
  };
  box_low_ = {first(left), first(bottom)};
  box_high_ = {last(right, grid.width), last(top, grid.height)};
}

void TriangleDepth::find_snapped(const std::array<glm::vec4, 3>& part, const std::array<SnappedPoint, 3>& p) {
  Real z[3];
  for (int i = 0; i < 3; ++i) z[i] = depth_in_view(part[i]);
  const Real ax = Real(p[1].x - p[0].x) / 256, ay = Real(p[1].y - p[0].y) / 256,
             bx = Real(p[2].x - p[0].x) / 256, by = Real(p[2].y - p[0].y) / 256, area = ax * by - bx * ay;
  Plane& plane = snapped_;
  plane.at_x = Real(p[0].x) / 256;
  plane.at_y = Real(p[0].y) / 256;
  plane.depth = z[0];
  plane.right = ((z[1] - z[0]) * by - (z[2] - z[0]) * ay) / area;
  plane.up = ((z[2] - z[0]) * ax - (z[1] - z[0]) * bx) / area;
  // A difference of products, the area, a quotient and a product.
  plane.right_bound = 6 * float_error * std::abs(plane.right);
  plane.up_bound = 6 * float_error * std::abs(plane.up);
  plane.size = std::max({std::abs(z[0]), std::abs(z[1]), std::abs(z[2])});
}

// docs/raster.md derives these bounds.
void TriangleDepth::find_exact(const std::array<glm::vec4, 3>& clip, const PixelGrid& grid) {
  const std::array<Vector, 3> v = {vector_of(clip[0]), vector_of(clip[1]), vector_of(clip[2])};
  const Vector a = difference(v[1], v[0]), b = difference(v[2], v[0]);
  const Vector float_a = in_float(a), float_b = in_float(b);
  const Product n = product_of(a, b, float_a, float_b);
  const auto [distance, distance_bound] = distance_from_eye(v, n);
  const Real min_distance = distance - distance_bound, size = size_of(v[0]) + size_of(v[1]) + size_of(v[2]);
  if (size > 0x1p61L || distance + distance_bound < 0x1p-91L || min_distance > 0x1p91L) return;
  shown_ = Shown::either;
  if (!(min_distance > 0)) {
    exact_.right_bound = exact_.up_bound = INFINITY;
    return;
  }
  const Real turn = n.value[0] * v[0][0] + n.value[1] * v[0][1] + n.value[2] * v[0][2];  // with its sign
  const Product b_from = product_of(b, v[0], float_b, v[0]), to_a = product_of(v[0], a, v[0], float_a);
  const Real z0 = clip[0].z, za = clip[1].z - z0, zb = clip[2].z - z0, float_za = float(za),
             float_zb = float(zb);
  Real gradient[2], bound[2];
  for (int i = 0; i < 2; ++i) {
    const Real pixels = Real(i == 0 ? grid.width : grid.height) / 2;
    const Real more = za * b_from.value[i] + zb * to_a.value[i], sum = z0 * n.value[i] + more;
    const Real more_bound = std::abs(float_za) * b_from.bound[i] + std::abs(float_zb) * to_a.bound[i] +
                            std::abs((float_za - za) * b_from.value[i]) +
                            std::abs((float_zb - zb) * to_a.value[i]) + 2 * float_error * std::abs(more);
    const Real sum_bound = std::abs(z0) * n.bound[i] + more_bound +
                           4 * float_error * (std::abs(z0 * n.value[i]) + std::abs(more));
    gradient[i] = sum / turn / pixels;
    bound[i] = (sum_bound + std::abs(sum) * distance_bound / distance) / min_distance / pixels +
               2 * float_error * std::abs(gradient[i]);
  }
  int from = 0;
  for (int i = 1; i < 3; ++i) {
    if (std::abs(depth_in_view(clip[i])) < std::abs(depth_in_view(clip[from]))) from = i;
  }
  const glm::vec4& c = clip[from];
  Plane& plane = exact_;
  plane.at_x = (Real(c.x) / c.w + 1) * grid.width / 2;
  plane.at_y = (Real(c.y) / c.w + 1) * grid.height / 2;
  plane.depth = Real(c.z) / c.w;
  plane.size = std::abs(plane.depth);
  plane.right = gradient[0];
  plane.up = gradient[1];
  plane.right_bound = bound[0];
  plane.up_bound = bound[1];
  const Real steep = std::abs(gradient[0]) + std::abs(gradient[1]), steep_bound = bound[0] + bound[1];
  const Real range = 512 * (greatest_ - least_),
             range_bound = 2048 * float_error * std::max(std::abs(greatest_), std::abs(least_)) +
                           2 * float_error * steep;
  const bool in_reach = size < 0x1p59L && min_distance > 0x1p-89L && distance + distance_bound < 0x1p89L;
  if (in_reach && steep + steep_bound < range - range_bound) shown_ = Shown::exact;
  if (steep - steep_bound > range + range_bound) shown_ = Shown::snapped;
}

DepthAt TriangleDepth::in_plane(const Plane& plane, const SnappedPoint& sample) const {
  const Real x = Real(sample.x) / 256, y = Real(sample.y) / 256;
  Real bound = 8 * float_error * plane.size;
  const auto add_axis = [&](Real gradient, Real of_gradient, Real at, Real here, int low, int high) {
    // By way of the anchor, a pixel's centre, on the side to which depth falls. Samples that lie off centres
    // may move it by a pixel.
    const auto way = [&](int anchor) {
      return std::abs(anchor + 0.5L - at) + std::abs(here - anchor - 0.5L) + 1;
    };
    const Real length = gradient > of_gradient    ? way(low)
                        : gradient < -of_gradient ? way(high)
                                                  : std::max(way(low), way(high));
    bound += (of_gradient + 8 * float_error * std::abs(gradient)) * length;
  };
  add_axis(plane.right, plane.right_bound, plane.at_x, x, box_low_.x, box_high_.x);
  add_axis(plane.up, plane.up_bound, plane.at_y, y, box_low_.y, box_high_.y);
  const Real depth = plane.depth + plane.right * (x - plane.at_x) + plane.up * (y - plane.at_y);
  // Depths are held to those of the corners.
  const Real of_clamp = 4 * float_error * std::max(std::abs(greatest_), std::abs(least_));
  Real low = least_, high = greatest_;
  if (std::isfinite(depth) && std::isfinite(bound)) {
    const Real held = std::clamp(depth, least_, greatest_);
    low = std::max(held - bound, least_);
    high = std::min(held + bound, greatest_);
  }
  return {double((low + high) / 2), double((high - low) / 2 + of_clamp)};
}

DepthAt TriangleDepth::at(const SnappedPoint& sample) const {
  if (shown_ == Shown::exact) return in_plane(exact_, sample);
  const DepthAt snapped = in_plane(snapped_, sample);
  if (shown_ == Shown::snapped) return snapped;
  const DepthAt exact = in_plane(exact_, sample);
  const double low = std::min(exact.depth - exact.bound, snapped.depth - snapped.bound),
               high = std::max(exact.depth + exact.bound, snapped.depth + snapped.bound);
  return {(low + high) / 2, (high - low) / 2};
}

}  // namespace lightgrid::lab
