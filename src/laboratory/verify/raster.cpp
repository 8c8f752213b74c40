// Hard cases of rasterising. Each image is compared with the coverage oracle pixel by pixel, in both kernel
// shapes.
#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/random.h"
#include "verify/raster_check.h"

namespace lightgrid::verify {
namespace {

// Triangles over the whole image, vertices a little off a lattice, or on pixels' centres.
RasterInput raster_sheet(int cells, bool on_centres) {
  RasterInput input = raster_scene(150, 140);
  Random random(11);
  RasterInputMesh& mesh = input.meshes[0];
  for (int y = 0; y <= cells; ++y) {
    for (int x = 0; x <= cells; ++x) {
      double px =
          (double(x) / cells * 1.4 - 0.2 + random.uniform(-0.3f, 0.3f) / cells) * input.camera.grid.width;
      double py =
          (double(y) / cells * 1.4 - 0.2 + random.uniform(-0.3f, 0.3f) / cells) * input.camera.grid.height;
      if (on_centres) px = std::floor(px) + 0.5, py = std::floor(py) + 0.5;
      mesh.positions.push_back(
          raster_position(input, px, py, on_centres ? 1.0 : double(random.uniform(1, 1.1f))));
    }
  }
  for (int y = 0; y < cells; ++y) {
    for (int x = 0; x < cells; ++x) {
      const uint32_t a = uint32_t(y * (cells + 1) + x), b = a + 1, d = a + uint32_t(cells) + 1, e = d + 1;
      for (const uint32_t i : {a, b, e, a, e, d}) mesh.indices.push_back(i);
    }
  }
  return input;
}

// Each pixel is covered, and of 11 parts of the mesh, in which no two triangles touch, one covers it.
void covers_once(Check& c, const RasterInput& input) {
  const std::optional<RasterImage> whole = raster(c, input);
  if (!whole) return;
  c.that(std::ranges::count(whole->triangles, no_triangle) == 0, "a hole");
  constexpr size_t parts = 11;
  std::vector<int> claims(whole->triangles.size(), 0);
  for (size_t part = 0; part < parts; ++part) {
    RasterInput some = input;
    std::vector<uint32_t>& indices = some.meshes[0].indices;
    indices.clear();
    for (size_t i = 3 * part; i < input.meshes[0].indices.size(); i += 3 * parts) {
      indices.insert(indices.end(), &input.meshes[0].indices[i], &input.meshes[0].indices[i] + 3);
    }
    const RasterImage image = *c.engine.rasterize({}, some);
    for (size_t i = 0; i < claims.size(); ++i) claims[i] += image.triangles[i] != no_triangle;
  }
  c.that(std::ranges::count(claims, 1) == std::ptrdiff_t(claims.size()),
         "a pixel belongs to no triangle or to two");
}
void shared_edges(Check& c) { covers_once(c, raster_sheet(23, false)); }
void on_pixel_centres(Check& c) { covers_once(c, raster_sheet(23, true)); }

// A thousand triangles around a pixel's centre, their other corners `radius` pixels off.
void fan(Check& c, double radius) {
  RasterInput input = raster_scene(131, 127);
  RasterInputMesh& mesh = input.meshes[0];
  constexpr int count = 1000;
  mesh.positions.push_back(raster_position(input, 65.5, 60.5, 2));
  for (int i = 0; i < count; ++i) {
    const double angle = i * 6.283185307179586 / count;
    mesh.positions.push_back(
        raster_position(input, 65.5 + radius * std::cos(angle), 60.5 + radius * std::sin(angle), 3));
    for (const int k : {0, 1 + i, 1 + (i + 1) % count}) mesh.indices.push_back(uint32_t(k));
  }
  const std::optional<RasterImage> image = raster(c, input);
  if (image) c.that(std::ranges::count(image->triangles, no_triangle) == 0, "a hole");
}
void fan_of_slivers(Check& c) { fan(c, 300); }

// Random triangles within `reach` metres of the eye, on all sides.
void around_the_eye(Check& c, int count, float reach, bool whole_numbers) {
  RasterInput input = raster_scene(90, 70, true);
  Random random(17);
  const auto number = [&] {
    return whole_numbers ? std::floor(random.uniform(-1, 2)) : random.uniform(-reach, reach);
  };
  const auto corner = [&] {
    const float x = number(), y = number(), z = number();
    return glm::vec3(x, y, z);
  };
  for (int i = 0; i < count; ++i) add_raster_triangle(input, corner);
  raster(c, input);
}
void behind_the_eye(Check& c) { around_the_eye(c, 200, 5, false); }
void at_w_zero(Check& c) { around_the_eye(c, 200, 1, true); }

void huge_and_tiny(Check& c) {
  RasterInput input = raster_scene(100, 80, true);
  Random random(19);
  for (int i = 0; i < 300; ++i) {
    const double reach = std::exp2(random.uniform(-10, 24)), x = random.uniform(0, 100),
                 y = random.uniform(0, 80);
    const auto corner = [&] {
      const double px = x + reach * random.uniform(-1, 1), py = y + reach * random.uniform(-1, 1);
      return raster_position(input, px, py, std::exp2(random.uniform(-3, 10)));
    };
    add_raster_triangle(input, corner);
  }
  raster(c, input);
  for (const double radius : {1e4, 1e6}) fan(c, radius);
}

void not_finite(Check& c) {
  constexpr float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  constexpr float most = std::numeric_limits<float>::max();
  RasterInput input = raster_scene(50, 40, true);
  for (const float strange : {inf, -inf, nan, most, -most, 1e-40f}) {
    for (int i = 0; i < 9; ++i) {
      glm::vec3 corners[3] = {raster_position(input, 5, 4, 3), raster_position(input, 45, 8, 4),
                              raster_position(input, 20, 35, 5)};
      corners[i / 3][i % 3] = strange;
      add_raster_triangle(input, corners[0], corners[1], corners[2]);
    }
  }
  raster(c, input);
}

// One mesh three times in one place: of its copies the last is shown.
void equal_depths(Check& c) {
  RasterInput input = raster_scene(150, 80);
  Random random(23);
  const auto corner = [&] {
    const float x = random.uniform(-20, 170), y = random.uniform(-20, 100), d = random.uniform(1, 4);
    return raster_position(input, x, y, d);
  };
  for (int i = 0; i < 40; ++i) add_raster_triangle(input, corner);
  const std::optional<RasterImage> once = raster(c, input);
  input.instances.resize(3);
  const std::optional<RasterImage> thrice = raster(c, input);
  if (!once) return;
  std::vector<uint32_t> of_the_last = once->triangles;
  for (uint32_t& triangle : of_the_last) triangle += triangle == no_triangle ? 0 : 80;
  c.that(thrice->triangles == of_the_last && once->depths == thrice->depths,
         "an earlier one of equal depth is shown");
}

void mirrored_and_two_sided(Check& c) {
  RasterInput input = raster_scene(120, 90);
  Random random(29);
  const auto corner = [&] {
    const float x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
    return glm::vec3(x, y, z);
  };
  for (int i = 0; i < 60; ++i) add_raster_triangle(input, corner);
  input.instances.clear();
  for (int i = 0; i < 8; ++i) {
    RasterInstance instance{.two_sided = i % 4 == 3};
    for (int axis = 0; axis < 3; ++axis) instance.world_from_object[axis][axis] = i >> axis & 1 ? -0.7 : 1.3;
    instance.world_from_object[3] = glm::dvec4(i % 3 - 1, i % 2 - 0.5, -2.5 - i * 0.3, 1);
    input.instances.push_back(instance);
  }
  raster(c, input);
}

void of_a_size(Check& c, int width, int height, int count) {
  RasterInput input = raster_scene(width, height, true);
  Random random(31);
  const auto corner = [&] {
    const float x = random.uniform(-0.5f, 1.5f), y = random.uniform(-0.5f, 1.5f), d = random.uniform(1, 3);
    return raster_position(input, x * width, y * height, d);
  };
  for (int i = 0; i < count; ++i) add_raster_triangle(input, corner);
  raster(c, input);
}

void awkward_sizes(Check& c) {
  for (const auto& [width, height] : {std::pair{1, 1}, {17, 9}, {1, 200}, {65, 63}})
    of_a_size(c, width, height, 100);
  of_a_size(c, 1279, 721, 12);
}

// Far more triangles than any first guess of room holds, after a frame of few.
void more_than_expected(Check& c) {
  of_a_size(c, 300, 200, 3);
  RasterInput input = raster_scene(300, 200);
  Random random(37);
  for (int i = 0; i < 20000; ++i) {
    const float x = random.uniform(0, 300), y = random.uniform(0, 200), d = random.uniform(1, 3);
    add_raster_triangle(input, raster_position(input, x, y, d), raster_position(input, x + 4, y, d),
                        raster_position(input, x, y + 5, d));
  }
  raster(c, input);
}

}  // namespace

std::vector<CaseRun> raster_cases() {
  return CASES(shared_edges, on_pixel_centres, fan_of_slivers, behind_the_eye, at_w_zero, huge_and_tiny,
               not_finite, equal_depths, mirrored_and_two_sided, awkward_sizes, more_than_expected);
}

}  // namespace lightgrid::verify
