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
  vec3 half_sum = to_light + p.to_viewer;
  vec3 h = half_sum * inversesqrt(max(dot(half_sum, half_sum), 1e-12));
  float n_dot_h = clamp(dot(p.normal, h), 0.0, 1.0);
  float v_dot_h = clamp(dot(p.to_viewer, h), 0.0, 1.0);
  // 1 - n_dot_h^2 as a cross product: it does not cancel at the peak.
  vec3 across = cross(p.normal, h);
  float a = n_dot_h * p.alpha;
  float k = p.alpha / (dot(across, across) + a * a);
  float d = k * k * (1.0 / PI);
  float v = 0.5 / (n_dot_l * p.smith_view + p.n_dot_v * sqrt(n_dot_l * n_dot_l * (1.0 - p.alpha_squared) + p.alpha_squared));
  float grazing = 1.0 - v_dot_h;
  float grazing2 = grazing * grazing;
  vec3 f = p.f0 + (1.0 - p.f0) * (grazing2 * grazing2 * grazing);
  return ((1.0 - f) * p.diffuse + f * (d * v)) * n_dot_l;
}
