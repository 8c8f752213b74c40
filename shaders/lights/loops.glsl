// LONG_LOOPS: there may be so many lights that the driver ends a loop over them early
// (shaders/lights/blocks.glsl). A sum that lacks lights is then NaN, which is counted and drawn in magenta,
// not a picture that only looks right.
#ifdef LONG_LOOPS
vec3 sum_if(bool finished, vec3 sum) { return finished ? sum : vec3(uintBitsToFloat(0x7fc00000u)); }
#else
vec3 sum_if(bool finished, vec3 sum) { return sum; }
#endif
