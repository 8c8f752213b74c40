// The lights of its list that a pixel may skip, because none of their z-bins is its own. They would add an
// exact zero.
//   Z_BINS: there are z-bins.
#include "shared/slices.h"
#include "shaders/common/fragment_place.glsl"

#ifdef Z_BINS
uniform usamplerBuffer light_z_bins;

uint z_bin_here() { return z_bin_of_key(-fragment_place().z); }

bool reaches_bin(uint light, uint bin) { return bins_hold(texelFetch(light_z_bins, int(light)).r, bin); }
#else
uint z_bin_here() { return 0u; }

bool reaches_bin(uint light, uint bin) { return true; }
#endif
