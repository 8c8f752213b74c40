// The point that a pixel shades, moved onto the plane of its own triangle: as in kernels/shadows/receivers.h,
// but in float. Relative to the origin of the rays' scene (rays/ray_scene.h), along the world's axes, in
// metres.
uniform usampler2D receiver_triangles;   // the rays' number of the triangle that a pixel shows
uniform samplerBuffer triangle_corners;  // three texels each, by these numbers

layout(std140) uniform ReceiverBlock {
  vec4 world_from_view[3];  // rows; w: of the eye
  vec4 eye;                 // w 0: the direction to it, in an orthographic view
} receivers;

struct Receiver {
  bool covered;  // the pixel shows a triangle
  vec3 at, corners[3];
  vec3 normal;  // unit, towards the eye
  float gap;    // metres in front of the point in which nothing hides it
};

Receiver receiver_at(ivec2 pixel, vec3 position_view) {
  Receiver r;
  uint triangle = texelFetch(receiver_triangles, pixel, 0).r;
  r.covered = triangle != 0xffffffffu;
  if (!r.covered) return r;
  vec4 p = vec4(position_view, 1.0);
  r.at = vec3(dot(receivers.world_from_view[0], p), dot(receivers.world_from_view[1], p),
              dot(receivers.world_from_view[2], p));
  r.gap = 9.5367431640625e-7 * length(r.at) + 1e-3;  // 2^-20
  for (int k = 0; k < 3; ++k) r.corners[k] = texelFetch(triangle_corners, int(triangle) * 3 + k).xyz;
  vec3 across = cross(r.corners[1] - r.corners[0], r.corners[2] - r.corners[0]);
  float side = dot(across, receivers.eye.xyz - receivers.eye.w * r.corners[0]);
  r.normal = across * ((side < 0.0 ? -1.0 : 1.0) * inversesqrt(max(dot(across, across), 1.2e-38)));
  r.at -= r.normal * dot(r.at - r.corners[0], r.normal);
  return r;
}

// The receiver's own triangle is between the eye and a light.
bool turned_away(Receiver r, vec3 light) { return dot(light - r.at, r.normal) < 0.0; }
