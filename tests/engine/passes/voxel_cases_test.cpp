// Hard cases of the voxel light buffer (docs/techniques/voxel_lights.md), in both spaces: every sample
// against the formulas of its page in double, and each point that a light reaches against the eight samples
// around it.
#include <algorithm>
#include <array>
#include <cmath>

#include "passes/build_voxels.h"
#include "passes/pass_cases.h"
#include "passes/voxels/voxel_settings.h"
#include "plan/settings/grid.h"
#include "plan/settings/surfaces.h"
#include "renderer/render_view.h"
#include "scene/random.h"
#include "scene/virtual_lights.h"
#include "support/light_sums.h"

namespace lightgrid {
using namespace lab;
namespace {

// A volume and its lights, along its axes; lengths in metres from its origin.
struct FilledVoxels {
  ReadVoxels read;
  std::vector<ViewLight> lights;
  glm::dvec2 max_slope{0};  // slope at the image's edge, where the volume is the view's

  glm::uvec3 size() const {
    return {read.placed.grid.size_x, read.placed.grid.size_y, read.placed.grid.size_z};
  }

  glm::dvec3 sample_at(const glm::uvec3& i) const {
    const VoxelGrid& g = read.placed.grid;
    const double x = double(g.origin_x) + i.x * double(g.spacing_x),
                 y = double(g.origin_y) + i.y * double(g.spacing_y);
    const double place = read.placed.slices[i.z].place;
    return read.axes.log_depth ? glm::dvec3(x * place, y * place, -place) : glm::dvec3(x, y, place);
  }

  // Cells are boxes, or parts of pyramids, of which the larger one behind a sample counts: the box around it.
  VoxelCell cell_of(uint32_t slice) const {
    const VoxelGrid& g = read.placed.grid;
    const auto place = [&](uint32_t z) { return double(read.placed.slices[z].place); };
    const glm::dvec2 across(g.spacing_x, g.spacing_y);
    if (!read.axes.log_depth) {
      const double deep = place(1) - place(0);
      return VoxelCell::of({across, deep}, across.x * across.y * deep);
    }
    const double step = std::log(place(g.size_z - 1) / place(0)) / (g.size_z - 1),
                 next = place(slice) * std::exp(step);
    const double deep = next - place(slice);
    return VoxelCell::of({across * next + max_slope * deep, deep},
                         across.x * across.y * place(slice) * place(slice) * (step * place(slice)));
  }
};

glm::dvec2 max_slope(const View& view) {
  const glm::dmat4& clip = view.clip_from_view;
  return {(1 + std::abs(clip[2][0])) / std::abs(clip[0][0]),
          (1 + std::abs(clip[2][1])) / std::abs(clip[1][1])};
}

struct VoxelCase {
  Scene scene = wall_scene();
  View view = eye_view(40, 25);
  double repeated = 1;  // each light as often
};

FilledVoxels filled_voxels(Renderer& renderer, const VoxelCase& of, VoxelSpace space) {
  Settings settings;
  settings.set(setting::raster, RasterApi::opencl);
  settings.set(setting::depth_bounds, DepthBoundsMode::none);
  settings.set(setting::voxel_size, VoxelSize::s16x16x4);
  settings.set(setting::voxel_space, space);
  Scene scene = of.scene;
  scene.lights.reserve(of.scene.lights.size() * size_t(of.repeated) + 1);
  for (double i = 1; i < of.repeated; ++i)
    scene.lights.insert(scene.lights.end(), of.scene.lights.begin(), of.scene.lights.end());
  // Far away, so that all cases need one kernel.
  add_spot(scene, "far", glm::vec3(of.view.eye + glm::dvec3(0, 1e6, 0)), glm::vec3(of.view.eye), {1, 1, 1}, 1,
           1, 10, 20);
  GpuScene gpu(renderer, scene);
  RenderView v(renderer, gpu, of.view, settings,
               {.surfaces = {.chosen_raster = true}, .lists = {.no_masks = true}});
  build_voxels(v, v.caches.voxels, {});
  FilledVoxels filled{read_voxels(v, v.caches.voxels), {}, max_slope(of.view)};
  View along;
  along.view_from_world = glm::dmat4(filled.read.axes.from_world);
  along.eye = filled.read.axes.origin;
  filled.lights = lights_in_view(of.scene, along);
  return filled;
}

// Positions and distances are rounded to some steps of a float, of which 1 / distance^2 makes more near a
// light; at the rim of a light's reach or of a cone it is a part of the light's greatest value.
void expect_samples(PassCheck& c, const FilledVoxels& filled, double repeated, const char* name) {
  const glm::uvec3 size = filled.size();
  double brightest = 0;
  for (const glm::vec4& e : filled.read.irradiance)
    brightest = std::max({brightest, double(e.x), double(e.y), double(e.z)});
  size_t at = 0;
  for (uint32_t z = 0; z < size.z; ++z) {
    const VoxelCell cell = filled.cell_of(z);
    for (uint32_t y = 0; y < size.y; ++y) {
      for (uint32_t x = 0; x < size.x; ++x, ++at) {
        const VoxelSample s = voxel_sample(filled.sample_at({x, y, z}), cell, filled.lights);
        const glm::dvec3 irradiance(filled.read.irradiance[at]), directions(filled.read.directions[at]);
        const double apart = glm::length(irradiance - repeated * s.irradiance) +
                             glm::length(directions - repeated * s.directions) +
                             std::abs(double(filled.read.directions[at].w) - repeated * s.weight);
        const double allowed = 1e-5 * brightest + repeated * s.weight * (1e-3 + repeated * 0x1p-24);
        c.contacts += s.lights;
        c.that(apart <= allowed, "{}: sample {} {} {} is apart from the oracle by {} of {}, {} allowed", name,
               x, y, z, apart, repeated * s.weight, allowed);
      }
    }
  }
}

// A point of the volume, by the cell that a lookup reads.
struct PlaceInVolume {
  glm::uvec3 cell;
  bool inside;
};
PlaceInVolume place_in(const FilledVoxels& filled, const glm::dvec3& p) {
  const VoxelGrid& g = filled.read.placed.grid;
  const auto place = [&](uint32_t z) { return double(filled.read.placed.slices[z].place); };
  const bool log_depth = filled.read.axes.log_depth;
  const double scale = log_depth ? -p.z : 1;
  const glm::dvec3 first(g.origin_x, g.origin_y, 0);
  glm::dvec3 at((p.x / scale - first.x) / double(g.spacing_x), (p.y / scale - first.y) / double(g.spacing_y),
                0);
  at.z = log_depth ? std::log(scale / place(0)) / std::log(place(1) / place(0))
                   : (p.z - place(0)) / (place(1) - place(0));
  const glm::dvec3 last = glm::dvec3(filled.size()) - 1.0;
  const bool inside = scale > 0 && glm::all(glm::greaterThanEqual(at, glm::dvec3(0))) &&
                      glm::all(glm::lessThanEqual(at, last));
  return {glm::uvec3(glm::clamp(glm::floor(at), glm::dvec3(0), last - 1.0)), inside};
}

// A light that reaches a point adds to one of the samples around it, by what the library widens lights by.
void expect_nothing_lost(PassCheck& c, const FilledVoxels& filled, size_t points, const char* name) {
  Random random(17);
  for (const ViewLight& light : filled.lights) {
    if (!(light.radius_m > 0)) continue;
    for (size_t i = 0; i < points; ++i) {
      glm::dvec3 away = any_direction(random);
      if (has_cone(light)) {
        const glm::dvec3 across = glm::normalize(away - light.direction * glm::dot(away, light.direction));
        const double angle = std::acos(light.cos_outer) * (1 - 1e-6 * double(random.uniform()));
        away = light.direction * std::cos(angle) + across * std::sin(angle);
      }
      const double distance = std::min(light.radius_m, 100.0) * (i % 2 ? 1 - 1e-6 : double(random.uniform()));
      const glm::dvec3 p = light.position + away * distance;
      const auto [cell, inside] = place_in(filled, p);
      if (!inside) continue;
      ++c.contacts;
      bool reached = false;
      for (uint32_t corner = 0; corner < 8 && !reached; ++corner) {
        const glm::uvec3 sample = cell + glm::uvec3(corner & 1, corner >> 1 & 1, corner >> 2);
        const VoxelSlice& slice = filled.read.placed.slices[sample.z];
        reached = voxel_sample(filled.sample_at(sample), {slice.half_diagonal_squared, slice.core_squared},
                               {&light, 1})
                      .lights > 0;
      }
      c.that(reached, "{}: a light that reaches ({}, {}, {}) is in none of the samples around it", name, p.x,
             p.y, p.z);
    }
  }
}

void hold_voxels(PassCheck& c, const VoxelCase& of, const char* name) {
  for (const VoxelSpace space : {VoxelSpace::world, VoxelSpace::view}) {
    const FilledVoxels filled = filled_voxels(opencl_devices(), of, space);
    expect_samples(c, filled, of.repeated, name);
    expect_nothing_lost(c, filled, 50, name);
  }
}

void hold_lamp(PassCheck& c, const glm::vec3& at, float candela, float radius, const char* name) {
  VoxelCase of;
  add_point(of.scene, "lamp", at, {1, 0.8f, 0.6f}, candela, radius);
  hold_voxels(c, of, name);
}

void without_lights(PassCheck& c) { hold_voxels(c, {}, "without lights"); }
void in_the_eye(PassCheck& c) { hold_lamp(c, {0, 0, 0}, 5, 6, "in the eye"); }

// Samples of the world lie at multiples of their spacing, a power of 2^(1/4): the origin and whole metres are
// among them.
void on_a_sample(PassCheck& c) {
  hold_lamp(c, {0, 0, -4}, 5, 6, "on a sample");
  hold_lamp(c, {2, -2, -4}, 5, 1, "on a sample");
}

void larger_than_the_volume(PassCheck& c) {
  hold_lamp(c, {0, 50, -4}, 9e4f, 1e4f, "larger than the volume");
  hold_lamp(c, {1, 1, -2}, 5, std::numeric_limits<float>::infinity(), "without an end");
}

void smaller_than_a_voxel(PassCheck& c) {
  hold_lamp(c, {0.301f, 0.011f, -3.999f}, 0.1f, 0.01f, "smaller than a voxel");
  hold_lamp(c, {0, 0, -3}, 5, 0, "of no radius");
}

void samples_of_any_brightness(PassCheck& c) {
  hold_lamp(c, {0, 0, -3}, 3e38f, 5, "as bright as floats go");
  hold_lamp(c, {0.3f, -0.2f, -4}, 1e6f, 3, "a million candela on a surface");
  hold_lamp(c, {0.3f, -0.2f, -4}, 0, 3, "dark");
}

void many_in_one_voxel(PassCheck& c) {
  VoxelCase of;
  add_point(of.scene, "lamp", {0.5f, 0.4f, -3.3f}, {1, 1, 1}, 1e-4f, 1.5f);
  of.repeated = double(c.many);
  hold_voxels(c, of, "many in one voxel");
}

void cones(PassCheck& c) {
  VoxelCase of;
  Random random(3);
  for (int i = 0; i < 60; ++i) {
    const glm::vec3 at(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-4, 0));
    const float outer = i % 3 == 0 ? 89.9f : 60 * std::pow(10.0f, -random.uniform(0, 5));
    add_spot(of.scene, "cone", at, at + glm::vec3(any_direction(random)), {1, 0.7f, 0.9f}, 5, 4,
             i % 2 ? 0 : 0.9f * outer, outer);
  }
  hold_voxels(c, of, "cones");
}

// Cosine emitters, some without a clamp and some with a wide one.
void virtual_lights(PassCheck& c) {
  VoxelCase of;
  Random random(5);
  for (int i = 0; i < 60; ++i) {
    Light& light =
        add_point(of.scene, "virtual", {random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-4, 0)},
                  {1, 0.7f, 0.9f}, 5, 4);
    make_virtual(light);
    light.direction = glm::vec3(any_direction(random));
    light.nearest_m = std::array{0.0f, 0.3f, 2.0f}[size_t(i % 3)];
  }
  hold_voxels(c, of, "virtual lights");
}

void nothing_in_view(PassCheck& c) {
  VoxelCase of;
  of.view = make_view(look_at({0, 0, 2}, {0, 0, 3}), 40, 25);
  add_point(of.scene, "lamp", {0, 0, 2.5f}, {1, 1, 1}, 5, 6);
  hold_voxels(c, of, "nothing in view");
}

// The eye inside of lights' ranges, turned, near and far: the volume follows.
void bounds_that_move(PassCheck& c) {
  const glm::dvec3 eyes[] = {{0.3, 0.2, 0.5}, {-3, 2, -1}, {0, 0.1, -3.99}, {40, 10, 60}};
  for (const glm::dvec3& eye : eyes) {
    VoxelCase of;
    of.view = make_view(look_at(eye, {0, 0, -4}), 40, 25);
    add_random_lights(of.scene, 60, 4);
    hold_voxels(c, of, "bounds that move");
  }
}

void samples_far_from_the_origin(PassCheck& c) {
  const glm::dvec3 origin(1e6, -2e6, 3e6);
  VoxelCase of{wall_scene(origin), eye_view(40, 25, origin)};
  add_random_lights(of.scene, 60, 5);
  for (Light& light : of.scene.lights) light.position += origin;
  hold_voxels(c, of, "far from the origin");
}

void wide_and_narrow_views(PassCheck& c) {
  for (const double fov_y_deg : {1.0, 120.0}) {
    VoxelCase of;
    Camera camera = look_at({0, 0, 0}, {0, 0, -1});
    camera.fov_y_rad = glm::radians(fov_y_deg);
    of.view = make_view(camera, 60, 25);
    add_random_lights(of.scene, 60, 6);
    hold_voxels(c, of, "wide and narrow views");
  }
}

void fuzzed_samples(PassCheck& c) {
  for (const uint64_t seed : {31, 32}) {
    VoxelCase of;
    of.view = make_view(look_at({0.3 * double(seed - 30), 0.2, 0.5}, {0, 0, -4}), 31, 23);
    add_random_lights(of.scene, 150, seed);
    hold_voxels(c, of, "fuzzed");
  }
}

}  // namespace

std::vector<PassCase> voxel_cases() {
  constexpr const char* samples = "every sample as the oracle's; no light lost";
  return {
      CASE(without_lights, "0 lights in range", "0 / 0 in a mean direction", "every sample 0"),
      CASE(in_the_eye, "a light at the eye", "x / distance of a light at distance 0", samples),
      CASE(on_a_sample, "lights at samples", "1 / 0; normalize(0)", samples),
      CASE(larger_than_the_volume, "radii of 10⁴ m and ∞", "bounds of a light in samples; ∞ - ∞", samples),
      CASE(smaller_than_a_voxel, "radii of 1 cm and 0", "a light between samples is lost", samples),
      CASE(samples_of_any_brightness, "0, 10⁶ and 3·10³⁸ candela", "a sum of ∞, a mean of ∞ / ∞", samples),
      CASE(many_in_one_voxel, "10⁵ lights in one place (10⁶ with LIGHTGRID_LONG_TESTS)",
           "a limit a voxel or a brick", samples),
      CASE(cones, "half-angles of 90 to 6·10⁻⁴ degrees", "a cone between samples is lost", samples),
      CASE(virtual_lights, "cosine emitters, clamped at 0, 0.3 and 2 m",
           "the square of a cosine; a clamp inside a voxel's core", samples),
      CASE(nothing_in_view, "the wall behind the eye", "a volume of no size", samples),
      CASE(bounds_that_move, "eyes from 1 cm to 70 m before the wall",
           "samples of the last volume; a near plane of 0", samples),
      CASE(samples_far_from_the_origin, "the world moved by 3·10⁶ m", "samples from world positions in float",
           samples),
      CASE(wide_and_narrow_views, "fields of 1 and 120 degrees",
           "cells of the view that are sheared lose lights", samples),
      CASE(fuzzed_samples, "150 lights of 5 cm to 6 m, a quarter spots", "whatever is left", samples),
  };
}

}  // namespace lightgrid
