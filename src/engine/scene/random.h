// SplitMix64 (Steele, Lea, Flood: Fast Splittable Pseudorandom Number Generators, OOPSLA 2014): the same
// numbers on every machine, which the standard library's distributions do not guarantee.
#pragma once

#include <cmath>
#include <cstdint>

#include <glm/glm.hpp>

namespace lightgrid {

class Random {
 public:
  explicit Random(uint64_t seed) : state_(seed) {}

  uint64_t next() { return mix(state_ += 0x9e3779b97f4a7c15); }

  // A bijection of 64 bits: also a hash of an integer.
  static uint64_t mix(uint64_t x) {
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9;
    x = (x ^ (x >> 27)) * 0x94d049bb133111eb;
    return x ^ (x >> 31);
  }

  // [0, 1) in steps of 2^-24: exact in float.
  float uniform() { return float(next() >> 40) * 0x1p-24f; }
  float uniform(float low, float high) { return low + (high - low) * uniform(); }

 private:
  uint64_t state_;
};

// Uniform over the unit sphere.
inline glm::dvec3 any_direction(Random& random) {
  for (;;) {
    const glm::dvec3 v(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    const double length2 = glm::dot(v, v);
    if (length2 > 1e-4 && length2 <= 1) return v / std::sqrt(length2);
  }
}

}  // namespace lightgrid
