#include "scene/keyframes.h"

#include <algorithm>
#include <cmath>

namespace lightgrid {
namespace {

// Part of a key: glTF stores in-tangent, value and out-tangent for cubic splines.
enum class KeyPart { in_tangent, value, out_tangent };

std::vector<double> key_part(const AnimationChannel& channel, size_t index, KeyPart part = KeyPart::value) {
  const size_t parts_per_key = channel.interpolation == Interpolation::cubic_spline ? 3 : 1;
  const size_t offset = parts_per_key == 3 ? static_cast<size_t>(part) : 0;
  const auto first =
      channel.values.begin() + static_cast<long>((index * parts_per_key + offset) * channel.components);
  return {first, first + channel.components};
}

double length_of(const std::vector<double>& v) {
  double sum = 0;
  for (const double x : v) sum += x * x;
  return std::sqrt(sum);
}

// `absent` if the length is 0: the spline between two opposite quaternions passes through 0.
std::vector<double> normalized_or(std::vector<double> v, const std::vector<double>& absent) {
  const double length = length_of(v);
  if (!(length > 1e-12)) return absent;
  for (double& x : v) x /= length;
  return v;
}

std::vector<double> weighted_sum(double a, const std::vector<double>& x, double b,
                                 const std::vector<double>& y) {
  std::vector<double> sum(x.size());
  for (size_t i = 0; i < sum.size(); ++i) sum[i] = a * x[i] + b * y[i];
  return sum;
}

// Appendix C.4.
std::vector<double> spherical(const std::vector<double>& from, const std::vector<double>& to, double t) {
  double dot = 0;
  for (size_t i = 0; i < from.size(); ++i) dot += from[i] * to[i];
  const double sign = dot < 0 ? -1 : 1;
  const double angle = std::acos(std::min(std::abs(dot), 1.0));
  const double sine = std::sin(angle);
  // Below this angle the chord differs from the arc by less than 1e-12.
  const bool is_small = sine < 1e-6;
  const double a = is_small ? 1 - t : std::sin(angle * (1 - t)) / sine;
  const double b = is_small ? t : std::sin(angle * t) / sine;
  return normalized_or(weighted_sum(a, from, sign * b, to), from);
}

// Appendix C.5. Tangents are per second, so they are scaled by the time between the keys.
std::vector<double> cubic(const AnimationChannel& channel, size_t index, double t, double seconds_between) {
  const double t2 = t * t, t3 = t2 * t;
  const std::vector<double> from =
      weighted_sum(2 * t3 - 3 * t2 + 1, key_part(channel, index), seconds_between * (t3 - 2 * t2 + t),
                   key_part(channel, index, KeyPart::out_tangent));
  const std::vector<double> to =
      weighted_sum(3 * t2 - 2 * t3, key_part(channel, index + 1), seconds_between * (t3 - t2),
                   key_part(channel, index + 1, KeyPart::in_tangent));
  return weighted_sum(1, from, 1, to);
}

std::vector<double> key_value(const AnimationChannel& channel, size_t index) {
  std::vector<double> value = key_part(channel, index);
  return channel.path == AnimatedPath::rotation ? normalized_or(value, value) : value;
}

}  // namespace

std::vector<double> sample_channel(const AnimationChannel& channel, double seconds) {
  const std::vector<float>& times = channel.times;
  const auto next = std::upper_bound(times.begin(), times.end(), seconds);
  if (next == times.begin()) return key_value(channel, 0);
  const auto index = static_cast<size_t>(next - times.begin()) - 1;
  const std::vector<double> from = key_value(channel, index);
  if (next == times.end() || channel.interpolation == Interpolation::step) return from;

  const double start = times[index], seconds_between = times[index + 1] - start;
  const double t = (seconds - start) / seconds_between;
  const bool is_rotation = channel.path == AnimatedPath::rotation;
  if (channel.interpolation == Interpolation::cubic_spline) {
    const std::vector<double> value = cubic(channel, index, t, seconds_between);
    return is_rotation ? normalized_or(value, from) : value;
  }
  const std::vector<double> to = key_value(channel, index + 1);
  return is_rotation ? spherical(from, to, t) : weighted_sum(1 - t, from, t, to);
}

}  // namespace lightgrid
