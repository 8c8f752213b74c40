// The picture in bytes as base/image.h's srgb_bytes has them: RGBA, alpha 255. A work-item a pixel.
#include "shared/tone_map.h"

kernel void tone_map(global const float4* image, uint pixels, float scale, global const float* min_linear,
                     global uchar4* picture) {
  const uint i = get_global_id(0);
  if (i >= pixels) return;
  const float3 light = image[i].xyz;
  const float3 c = tone_mapped(light * scale);
  const uchar4 shown =
      (uchar4)(srgb_byte(c.x, min_linear), srgb_byte(c.y, min_linear), srgb_byte(c.z, min_linear), 255);
  const bool is_nan = light.x != light.x || light.y != light.y || light.z != light.z;
  picture[i] = is_nan ? (uchar4)(255, 0, 255, 255) : shown;
}
