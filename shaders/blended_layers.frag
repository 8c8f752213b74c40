// Puts the fragments of blended surfaces into layers, in any order (shared/shadow_bits.h).
//   object    the number of the object's first triangle; its mesh is drawn whole, triangles in their order
//   capacity  layers that there is room for; fragments past them are only counted
//   layers    at image unit 0: numbers, then depths, one layer after the other; then the number of fragments
//             of each pixel, and the greatest of these
#include "shared/shadow_bits.h"
#include "shared/view_params.h"

layout(early_fragment_tests) in;

uniform uint object;
uniform uint capacity;
layout(r32ui) coherent uniform uimageBuffer layers;

void main() {
  uint pixels = view.width * view.height, stride = LAYER_STRIDE(pixels);
  uint at = uint(gl_FragCoord.y) * view.width + uint(gl_FragCoord.x), counts = 2u * capacity * stride;
  uint layer = imageAtomicAdd(layers, int(counts + at), 1u);
  imageAtomicMax(layers, int(counts + pixels), layer + 1u);
  if (layer >= capacity) return;
  imageStore(layers, int(layer * stride + at), uvec4(object + uint(gl_PrimitiveID)));
  imageStore(layers, int((capacity + layer) * stride + at), uvec4(floatBitsToUint(gl_FragCoord.z)));
}
