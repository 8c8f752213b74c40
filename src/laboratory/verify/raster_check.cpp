#include "verify/raster_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "base/facing.h"
#include "oracle/coverage.h"

namespace lightgrid::lab::verify {
namespace {

// From the centre, 1/16 pixel, y down: as Vulkan 1.3 lists its standard sample locations, (x - 0.5, y - 0.5)
// * 16.
const std::map<int, std::vector<std::array<int, 2>>>& listed_places() {
  static const std::map<int, std::vector<std::array<int, 2>>> all = {
      {1, {{0, 0}}},
      {2, {{4, 4}, {-4, -4}}},
      {4, {{-2, -6}, {6, -2}, {-6, 2}, {2, 6}}},
      {8, {{1, -3}, {-1, 3}, {5, 1}, {-3, -5}, {-5, 5}, {-7, -1}, {3, 7}, {7, -7}}}};
  return all;
}

CoverageOracle raster_oracle(const RasterInput& input, const RasterImage& image, std::array<int, 2> place) {
  CoverageOracle oracle(input.camera.grid, {128 + 16 * place[0], 128 - 16 * place[1]});
  for (size_t i = 0; i < input.instances.size(); ++i) {
    const RasterInstance& instance = input.instances[i];
    const std::vector<uint32_t>& indices = input.meshes[instance.mesh].indices;
    const std::vector<glm::vec4>& clip = image.clip[i];
    const bool mirrored = is_mirroring(glm::dmat3(instance.world_from_object));
    for (size_t k = 0; k < indices.size(); k += 3) {
      oracle.add(
          {{clip[indices[k]], clip[indices[k + 1]], clip[indices[k + 2]]}, instance.two_sided, mirrored});
    }
  }
  return oracle;
}

// One trial and one contact a sample; a hole is a lost one.
void compare_raster(Check& c, const RasterInput& input, const RasterImage& image) {
  const PixelGrid& grid = input.camera.grid;
  const std::vector<std::array<int, 2>>& places = listed_places().at(grid.samples);
  for (int s = 0; s < grid.samples; ++s) {
    const CoverageOracle oracle = raster_oracle(input, image, places[size_t(s)]);
    for (int y = 0; y < grid.height; ++y) {
      for (int x = 0; x < grid.width; ++x) {
        const size_t i = grid.index(x, y, s);
        const std::string why = wrong_at(oracle.at(x, y), image.triangles[i], image.depths[i]);
        c.trials(1);
        c.contacts(!oracle.at(x, y).empty());
        if (why.empty()) continue;
        if (image.triangles[i] == no_triangle)
          c.lost("pixel {} {}, sample {}: {}", x, y, s, why);
        else
          c.fail(fmt::format("pixel {} {}, sample {}: {}", x, y, s, why));
      }
    }
    c.that(image.invalid_triangles == oracle.invalid_triangles(), "{} triangles are called invalid, {} are",
           image.invalid_triangles, oracle.invalid_triangles());
  }
}

// Vertices slightly next to a lattice, or on samples' places.
void add_sheet(RasterInput& input, int cells, bool on_places, Random& random) {
  const PixelGrid& grid = input.camera.grid;
  const std::vector<glm::dvec2> places = sample_places(grid.samples);
  RasterInputMesh& mesh = input.meshes[0];
  for (int y = 0; y <= cells; ++y) {
    for (int x = 0; x <= cells; ++x) {
      double px = (double(x) / cells * 1.4 - 0.2 + random.uniform(-0.3f, 0.3f) / cells) * grid.width;
      double py = (double(y) / cells * 1.4 - 0.2 + random.uniform(-0.3f, 0.3f) / cells) * grid.height;
      const glm::dvec2& p = places[grid.samples == 1 ? 0 : random.next() % uint64_t(grid.samples)];
      if (on_places) {
        px = std::floor(px) + 0.5 + p.x;
        py = std::floor(py) + 0.5 + p.y;
      }
      mesh.positions.push_back(
          raster_position(input, px, py, on_places ? 1.0 : double(random.uniform(1, 1.1f))));
    }
  }
  for (int y = 0; y < cells; ++y) {
    for (int x = 0; x < cells; ++x) {
      const uint32_t a = uint32_t(y * (cells + 1) + x), b = a + 1, d = a + uint32_t(cells) + 1, e = d + 1;
      for (const uint32_t i : {a, b, e, a, e, d}) mesh.indices.push_back(i);
    }
  }
}

}  // namespace

std::vector<glm::dvec2> sample_places(int samples) {
  std::vector<glm::dvec2> places;
  for (const auto& [x, y] : listed_places().at(samples)) places.emplace_back(x / 16.0, -y / 16.0);
  return places;
}

std::optional<RasterImage> raster(Check& c, const RasterInput& input) {
  std::optional<RasterImage> first;
  for (const RasterOptions& options :
       {RasterOptions{.shape = KernelShape::lanes}, RasterOptions{.shape = KernelShape::group},
        RasterOptions{.shape = KernelShape::group, .wide_atomics = false}}) {
    std::optional<RasterImage> image = c.engine.rasterize(options, input);
    if (!image) {
      c.skip("the engine does not rasterise");
      return {};
    }
    if (!first) {
      compare_raster(c, input, *image);
      first = std::move(image);
    } else {
      c.that(image->triangles == first->triangles && image->depths == first->depths,
             "the kernel shapes' images differ");
    }
    if (!c.engine.has_both_shapes()) break;
  }
  return first;
}

void covers_once(Check& c, RasterInput input, int cells, bool on_places, Random random) {
  add_sheet(input, cells, on_places, random);
  const int samples = input.camera.grid.samples;
  const std::optional<RasterImage> whole = raster(c, input);
  if (!whole) return;
  c.that(std::ranges::count(whole->triangles, no_triangle) == 0, "a hole with {} samples", samples);
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
         "a sample of {} belongs to no triangle or to two", samples);
}

void fan(Check& c, RasterInput input, double x, double y, double radius) {
  RasterInputMesh& mesh = input.meshes[0];
  constexpr int count = 1000;
  mesh.positions.push_back(raster_position(input, x, y, 2));
  for (int i = 0; i < count; ++i) {
    const double angle = i * 6.283185307179586 / count;
    mesh.positions.push_back(
        raster_position(input, x + radius * std::cos(angle), y + radius * std::sin(angle), 3));
    for (const int k : {0, 1 + i, 1 + (i + 1) % count}) mesh.indices.push_back(uint32_t(k));
  }
  const std::optional<RasterImage> image = raster(c, input);
  if (image) c.that(std::ranges::count(image->triangles, no_triangle) == 0, "a hole");
}

void around_the_eye(Check& c, RasterInput input, int count, float reach, bool whole_numbers, Random random) {
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

void huge_and_tiny_triangles(Check& c, RasterInput input, int count, Random random) {
  const auto width = float(input.camera.grid.width), height = float(input.camera.grid.height);
  for (int i = 0; i < count; ++i) {
    const double reach = std::exp2(random.uniform(-10, 24)), x = random.uniform(0, width),
                 y = random.uniform(0, height);
    const auto corner = [&] {
      const double px = x + reach * random.uniform(-1, 1), py = y + reach * random.uniform(-1, 1);
      return raster_position(input, px, py, std::exp2(random.uniform(-3, 10)));
    };
    add_raster_triangle(input, corner);
  }
  raster(c, input);
}

void equal_depths_of_copies(Check& c, RasterInput input, Random random) {
  const auto right = float(input.camera.grid.width + 20), top = float(input.camera.grid.height + 20);
  const auto corner = [&] {
    const float x = random.uniform(-20, right), y = random.uniform(-20, top), d = random.uniform(1, 4);
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

void triangles_of_a_size(Check& c, RasterInput input, int count, Random random) {
  const int width = input.camera.grid.width, height = input.camera.grid.height;
  const auto corner = [&] {
    const float x = random.uniform(-0.5f, 1.5f), y = random.uniform(-0.5f, 1.5f), d = random.uniform(1, 3);
    return raster_position(input, x * width, y * height, d);
  };
  for (int i = 0; i < count; ++i) add_raster_triangle(input, corner);
  raster(c, input);
}

}  // namespace lightgrid::lab::verify
