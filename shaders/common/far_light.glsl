// Far light at a point (shared/far_light.h), interpolated by the sampler.
#include "shared/far_light.h"

uniform sampler3D far_moments;  // its planes, one behind the other

FarLight far_light_at(vec3 position) {
  vec3 place = far_place(position) + 0.5;
  vec3 size = vec3(textureSize(far_moments, 0));
  vec4 m[FAR_PLANES];
  for (int plane = 0; plane < FAR_PLANES; ++plane)
    m[plane] = textureLod(far_moments, vec3(place.xy, place.z + float(plane) * (far_lookup.last_z + 1.0)) / size, 0.0);
  FarLight light;
  light.red = FarMoments(m[0].x, m[0].y, m[0].z, m[0].w, m[1].x, m[1].y, m[1].z, m[1].w, m[6].x);
  light.green = FarMoments(m[2].x, m[2].y, m[2].z, m[2].w, m[3].x, m[3].y, m[3].z, m[3].w, m[6].y);
  light.blue = FarMoments(m[4].x, m[4].y, m[4].z, m[4].w, m[5].x, m[5].y, m[5].z, m[5].w, m[6].z);
  return light;
}
