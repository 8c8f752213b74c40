// The glTF 2.0 metallic-roughness BRDF (specification, appendix B): Lambert and GGX with height-correlated Smith.

const float PI = 3.14159265358979;
const float ROUGHNESS_FLOOR = 0.045;  // below it D's peak leaves the range in which float keeps its shape

// What is the same for every light at a fragment.
struct ShadingPoint {
  vec3 position, normal, to_viewer;
  vec3 diffuse;   // albedo / pi
  vec3 f0;
  float alpha, alpha_squared;
  float n_dot_v;
  float smith_view;  // sqrt(n_dot_v^2 (1 - alpha^2) + alpha^2)
};

ShadingPoint shading_point(vec3 position, vec3 to_viewer, vec3 normal, vec3 base_color, float metallic, float roughness) {
  ShadingPoint p;
  p.position = position;
  p.normal = normal;
  p.to_viewer = to_viewer;
  p.diffuse = base_color * (1.0 - metallic) * (1.0 / PI);
  p.f0 = mix(vec3(0.04), base_color, metallic);
  float perceptual = max(roughness, ROUGHNESS_FLOOR);
  p.alpha = perceptual * perceptual;
  p.alpha_squared = p.alpha * p.alpha;
  p.n_dot_v = max(dot(normal, to_viewer), 1e-4);
  p.smith_view = sqrt(p.n_dot_v * p.n_dot_v * (1.0 - p.alpha_squared) + p.alpha_squared);
  return p;
}

// BRDF times the cosine at the surface. to_light is a unit vector.
vec3 reflected(ShadingPoint p, vec3 to_light) {
  float n_dot_l = clamp(dot(p.normal, to_light), 0.0, 1.0);
  // The half vector is left unnormalised: |h|^2 goes into the formulas instead. It vanishes only where viewer and
  // light face each other through the surface, and n_dot_l is 0.
  vec3 h = to_light + p.to_viewer;
  float h_squared = max(dot(h, h), 1e-8);
  float n_dot_h = max(dot(p.normal, h), 0.0);
  // sin^2 of the angle between normal and half vector as a cross product: 1 - cos^2 would cancel at the peak.
  vec3 across = cross(p.normal, h);
  // At least |h|^2 alpha^2 where a light shines; the floor is below that, and keeps a vanished h from 0/0.
  float width = max(dot(across, across) + n_dot_h * n_dot_h * p.alpha_squared, 1e-14);
  // GGX D = (alpha |h|^2 / width)^2 / pi, times Smith's V = 0.5 / (...), in one division.
  float peak = p.alpha * h_squared;
  float smith = n_dot_l * p.smith_view + p.n_dot_v * sqrt(n_dot_l * n_dot_l * (1.0 - p.alpha_squared) + p.alpha_squared);
  float specular = peak * peak * (0.5 / PI) / (width * width * smith);
  // v.h = |h| / 2 for unit vectors.
  float grazing = max(1.0 - 0.5 * sqrt(h_squared), 0.0);
  float grazing2 = grazing * grazing;
  vec3 f = p.f0 + (1.0 - p.f0) * (grazing2 * grazing2 * grazing);
  return (p.diffuse + f * (specular - p.diffuse)) * n_dot_l;
}
