// Random views, with surfaces, of every class that docs/hard_cases.md covers.
#pragma once

#include "verify/hunt_settings.h"
#include "verify/views.h"

namespace lightgrid::verify {

// The domain (docs/hard_cases.md#the-domain): distances of surfaces, and edges of slices and z-bins, metres.
constexpr double hunt_least_m = 1e-15, hunt_most_m = 1e15, hunt_most_edge_m = 1e13;

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
  double unit_m = 1;         // the scene's scale
  // A fraction of the lights lies elsewhere, at this distance from the eye, metres; 0: none.
  double elsewhere = 0, elsewhere_m = 0, elsewhere_radius_m = 0;
  DepthImage depth;
};

// The same for equal arguments.
HuntView random_view(HuntClass hunted, const HuntSetting& setting, uint64_t seed);

}  // namespace lightgrid::verify
