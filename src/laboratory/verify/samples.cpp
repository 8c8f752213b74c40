// Hard cases of several samples a pixel: what only some samples of a pixel see. Each sample is compared with
// the coverage oracle at its own place, in both kernel shapes.
#include <algorithm>
#include <cmath>
#include <functional>

#include "oracle/lit_set.h"
#include "oracle/position.h"
#include "plan/settings/cull_test.h"
#include "plan/settings/grid.h"
#include "plan/settings/kernels.h"
#include "plan/settings/samples.h"
#include "scene/view_lights.h"
#include "verify/hunt_cases.h"
#include "verify/raster_check.h"
#include "verify/shadow_scenes.h"

namespace lightgrid::lab::verify {
namespace {

using glm::dvec2;
using glm::dvec3;

constexpr int numbers[] = {2, 4, 8};
RasterInput scene_with(int samples, int width, int height, bool two_sided = true) {
  return raster_scene(width, height, two_sided, samples);
}

void for_each_number(const std::function<void(int)>& run) {
  for (const int samples : numbers) run(samples);
}

// A corner at pixels (x, y) and distance d.
void add_at(RasterInput& input, const dvec2& a, const dvec2& b, const dvec2& c, double d) {
  add_raster_triangle(input, raster_position(input, a.x, a.y, d), raster_position(input, b.x, b.y, d),
                      raster_position(input, c.x, c.y, d));
}

// A triangle of 1/8 pixel around each sample of some pixels: each covers that sample alone.
void one_sample_alone(Check& c) {
  for_each_number([&](int samples) {
    const std::vector<dvec2> at = sample_places(samples);
    RasterInput input = scene_with(samples, 67, 66);
    int pixel = 0;
    for (int y = 0; y < 66; y += 3) {
      for (int x = 0; x < 67; x += 3, ++pixel) {
        const dvec2& p = at[size_t(pixel) % at.size()];
        const double px = x + 0.5 + p.x, py = y + 0.5 + p.y, r = 1.0 / 16;
        add_at(input, {px - r, py - r}, {px + r, py - r}, {px, py + r}, 2);
      }
    }
    const std::optional<RasterImage> image = raster(c, input);
    if (image)
      c.that(std::ranges::count_if(image->triangles, [](uint32_t t) { return t != no_triangle; }) == pixel,
             "a triangle covers none or more than one of {} samples", samples);
  });
}

void sheet(Check& c, bool on_places) {
  for_each_number([&](int samples) {
    covers_once(c, scene_with(samples, 70, 66), 15, on_places, Random(uint32_t(41 + samples)));
  });
}
void edges_at_samples(Check& c) { sheet(c, false); }
void on_sample_places(Check& c) { sheet(c, true); }

// Most slivers meet one sample of a pixel or none.
void fan_around_a_sample(Check& c) {
  for_each_number([&](int samples) {
    const dvec2 p = sample_places(samples).back();
    fan(c, scene_with(samples, 75, 71, false), 35.5 + p.x, 30.5 + p.y, 200);
  });
}

// Bars of 0.02 to 0.3 pixel across the image: they meet samples here and there, and pixels' centres hardly
// ever.
void bars_between_samples(Check& c) {
  for_each_number([&](int samples) {
    RasterInput input = scene_with(samples, 80, 70);
    Random random(43);
    for (int i = 0; i < 120; ++i) {
      const double x = random.uniform(0, 80), y = random.uniform(0, 70), angle = random.uniform(0, 6.3f);
      const double width = random.uniform(0.02f, 0.3f), d = random.uniform(1, 4);
      const dvec2 along{120 * std::cos(angle), 120 * std::sin(angle)},
          across{-width * std::sin(angle), width * std::cos(angle)};
      add_at(input, {x - along.x, y - along.y}, {x + along.x, y + along.y}, {x + across.x, y + across.y}, d);
    }
    raster(c, input);
  });
}

// Planes that pass through each other at slants: which is nearer differs from sample to sample.
void crossing_planes(Check& c) {
  for_each_number([&](int samples) {
    RasterInput input = scene_with(samples, 90, 80);
    Random random(47);
    const auto corner = [&] {
      const double x = random.uniform(-40, 130), y = random.uniform(-40, 120), d = random.uniform(0.5f, 9);
      return raster_position(input, x, y, d);
    };
    for (int i = 0; i < 60; ++i) add_raster_triangle(input, corner);
    raster(c, input);
  });
}

// Edges within half a pixel of where tiles of 64 pixels and the image end, on either side.
void beside_borders(Check& c) {
  for_each_number([&](int samples) {
    RasterInput input = scene_with(samples, 130, 129);
    Random random(53);
    for (const int border : {0, 64, 128, 129, 130}) {
      for (int i = 0; i < 12; ++i) {
        const double edge = border + random.uniform(-0.5f, 0.5f), other = random.uniform(0, 130),
                     reach = i % 2 ? 20 : -20, d = random.uniform(1, 3);
        add_at(input, {edge, other}, {edge, other + 9}, {edge + reach, other + 4}, d);
        add_at(input, {other, edge}, {other + 9, edge}, {other + 4, edge + reach}, d);
      }
    }
    raster(c, input);
  });
}

void equal_at_samples(Check& c) {
  for_each_number(
      [&](int samples) { equal_depths_of_copies(c, scene_with(samples, 90, 50, false), Random(59)); });
}

void samples_around_the_eye(Check& c, float reach, bool whole_numbers) {
  for_each_number([&](int samples) {
    around_the_eye(c, scene_with(samples, 60, 50), 100, reach, whole_numbers, Random(61));
  });
}
void around_the_eye_at_samples(Check& c) { samples_around_the_eye(c, 5, false); }
void w_zero_at_samples(Check& c) { samples_around_the_eye(c, 1, true); }

void huge_and_tiny_at_samples(Check& c) {
  for_each_number(
      [&](int samples) { huge_and_tiny_triangles(c, scene_with(samples, 70, 66), 150, Random(67)); });
}

void sizes_of_samples(Check& c) {
  for_each_number([&](int samples) {
    for (const auto& [width, height] : {std::pair{1, 1}, {17, 9}, {1, 130}, {65, 63}})
      triangles_of_a_size(c, scene_with(samples, width, height), 60, Random(71));
  });
}

// Triangles of all kinds, whose corners may lie on places of samples or around the eye.
void coverage(Check& c, Random& random) {
  const int samples = numbers[random.next() % std::size(numbers)];
  const int width = 1 + int(random.next() % 140), height = 1 + int(random.next() % 140);
  const std::vector<dvec2> at = sample_places(samples);
  RasterInput input = scene_with(samples, width, height, random.next() % 2);
  const uint64_t triangles = 1 + random.next() % 200;
  for (uint64_t i = 0; i < triangles; ++i) {
    const uint64_t kind = random.next() % 5;
    const double reach = std::exp2(random.uniform(-8, kind == 0 ? 20.0f : 6.0f)),
                 x = random.uniform() * width, y = random.uniform() * height, d = random.uniform(0.5f, 9);
    const auto corner = [&] {
      if (kind == 1) {
        const float ex = random.uniform(-5, 5), ey = random.uniform(-5, 5), ez = random.uniform(-5, 5);
        return glm::vec3(ex, ey, ez);
      }
      double px = x + reach * random.uniform(-1, 1), py = y + reach * random.uniform(-1, 1);
      const dvec2& p = at[size_t(random.next() % at.size())];
      if (kind >= 3) {
        px = std::floor(px) + 0.5 + p.x;
        py = std::floor(py) + 0.5 + p.y;
      }
      return raster_position(input, px, py, kind == 4 ? d : double(random.uniform(0.5f, 9)));
    };
    add_raster_triangle(input, corner);
  }
  input.instances.resize(1 + random.next() % 2);
  raster(c, input);
}

// The point that the view shows at a place in pixels, of this depth. Not of oblique near planes.
dvec3 position_at(const View& view, double px, double py, double depth) {
  const double z = lab::position_from_depth(view, int(px), int(py), depth).z;
  const double d = view.orthographic ? 1 : -z;
  return {view_x_of_pixel(view, px) * d, view_y_of_pixel(view, py) * d, z};
}

// Lights that barely reach a random scene: each is listed in the tile of every sample that it lights.
void edge_lists(Check& c, Random& random) {
  const int samples = numbers[random.next() % std::size(numbers)];
  Scene scene = empty_shadow_scene();
  const ShadowTriangles triangles = random.next() % 2 ? sliver_soup(random, 100) : coplanar_soup(random, 30);
  add_triangles(scene, triangles);
  if (random.next() % 2) add_triangles(scene, quad_of({-4, -2.25f, 4}, {8, 0, 0}, {0, 0, -8}, 3, 2));
  for (int i = 0; i < 200; ++i) {
    const dvec3 on = on_triangle(random, triangles[size_t(random.next() % triangles.size())]);
    const double reach = std::exp2(random.uniform(-8, 2)), past = 1 + std::exp2(random.uniform(-20, -1));
    add_lamp(scene, on + any_direction(random) * reach, float(reach * past)).casts_shadow = false;
  }
  const dvec3 eye = in_cube(random, 4), target = in_cube(random, 1);
  const View view = shadow_view(eye, target, 1 + int(random.next() % 120), 1 + int(random.next() % 90),
                                random.uniform(0.1f, 2));
  Settings settings;
  settings.set(setting::samples, samples);
  settings.set(setting::tile, 8 << random.next() % 3);
  const CullTestRow& row = cull_tests[random.next() % std::size(cull_tests)];
  settings.set(setting::cull_test, row.test);
  settings.set(setting::depth_bounds, depth_bounds_modes[random.next() % std::size(depth_bounds_modes)].mode);
  settings.set(setting::kernel_shape, random.next() % 2 ? KernelShape::lanes : KernelShape::group);
  const std::vector<ListImage> images = c.engine.lists(scene, "visibility", {&view, 1}, settings);
  if (images.empty()) return c.skip("the engine draws no samples");
  const std::vector<ViewLight> lights = lights_in_view(scene, view);
  const ListedLights& lists = images[0].lists;
  const std::vector<dvec2> at = sample_places(samples);
  const int across = (view.width + settings[setting::tile] - 1) / settings[setting::tile];
  for (size_t i = 0; i < images[0].of_samples.size(); ++i) {
    const double depth = images[0].of_samples[i];
    if (!(depth > 0)) continue;
    const int pixel = int(i) / samples, x = pixel % view.width, y = pixel / view.width;
    const dvec2& p = at[i % size_t(samples)];
    const dvec3 position = position_at(view, x + 0.5 + p.x, y + 0.5 + p.y, depth);
    const size_t cell =
        size_t(y / settings[setting::tile]) * size_t(across) + size_t(x / settings[setting::tile]);
    const auto first = lists.indices.begin() + std::ptrdiff_t(lists.first.at(cell));
    for (uint32_t light = 0; light < lights.size(); ++light) {
      if (!is_lit(lights[light], position)) continue;
      c.trials(1);
      c.contacts(1);
      if (std::find(first, first + lists.count[cell], light) == first + lists.count[cell])
        c.lost("samples={}, tile={}, {}: light {} reaches sample {} of pixel {} {}", samples,
               settings[setting::tile], row.name, light, i % size_t(samples), x, y);
    }
  }
}

}  // namespace

std::vector<RandomCase> random_sample_cases() { return {{"coverage", coverage}, {"edge_lists", edge_lists}}; }

std::vector<CaseRun> sample_cases() {
  return CASES(one_sample_alone, edges_at_samples, on_sample_places, fan_around_a_sample,
               bars_between_samples, crossing_planes, beside_borders, equal_at_samples,
               around_the_eye_at_samples, w_zero_at_samples, huge_and_tiny_at_samples, sizes_of_samples);
}

}  // namespace lightgrid::lab::verify
