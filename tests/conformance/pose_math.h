// Vectors, quaternions (x, y, z, w), curves and matrices of the oracle of poses.
#pragma once

#include <array>
#include <cmath>
#include <vector>

namespace lightgrid {

using Numbers = std::vector<double>;
using Affine = std::array<double, 12>;  // three rows of four

inline Numbers cross_product(const Numbers& a, const Numbers& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

inline double norm(const Numbers& v) {
  double sum = 0;
  for (const double x : v) sum += x * x;
  return std::sqrt(sum);
}

inline Numbers to_unit(Numbers v) {
  const double length = norm(v);
  for (double& x : v) x /= length;
  return v;
}

inline Numbers quaternion_product(const Numbers& a, const Numbers& b) {
  const Numbers c = cross_product(a, b);
  Numbers out(4);
  for (int i = 0; i < 3; ++i) out[i] = a[3] * b[i] + b[3] * a[i] + c[i];
  out[3] = a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2];
  return out;
}

// The rotation between both keys as an axis and an angle, of which the part `t` is applied.
inline Numbers slerp(const Numbers& from_key, const Numbers& to_key, double t) {
  const Numbers from = to_unit(from_key), to = to_unit(to_key);
  Numbers delta = quaternion_product({-from[0], -from[1], -from[2], from[3]}, to);
  if (delta[3] < 0) {
    for (double& x : delta) x = -x;
  }
  const double sine = std::sqrt(delta[0] * delta[0] + delta[1] * delta[1] + delta[2] * delta[2]);
  if (sine == 0) return from;
  const double half_angle = std::atan2(sine, delta[3]) * t;
  const double scale = std::sin(half_angle) / sine;
  return quaternion_product(from,
                            {delta[0] * scale, delta[1] * scale, delta[2] * scale, std::cos(half_angle)});
}

// The Hermite curve as a Bezier curve, by de Casteljau.
inline double bezier(double p0, double tangent0, double p1, double tangent1, double seconds, double t) {
  double c[4] = {p0, p0 + tangent0 * seconds / 3, p1 - tangent1 * seconds / 3, p1};
  for (int level = 3; level > 0; --level) {
    for (int i = 0; i < level; ++i) c[i] += (c[i + 1] - c[i]) * t;
  }
  return c[0];
}

inline Affine product(const Affine& a, const Affine& b) {
  Affine out{};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      double sum = column == 3 ? a[row * 4 + 3] : 0;
      for (int k = 0; k < 3; ++k) sum += a[row * 4 + k] * b[k * 4 + column];
      out[row * 4 + column] = sum;
    }
  }
  return out;
}

inline Affine from_columns(const Numbers& m) {
  Affine out;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) out[row * 4 + column] = m[column * 4 + row];
  }
  return out;
}

// v + 2 q x (q x v + w v).
inline Numbers rotate(const Numbers& q, const Numbers& v) {
  Numbers inner = cross_product(q, v);
  for (int i = 0; i < 3; ++i) inner[i] += q[3] * v[i];
  const Numbers outer = cross_product(q, inner);
  return {v[0] + 2 * outer[0], v[1] + 2 * outer[1], v[2] + 2 * outer[2]};
}

inline Affine from_transform(const Numbers& translation, const Numbers& rotation, const Numbers& scale) {
  const Numbers q = to_unit(rotation);
  Affine out;
  for (int column = 0; column < 3; ++column) {
    Numbers axis(3, 0.0);
    axis[column] = scale[column];
    const Numbers turned = rotate(q, axis);
    for (int row = 0; row < 3; ++row) out[row * 4 + column] = turned[row];
  }
  for (int row = 0; row < 3; ++row) out[row * 4 + 3] = translation[row];
  return out;
}

inline Numbers row_of(const Affine& m, int row) { return {m[row * 4], m[row * 4 + 1], m[row * 4 + 2]}; }

}  // namespace lightgrid
