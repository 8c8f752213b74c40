// The share of a light that its shadow map hides from a receiver, as kernels/shadow_maps/shadow_maps.h finds
// it for point and spot lights. LidrShadows.MapsAnswerInOpenGlAsInOpenCl holds both to each other.
//   SHADOW_BITS: of a texel: 16, 24 or 32; SHADOW_TAPS: texels a side that are looked up
uniform usamplerBuffer shadow_faces;  // four texels each: from, extent; right, range; up, size; ahead, first
#if SHADOW_BITS == 32
uniform samplerBuffer shadow_texels;
const float texel_nothing = 3.4e38;
#else
uniform usamplerBuffer shadow_texels;
const float texel_nothing = float((1 << SHADOW_BITS) - 1);
#endif

struct ShadowFace {
  vec3 from, right, up, ahead;
  float extent, range;
  uint size, first;
};

ShadowFace shadow_face(uint face) {
  uvec4 a = texelFetch(shadow_faces, int(face) * 4), b = texelFetch(shadow_faces, int(face) * 4 + 1);
  uvec4 c = texelFetch(shadow_faces, int(face) * 4 + 2), d = texelFetch(shadow_faces, int(face) * 4 + 3);
  return ShadowFace(uintBitsToFloat(a.xyz), uintBitsToFloat(b.xyz), uintBitsToFloat(c.xyz),
                    uintBitsToFloat(d.xyz), uintBitsToFloat(a.w), uintBitsToFloat(b.w), c.w, d.w);
}

// +x, -x, +y, -y, +z, -z.
uint cube_face(vec3 to) {
  vec3 size = abs(to);
  int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  return uint(2 * axis) + (to[axis] < 0.0 ? 1u : 0u);
}

vec3 along_face(ShadowFace f, vec3 v) { return vec3(dot(f.right, v), dot(f.up, v), dot(f.ahead, v)); }

// light: its position. faces: the first and their number.
float hidden_by_map(uvec2 faces, vec3 light, Receiver r) {
  vec3 to = r.at - light;
  ShadowFace f = shadow_face(faces.x + (faces.y == 6u ? cube_face(to) : 0u));
  vec3 p = along_face(f, to), n = along_face(f, r.normal);
  if (!(p.z > 0.0)) return 0.0;
  float furthest = p.z;
  for (int k = 0; k < 3; ++k) furthest = max(furthest, dot(f.ahead, r.corners[k] - light));
  float half_size = 0.5 * float(f.size), to_texels = half_size / f.extent, step = 1.0 / to_texels;
#if SHADOW_BITS == 32
  float metres = 1.0;
#else
  float metres = f.range / (texel_nothing - 1.0);
#endif
  float plane = dot(n, p), turn = plane < 0.0 ? -1.0 : 1.0;
  float rounding = 4.76837158203125e-7 * (length(light) + length(r.at));  // 2^-21
  float in_front = r.gap * p.z / length(p);
  vec2 texel = floor(p.xy / p.z * to_texels + half_size);
  float hidden = 0.0;
  for (int j = -(SHADOW_TAPS / 2); j <= SHADOW_TAPS / 2; ++j) {
    for (int i = -(SHADOW_TAPS / 2); i <= SHADOW_TAPS / 2; ++i) {
      vec2 t = clamp(texel + vec2(i, j), 0.0, float(f.size) - 1.0);
      vec2 uv = (t + (0.5 - half_size)) * step;
      // Where the texel's centre sees the receiver's plane, but no further than the triangle goes.
      float facing = turn * (dot(n.xy, uv) + n.z);
      float expected = facing > 0.0 ? min(turn * plane / facing, furthest) : furthest;
#if SHADOW_BITS == 32
      float format_step = expected * 1.1920928955078125e-7;  // 2^-23
#else
      float format_step = metres;
#endif
      float bias = in_front + format_step + rounding * sqrt(dot(uv, uv) + 1.0) / max(facing, 9.765625e-4);
      float stored = float(texelFetch(shadow_texels, int(f.first) + int(t.y) * int(f.size) + int(t.x)).r);
      hidden += stored < texel_nothing && stored * metres < expected - bias ? 1.0 : 0.0;
    }
  }
  return hidden / float(SHADOW_TAPS * SHADOW_TAPS);
}
