// Hard cases of the light buffer (docs/techniques/light_prepass.md): its six sums at each pixel, added up
// from the lists of tiles, against the same sums over all lights in double.
#include <algorithm>
#include <array>
#include <cmath>

#include "cl/transfer.h"
#include "oracle/attenuation.h"
#include "oracle/position.h"
#include "passes/common/prepass_settings.h"
#include "passes/cull_lights.h"
#include "passes/depth_bounds.h"
#include "passes/fill_light_buffer.h"
#include "passes/pass_cases.h"
#include "plan/settings/surfaces.h"
#include "renderer/render_view.h"
#include "scene/random.h"
#include "scene/virtual_lights.h"
#include "support/light_sums.h"

namespace lightgrid {
using namespace lab;
namespace {

constexpr double light_exponent = 32;  // value of the setting prepass-shininess
constexpr double largest_sum = 1e30;   // bound on floats that the buffer stores
constexpr double float_step = 0x1p-24;

// The surfaces that the pass reads: row 0 at the bottom, normals in view space.
struct PrepassInput {
  std::vector<float> depth;
  std::vector<glm::vec4> normals;
};

struct SixSums {
  double of[6];
};

// A wall that faces the eye, 4 m away; the first pixel is background.
PrepassInput wall_input(const View& view, const glm::vec3& normal = {0, 0, 1}) {
  PrepassInput input;
  const glm::dvec4 clip = view.clip_from_view * glm::dvec4(0, 0, -4, 1);
  input.depth.assign(view.grid().values(), float(clip.z / clip.w));
  input.normals.assign(input.depth.size(), glm::vec4(normal, 0));
  if (input.depth.size() > 1) input.depth[0] = 0;
  return input;
}

std::vector<SixSums> filled_sums(Renderer& renderer, const Scene& scene, const View& view,
                                 const PrepassInput& input) {
  Settings settings;
  settings.set(setting::raster, RasterApi::opencl);
  settings.set(setting::prepass_specular, PrepassSpecular::fifth_term);
  GpuScene gpu(renderer, scene);
  RenderView v(
      renderer, gpu, view, settings,
      {.surfaces = {.chosen_raster = true}, .lists = {.light_grid = true, .z_bins = true, .no_masks = true}});
  if (!v.plan.lists.light_grid) return std::vector<SixSums>(v.grid().values(), SixSums{});
  ClDevice& device = *renderer.cl;
  SharedBuffer& depth = v.shared_samples("depth", 4);
  write_buffer(device, "writing depth", depth.cl_buffer(), input.depth.data(), v.grid().values() * 4);
  const NormalsInCl normals = normals_in_cl_of(v, TargetUse::gbuffer);
  write_buffer(device, "writing normals", normals.image->cl_buffer(), input.normals.data(),
               v.grid().values() * 16);
  const DepthBuffer in_cl{depth.cl_buffer()};
  const LightSource lights =
      from_grid(v, cull_lights(v, v.culler(), v.opaque_grid(), depth_bounds(v, v.culler(), in_cl)));
  const LightBufferInCl sums =
      fill_light_buffer(v, v.caches.light_sums, normals, in_cl, lights, TargetUse::gbuffer);
  std::vector<glm::vec4> first(v.grid().values());
  std::vector<glm::vec2> second(v.grid().values());
  read_buffer(device, "reading sums", sums.first->cl_buffer(), first.data(), first.size() * 16);
  read_buffer(device, "reading sums", sums.second->cl_buffer(), second.data(), second.size() * 8);
  std::vector<SixSums> all;
  all.reserve(v.grid().values());
  for (size_t i = 0; i < first.size(); ++i)
    all.push_back({{first[i].x, first[i].y, first[i].z, first[i].w, second[i].x, second[i].y}});
  return all;
}

// The possible change of one light by rounding positions by some steps: its direction turns by `turned`, of
// which the lobe's slope is below the root of its exponent times 0.61, that of (1 - v.h)^5 below 5, that of 1
// / d^2 and its window below 6, and that of a cone 2 / (inner - outer). The lobe's logarithm and exponential:
// 32 times some steps.
double rounding_of(const ViewLight& light, const glm::dvec3& position, double brightest) {
  const double distance = glm::length(light.position - position);
  const double size = glm::length(position) + std::min(glm::length(light.position), light.radius_m);
  const double turned = 16 * float_step * (size / std::max(distance, 1e-30) + 1);
  if (!(distance < light.radius_m * (1 + turned))) return 0;
  const double cone = has_cone(light) ? 2 / (light.cos_inner - light.cos_outer) : 0;
  return brightest / (distance * distance) * (turned * (16 + cone) + 64 * float_step);
}

void hold_sums(PassCheck& c, const Scene& scene, const View& view, const PrepassInput& input,
               const char* name, double repeated = 1) {
  Scene drawn = scene;
  drawn.lights.insert(drawn.lights.end(), size_t(repeated - 1),
                      scene.lights.empty() ? Light() : scene.lights[0]);
  // Far away, so that all cases need one kernel.
  add_spot(drawn, "far", glm::vec3(view.eye + glm::dvec3(0, 1e6, 0)), glm::vec3(view.eye), {1, 1, 1}, 1, 1,
           10, 20);
  const std::vector<SixSums> sums = filled_sums(opencl_devices(), drawn, view, input);
  const std::vector<ViewLight> lights = lights_in_view(scene, view);
  for (size_t i = 0; i < sums.size(); ++i) {
    SixSums expected{};
    double allowed = 0;
    if (input.depth[i] > 0) {
      const glm::dvec3 position =
          position_from_depth(view, int(i % size_t(view.width)), int(i / size_t(view.width)), input.depth[i]);
      const LightSums s =
          light_sums(position, glm::normalize(glm::dvec3(input.normals[i])), lights, light_exponent);
      expected = {{s.diffuse.x, s.diffuse.y, s.diffuse.z, s.specular, s.weight, s.rim}};
      for (const ViewLight& light : lights) {
        const glm::dvec3& intensity = light.radiant_intensity;
        allowed += rounding_of(light, position, std::max({intensity.x, intensity.y, intensity.z}));
        c.contacts += attenuation(light, position, true) > 0;
      }
      allowed = repeated * (allowed + (double(lights.size()) + repeated) * float_step * s.weight);
    }
    for (int channel = 0; channel < 6; ++channel) {
      const double wanted = std::min(repeated * expected.of[channel], largest_sum),
                   found = sums[i].of[channel];
      c.that(std::abs(found - wanted) <= allowed + 1e-6 * wanted ||
                 (wanted >= largest_sum && found >= 0.999 * largest_sum),
             "{}: pixel {}, channel {}: {} of {}, {} allowed", name, i, channel + 1, found, wanted, allowed);
    }
  }
}

void hold_wall(PassCheck& c, const Scene& scene, const char* name) {
  const View view = eye_view(33, 19);
  hold_sums(c, scene, view, wall_input(view), name);
}

void in_the_surface(PassCheck& c) {
  for (const float before : {0.0f, 1e-4f, 0.01f, -0.3f}) {
    Scene scene = wall_scene();
    add_point(scene, "lamp", {0.2f, 0.1f, -4 + before}, {1, 0.5f, 0.2f}, 2, 2);
    hold_wall(c, scene, before < 0 ? "behind the wall" : "at the wall");
  }
}

void around_the_eye(PassCheck& c) {
  for (const glm::vec3 at : {glm::vec3(0), glm::vec3(0.05f, 0, 0.05f)}) {
    Scene scene = wall_scene();
    add_point(scene, "lamp", at, {1, 0.5f, 0.2f}, 5, 30);
    hold_wall(c, scene, "around the eye");
  }
}

void ranges_of_any_size(PassCheck& c) {
  constexpr float sizes[] = {std::numeric_limits<float>::infinity(), 1e20f, 1e4f, 0.011f, 1e-40f, 0};
  for (const float radius : sizes) {
    Scene scene = wall_scene();
    add_point(scene, "lamp", {0.3f, 0, -3.99f}, {1, 0.5f, 0.2f}, 1, radius);
    hold_wall(c, scene, "a range of any size");
  }
}

void sums_of_any_brightness(PassCheck& c) {
  for (const float candela : {0.0f, 1e-30f, 1e20f, 1e30f, 3e38f}) {
    Scene scene = wall_scene();
    add_point(scene, "lamp", {0.3f, 0, -3}, {1, 0.5f, 0.2f}, candela, 3);
    hold_wall(c, scene, "any brightness");
  }
}

void thin_spots_in_tiles(PassCheck& c) {
  Scene scene = wall_scene();
  Random random(3);
  for (int i = 0; i < 100; ++i) {
    const glm::vec3 at(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-3, 0));
    const glm::vec3 target(random.uniform(-2, 2), random.uniform(-1, 1), -4);
    const float outer = 60 * std::pow(10.0f, -random.uniform(0, 5));
    add_spot(scene, "thin", at, target, {1, 1, 1}, 9, 9, 0, outer);
  }
  hold_wall(c, scene, "thin spots");
}

void virtual_lights_in_tiles(PassCheck& c) {
  Scene scene = wall_scene();
  Random random(5);
  for (int i = 0; i < 60; ++i) {
    Light& light =
        add_point(scene, "virtual", {random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-3.99f, 0)},
                  {1, 0.7f, 0.9f}, 5, 4);
    make_virtual(light);
    light.direction = glm::vec3(any_direction(random));
    light.nearest_m = std::array{0.0f, 0.3f, 2.0f}[size_t(i % 3)];
  }
  hold_wall(c, scene, "virtual lights");
}

void nothing_in_range(PassCheck& c) { hold_wall(c, wall_scene(), "no lights"); }

// The sum of equal terms rounds once a term. Up to 65,535 lights have indices of 16 bits, as the other cases.
void many_in_one_place(PassCheck& c) {
  Scene scene = wall_scene();
  add_point(scene, "lamp", {0.3f, 0.2f, -3.5f}, {1, 0.8f, 0.6f}, 0.001f, 1);
  const View view = eye_view(17, 9);
  hold_sums(c, scene, view, wall_input(view), "many in one place", long_tests() ? 1e6 : 5e4);
}

// Normals of every direction, also away from the eye, and at a right angle to a light.
void normals_of_any_direction(PassCheck& c) {
  const View view = eye_view(33, 19);
  Scene scene = wall_scene();
  add_random_lights(scene, 60, 5);
  PrepassInput input = wall_input(view);
  Random random(8);
  for (glm::vec4& normal : input.normals) normal = glm::vec4(glm::vec3(any_direction(random)), 0);
  input.normals[40] = {0, 0, -1, 0};
  input.normals[41] = {1, 0, 0, 0};
  hold_sums(c, scene, view, input, "normals of any direction");
}

void surfaces_at_any_distance(PassCheck& c) {
  const View view = eye_view(33, 19);
  Scene scene = wall_scene();
  add_random_lights(scene, 100, 6);
  add_point(scene, "far", {0, 0, -900}, {1, 1, 1}, 1e6f, 2000);
  PrepassInput input = wall_input(view);
  Random random(9);
  for (float& depth : input.depth)
    depth = random.uniform() < 0.1f ? 0 : std::pow(10.0f, -random.uniform(0, 4.5f));
  hold_sums(c, scene, view, input, "surfaces at any distance");
}

void buffers_of_awkward_sizes(PassCheck& c) {
  Scene scene = wall_scene();
  add_random_lights(scene, 100, 7);
  for (const glm::ivec2 size : {glm::ivec2(1, 1), glm::ivec2(17, 9), glm::ivec2(3, 65), glm::ivec2(66, 33)}) {
    const View view = eye_view(size.x, size.y);
    hold_sums(c, scene, view, wall_input(view), "awkward sizes");
  }
}

void sums_far_from_the_origin(PassCheck& c) {
  for (const double offset : {1e5, 1e8}) {
    const glm::dvec3 origin(offset, -2 * offset, offset / 2);
    Scene scene = wall_scene(origin);
    add_random_lights(scene, 60, 11);
    for (Light& light : scene.lights) light.position += origin;
    const View view = eye_view(33, 19, origin);
    hold_sums(c, scene, view, wall_input(view), "far from the origin");
  }
}

void fuzzed_sums(PassCheck& c) {
  for (const uint64_t seed : {21, 22, 23}) {
    Scene scene = wall_scene();
    add_random_lights(scene, 300, seed);
    hold_wall(c, scene, "fuzzed");
  }
}

}  // namespace

std::vector<PassCase> light_buffer_cases() {
  constexpr const char* sums = "every sum as the oracle's";
  return {
      CASE(in_the_surface, "lights in a wall's plane, 0.1 mm and 1 cm before it, behind it",
           "n·l from rounded positions; normalize(0)", sums),
      CASE(around_the_eye, "the eye in a light, and at its centre", "v·h of opposite directions", sums),
      CASE(ranges_of_any_size, "ranges of ∞, 10²⁰, 10⁴, 0.011, 10⁻⁴⁰ and 0 m",
           "1 / radius² is infinite, or 0", sums),
      CASE(sums_of_any_brightness, "0, 10⁻³⁰, 10²⁰ and 3·10³⁸ candela",
           "∞ · 0 in a lobe; a sum past what materials take", "every sum as the oracle's, 10³⁰ at most"),
      CASE(thin_spots_in_tiles, "half-angles of 60 to 6·10⁻⁴ degrees", "a cone misses tiles' centres", sums),
      CASE(virtual_lights_in_tiles, "cosine emitters, clamped at 0, 0.3 and 2 m",
           "the square of a cosine; no clamp near a surface", sums),
      CASE(nothing_in_range, "0 lights in range", "a list that is not there is read", "sums of exactly 0"),
      CASE(many_in_one_place, "5·10⁴ lights in one place (10⁶ with LIGHTGRID_LONG_TESTS)", "a limit a tile",
           sums),
      CASE(normals_of_any_direction, "normals away from the eye and across lights",
           "negative cosines; lobes behind the surface", sums),
      CASE(surfaces_at_any_distance, "neighbours at 0.1 to 3,000 m, and background between them",
           "a tile's bounds or its background leak", "every sum as the oracle's, 0 in the background"),
      CASE(buffers_of_awkward_sizes, "1 × 1, 17 × 9, 3 × 65 and 66 × 33 pixels",
           "rows of 4 × 4 pixels past an edge", sums),
      CASE(sums_far_from_the_origin, "the world moved by 10⁵ and 10⁸ m", "positions of the world in float",
           sums),
      CASE(fuzzed_sums, "300 lights of 5 cm to 6 m, a quarter spots", "whatever is left", sums),
  };
}

}  // namespace lightgrid
