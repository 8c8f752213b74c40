// The standard frames: depth of a room, by a ray a pixel, and lights whose radii are scaled until tiles list
// the requested number.
#include "bench/standard_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/parallel.h"
#include "scene/random.h"

namespace lightgrid::lab {
namespace {

// Metres. The camera is at the origin and looks along -z, 60 degrees high.
constexpr float room_near = 0.5f, room_far = 100.0f, room_floor = -5.0f, room_back = 95.0f;
constexpr float room_tan_y = 0.57735027f;
constexpr int boxes = 48, balls = 600;
constexpr int block = 32;  // pixels a side; a block tests only the shapes whose outline reaches it
constexpr float floor_slope = 0.04f, ceiling_height = 22.0f;

// A box, or its inscribed sphere. Entirely in front of the eye.
struct Shape {
  glm::vec3 low, high;
};

std::vector<Shape> make_boxes(Random& random) {
  std::vector<Shape> shapes;
  for (int i = 0; i < boxes; ++i) {
    const float x = random.uniform(-55, 55), z = -random.uniform(8, 92);
    const float half_x = random.uniform(0.7f, 3), height = random.uniform(1, 9),
                half_z = random.uniform(0.7f, 3);
    shapes.push_back({{x - half_x, room_floor, z - half_z}, {x + half_x, room_floor + height, z + half_z}});
  }
  return shapes;
}

std::vector<Shape> make_balls(Random& random, float tan_x) {
  std::vector<Shape> shapes;
  for (int i = 0; i < balls; ++i) {
    const float d = random.uniform(2, 90);
    const float x = random.uniform(-1, 1) * d * tan_x, y = random.uniform(-1, 1) * d * room_tan_y;
    const glm::vec3 centre(x, y, -d), half(random.uniform(0.1f, 0.8f));
    shapes.push_back({centre - half, centre + half});
  }
  return shapes;
}

// Range of direction slopes (x / d, y / d) that the shape may cover.
struct Outline {
  float x0, x1, y0, y1;
};

Outline outline_of(const Shape& s) {
  const float near = -s.high.z, far = -s.low.z;
  return {std::min(s.low.x / near, s.low.x / far), std::max(s.high.x / near, s.high.x / far),
          std::min(s.low.y / near, s.low.y / far), std::max(s.high.y / near, s.high.y / far)};
}

// The distance at which the ray (x, y, -1) enters the shape, or `nearest` if it does not do so before.
float enter_box(const Shape& s, float x, float y, float nearest) {
  float t0 = -s.high.z, t1 = std::min(nearest, -s.low.z);
  for (const auto& [low, high, slope] :
       {std::tuple(s.low.x, s.high.x, x), std::tuple(s.low.y, s.high.y, y)}) {
    if (slope == 0 && (low > 0 || high < 0)) return nearest;
    if (slope == 0) continue;
    const float a = low / slope, b = high / slope;
    t0 = std::max(t0, std::min(a, b));
    t1 = std::min(t1, std::max(a, b));
  }
  return t0 <= t1 ? t0 : nearest;
}

float enter_ball(const Shape& s, float x, float y, float nearest) {
  const glm::vec3 centre = 0.5f * (s.low + s.high), ray(x, y, -1);
  const float radius = 0.5f * (s.high.x - s.low.x), a = glm::dot(ray, ray), b = glm::dot(ray, centre);
  const float q = b * b - a * (glm::dot(centre, centre) - radius * radius);
  if (q < 0) return nearest;
  const float t = (b - std::sqrt(q)) / a;
  return t > room_near ? std::min(t, nearest) : nearest;
}

float room_distance(float y) {
  float t = room_back;
  if (y < floor_slope) t = std::min(t, -room_floor / (floor_slope - y));
  if (y > 0) t = std::min(t, ceiling_height / y);
  return t;
}

// The distance along the view axis of the surface at each pixel; row 0 at the bottom.
std::vector<float> room_distances(const FrameRecipe& recipe) {
  const int width = recipe.width, height = recipe.height;
  const float tan_x = room_tan_y * float(width) / float(height);
  Random random(1);
  const std::vector<Shape> shapes = recipe.spheres ? make_balls(random, tan_x) : make_boxes(random);
  std::vector<Outline> outlines;
  for (const Shape& s : shapes) outlines.push_back(outline_of(s));
  const auto slope_x = [&](float px) { return (2 * px / float(width) - 1) * tan_x; };
  const auto slope_y = [&](float py) { return (2 * py / float(height) - 1) * room_tan_y; };
  std::vector<float> distances(size_t(width) * height);
  parallel_for((height + block - 1) / block, [&](int row) {
    const int y0 = row * block, y1 = std::min(y0 + block, height);
    for (int x0 = 0; x0 < width; x0 += block) {
      const int x1 = std::min(x0 + block, width);
      std::vector<const Shape*> near_shapes;
      for (size_t i = 0; i < shapes.size(); ++i) {
        const Outline& o = outlines[i];
        if (o.x1 >= slope_x(x0) && o.x0 <= slope_x(x1) && o.y1 >= slope_y(y0) && o.y0 <= slope_y(y1)) {
          near_shapes.push_back(&shapes[i]);
        }
      }
      for (int y = y0; y < y1; ++y) {
        for (int x = x0; x < x1; ++x) {
          const float sx = slope_x(x + 0.5f), sy = slope_y(y + 0.5f);
          float t = room_distance(sy);
          for (const Shape* s : near_shapes)
            t = recipe.spheres ? enter_ball(*s, sx, sy, t) : enter_box(*s, sx, sy, t);
          distances[size_t(y) * width + x] = t;
        }
      }
    }
  });
  return distances;
}

constexpr int calibration_tile = 16, calibration_width = 1920, calibration_height = 1080;

View room_view(int width, int height) {
  View view;
  view.width = width;
  view.height = height;
  view.near_m = room_near;
  view.far_m = room_far;
  const double near = room_near, far = room_far, tan_y = room_tan_y, tan_x = tan_y * width / height;
  view.clip_from_view = glm::dmat4(0);  // [column][row]; reversed depth
  view.clip_from_view[0][0] = 1 / tan_x;
  view.clip_from_view[1][1] = 1 / tan_y;
  view.clip_from_view[2][2] = near / (far - near);
  view.clip_from_view[3][2] = far * near / (far - near);
  view.clip_from_view[2][3] = -1;
  return view;
}

// Slopes x / d of the borders between tiles, and 1 / length of each border plane's normal (1, 0, -slope).
struct Borders {
  std::vector<float> slope, scale;
};

Borders borders(int pixels, float tangent) {
  Borders b;
  for (int p = 0; p < pixels + calibration_tile; p += calibration_tile) {
    const float s = (2.0f * float(p) / float(pixels) - 1) * tangent;
    b.slope.push_back(s);
    b.scale.push_back(1 / std::sqrt(1 + s * s));
  }
  return b;
}

struct TileGrid {
  Borders x, y;
  std::vector<float> near, far;  // depths of each tile, x fastest
  int tiles_x() const { return int(x.slope.size()) - 1; }
};

TileGrid tile_grid(const std::vector<float>& distances, int width, int height) {
  TileGrid grid{
      borders(width, room_tan_y * float(width) / float(height)), borders(height, room_tan_y), {}, {}};
  const int tiles_x = grid.tiles_x();
  grid.near.assign(size_t(tiles_x) * (grid.y.slope.size() - 1), 1e9f);
  grid.far.assign(grid.near.size(), 0);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const size_t tile = size_t(y / calibration_tile) * tiles_x + x / calibration_tile;
      const float d = distances[size_t(y) * width + x];
      grid.near[tile] = std::min(grid.near[tile], d);
      grid.far[tile] = std::max(grid.far[tile], d);
    }
  }
  return grid;
}

// The strips between borders for which the sphere passes both plane tests.
std::vector<int> touched_strips(const Borders& b, float across, float d, float radius) {
  std::vector<int> strips;
  for (size_t i = 0; i + 1 < b.slope.size(); ++i) {
    const bool inside = (across - b.slope[i] * d) * b.scale[i] >= -radius &&
                        (b.slope[i + 1] * d - across) * b.scale[i + 1] >= -radius;
    if (inside) strips.push_back(int(i));
  }
  return strips;
}

// Number of tiles that list the light by side planes and least and greatest depth.
size_t tiles_listing(const TileGrid& grid, const Light& light, float radius) {
  const float d = float(-light.position.z);
  const std::vector<int> columns = touched_strips(grid.x, float(light.position.x), d, radius);
  const std::vector<int> rows = touched_strips(grid.y, float(light.position.y), d, radius);
  size_t count = 0;
  for (const int row : rows) {
    for (const int column : columns) {
      const size_t tile = size_t(row) * grid.tiles_x() + column;
      count += d + radius >= grid.near[tile] && d - radius <= grid.far[tile];
    }
  }
  return count;
}

double mean_listed(const TileGrid& grid, const std::vector<Light>& lights, const std::vector<float>& radii,
                   float scale) {
  constexpr int chunk = 1024;
  const int chunks = int((lights.size() + chunk - 1) / chunk);
  std::vector<size_t> listed(chunks, 0);
  parallel_for(chunks, [&](int c) {
    const size_t end = std::min(lights.size(), size_t(c + 1) * chunk);
    for (size_t i = size_t(c) * chunk; i < end; ++i)
      listed[c] += tiles_listing(grid, lights[i], scale * radii[i]);
  });
  return double(std::accumulate(listed.begin(), listed.end(), size_t(0))) / double(grid.near.size());
}

std::vector<Light> scatter_in_view(int count, Random& random, std::vector<float>& radii) {
  const float tan_x = room_tan_y * float(calibration_width) / float(calibration_height);
  std::vector<Light> lights(count);
  for (Light& light : lights) {
    const float d = random.uniform(2, room_back), half = std::min(d * tan_x * 1.05f, 70.0f);
    const float x = random.uniform(-half, half),
                y = random.uniform(room_floor, std::min(20.0f, d * room_tan_y));
    // Whole millimetres are short in a file: a million lights stay below the size limit of a lights file.
    light.position = glm::round(glm::dvec3(x, y, -d) * 1000.0) / 1000.0;
    radii.push_back(random.uniform(0.6f, 1.4f));
  }
  return lights;
}

}  // namespace

CapturedFrame make_standard_frame(const FrameRecipe& recipe) {
  FrameRecipe calibration = recipe;
  calibration.width = calibration_width;
  calibration.height = calibration_height;
  const std::vector<float> distances = room_distances(calibration);
  const TileGrid grid = tile_grid(distances, calibration.width, calibration.height);

  CapturedFrame frame;
  frame.name = recipe.spheres ? "spheres" : "floor";
  frame.view = room_view(recipe.width, recipe.height);
  Random random(2);
  std::vector<float> radii;
  frame.lights = scatter_in_view(recipe.lights, random, radii);
  const double wanted = std::min(recipe.mean_listed, 0.5 * recipe.lights);
  float low = 0.001f, high = 60.0f;
  for (int step = 0; step < 18; ++step) {
    const float scale = std::sqrt(low * high);
    (mean_listed(grid, frame.lights, radii, scale) > wanted ? high : low) = scale;
  }
  for (size_t i = 0; i < radii.size(); ++i) frame.lights[i].radius_m = low * radii[i];

  const bool same = recipe.width == calibration.width && recipe.height == calibration.height;
  frame.depth = same ? distances : room_distances(recipe);
  for (float& d : frame.depth) d = room_near * (room_far - d) / (d * (room_far - room_near));
  return frame;
}

std::vector<BenchCase> standard_cases() {
  std::vector<BenchCase> cases;
  for (const int lights : {256, 1024, 4096, 65536}) {
    cases.push_back({fmt::format("floor-{}", lights), {.lights = lights}});
  }
  cases.push_back({"spheres-1024", {.spheres = true, .lights = 1024}});
  cases.push_back({"floor-1000000", {.lights = 1'000'000, .mean_listed = 10}});
  for (int lights = 1; lights <= 1'000'000; lights *= 10) {
    cases.push_back({fmt::format("lights-{}", lights),
                     {.lights = lights, .mean_listed = lights < 1'000'000 ? 32.0 : 10.0}});
  }
  for (const int tile : {8, 16, 32, 64}) {
    cases.push_back({fmt::format("tile-{}", tile), {.lights = 4096}, {}, tile});
  }
  constexpr int sizes[][2] = {{640, 360},   {1280, 720},  {1920, 1080},
                              {2560, 1440}, {3840, 2160}, {7680, 4320}};
  for (const auto& [width, height] : sizes) {
    cases.push_back(
        {fmt::format("size-{}x{}", width, height), {.lights = 4096, .width = width, .height = height}});
  }
  for (const char* scene : {"hall", "terrain"}) {
    cases.push_back({fmt::format("raster-{}", scene), {.width = 1280, .height = 720}, {}, 0, scene});
  }
  return cases;
}

}  // namespace lightgrid::lab
