// The settings that the hunt (hunt.h) draws from. A bounded set, so that kernel builds are rare.
#pragma once

#include <cmath>
#include <string>

#include "scene/random.h"
#include "verify/engine.h"

namespace lightgrid::verify {

struct HuntSetting {
  CullerOptions options;  // the view sets depth_format and blend
  int slices = 1;
  SliceSpacing spacing = SliceSpacing::exponential;
  int z_bins = 1;
  bool spots = false;        // half of the lights have a cone
  bool both_shapes = false;  // the other kernel shape must make the same bytes
};

// `few`: only kernel variants that the catalogue's cases use as well, for runs of seconds.
HuntSetting random_setting(Random& random, bool few);

// Changes settings that need no other kernels: number and spacing of slices and z-bins, pixels' centres or
// whole pixels.
void vary(HuntSetting& setting, Random& random);

std::string to_string(const HuntSetting& setting);

// [0, 1), in steps of 2^-53.
inline double unit(Random& random) { return double(random.next() >> 11) * 0x1p-53; }
inline double between(Random& random, double low, double high) { return low + (high - low) * unit(random); }
inline double log_between(Random& random, double low, double high) {
  return low * std::exp2(unit(random) * std::log2(high / low));
}
inline bool chance(Random& random, double probability) { return unit(random) < probability; }

template <typename T, size_t count>
T one_of(Random& random, const T (&values)[count]) {
  return values[random.next() % count];
}

}  // namespace lightgrid::verify
