// The value of an animation channel at a time (glTF 2.0, section 3.11 and appendix C).
#pragma once

#include <vector>

#include "scene/rig.h"

namespace lightgrid {

// Before the first key: its value; after the last key: its value. Rotations are unit quaternions (x, y, z,
// w), interpolated along the shorter arc if linear. If keys share a time, the last of them applies from that
// time on.
std::vector<double> sample_channel(const AnimationChannel& channel, double seconds);

}  // namespace lightgrid
