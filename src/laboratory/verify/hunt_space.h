// The space that the hunt (hunt.h) draws from: random settings; random views of every class that
// docs/hard_cases.md covers, with surfaces; lights that barely reach one pixel's own position.
#pragma once

#include <cmath>
#include <optional>
#include <string>

#include "scene/random.h"
#include "scene/scene.h"
#include "verify/views.h"

namespace lightgrid::lab::verify {

// A bounded set, so that kernel builds are rare.
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

// The domain (docs/hard_cases.md#the-domain): distances of surfaces, and edges of slices and z-bins, metres.
constexpr double max_hunt_m = 1e15, max_hunt_edge_m = 1e13;

enum class HuntClass {
  ordinary,      // 5 to 150 degrees, reversed depth with infinite far
  narrow,        // 1 to 5 degrees
  narrowest,     // 0.1 to 1 degree
  wide,          // 150 to 179.9 degrees
  off_centre,    // slopes up to 100
  turned_far,    // turned, the eye up to 1e15 m from the origin
  orthographic,  // 0.1 mm to 100 km across, also behind the eye
  standard,      // standard depth, with a far plane and without
  finite_far,    // reversed depth with a far plane
  d16,
  d24,      // both depth orders, perspective and orthographic
  oblique,  // a near plane that is not parallel to the image, both depth orders
  blended,  // surfaces between the near plane and the opaque ones, in every kind of depth
  scaled,   // the whole scene scaled by 1e-12 to 1e15
  spread,   // most lights are 1e3 to 1e15 m from the surfaces
  parked,   // one, half or most of the lights at 1e19 m, 1e30 m or FLT_MAX
  mixed,    // any combination of the above
};
constexpr int hunt_class_count = int(HuntClass::mixed) + 1;
const char* name_of(HuntClass hunted);

struct HuntView {
  HuntClass hunted = HuntClass::ordinary;
  CullView view;  // slice and z-bin edges included
  DepthFormat format = DepthFormat::d32f;
  bool blended = false;      // lights reach blended surfaces, which are not in `depth`
  double near = 0, far = 0;  // metres along the view axis: surfaces lie between the two
  // A fraction of the lights lies elsewhere, at this distance from the eye, metres; 0: none.
  double elsewhere = 0, elsewhere_m = 0, elsewhere_radius_m = 0;
  DepthImage depth;
};

// The same for equal arguments.
HuntView random_view(HuntClass hunted, const HuntSetting& setting, uint64_t seed);

// Blocks of pixels that are flat, in two layers, rough or empty; some lie on the edges of slices and z-bins
// or one float step beside.
DepthImage random_surfaces(const HuntView& view, int samples, Random& random);

// Metres along the view axis of depth at a point of the image, pixels. Infinite, negative or NaN if no
// surface can have this depth there.
double distance_of(const HuntView& view, double depth, double px, double py);

// The depth of a blended surface at a point of the image where the depth buffer has `opaque`: between the
// near plane and the opaque surface, both included. Such depth is not stored, so it is not rounded to the
// format.
float random_blended_depth(const HuntView& view, float opaque, double px, double py, Random& random);

// The point that a light is made to reach: a pixel's position from its depth, in double.
struct HuntContact {
  uint32_t light = 0;  // index into HuntLights::lights
  uint16_t x = 0, y = 0, sample = 0;
  float in_x = 0.5f, in_y = 0.5f;  // position in the pixel: its centre, if only centres are shaded
  float depth = 0;                 // as the depth buffer stores it, or of the blended surface before it
};

struct HuntLights {
  std::vector<Light> lights;  // as a lights file can store them: radius, direction and cone are floats
  std::vector<HuntContact> contacts;  // contacts that are certainly lit
};

// `count` lights; the view may place some elsewhere. Depends on the seed alone, not on the number of threads.
HuntLights random_contacts(const HuntView& view, const HuntSetting& setting, size_t count, uint64_t seed);

// As input of the library.
std::vector<CullLight> cull_lights(std::span<const Light> lights);

// View space, in double. Empty without a surface. Where the near plane is oblique, the depth of a pixel's
// only sample is that of its centre.
std::optional<glm::dvec3> position_of(const HuntView& view, const HuntContact& contact);

// According to the oracle: strictly nearer than the radius, and strictly within the cone.
bool is_lit_there(const HuntView& view, const Light& light, const glm::dvec3& position);

}  // namespace lightgrid::lab::verify
