// The share of a sphere light that is hidden from a pixel's surface: many rays of the oracle, in double.
#pragma once

#include "oracle/occlusion.h"
#include "scene/random.h"

namespace lightgrid {

struct HiddenShare {
  double share = 0;
  double either = 0;  // share of the rays whose answer turns on rounding: half of them count as hidden
};

// The sphere is the disc of its radius around the light that faces the receiver. side * side rays, one to a
// random place in each cell of a square that is mapped to the disc (P. Shirley, K. Chiu, "A low distortion
// map between disk and square", 1997). The light has a place.
HiddenShare hidden_share(const Occlusion& occlusion, const Light& light, const Receiver& receiver,
                         double radius_m, int side, Random& random);

}  // namespace lightgrid
