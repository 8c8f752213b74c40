// The standard frames: depth of a room, and lights whose radii are scaled until tiles list the requested
// number.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/parallel.h"
#include "bench/standard_frames.h"
#include "bench/standard_scene.h"

namespace lightgrid {
namespace {

constexpr int calibration_tile = 16, calibration_width = 1920, calibration_height = 1080;

View room_view(int width, int height) {
  View view;
  view.width = width, view.height = height;
  view.near_m = room_near, view.far_m = room_far;
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
    b.slope.push_back(s), b.scale.push_back(1 / std::sqrt(1 + s * s));
  }
  return b;
}

struct TileGrid {
  Borders x, y;
  std::vector<float> near, far;  // of each tile, x fastest
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
      grid.near[tile] = std::min(grid.near[tile], d), grid.far[tile] = std::max(grid.far[tile], d);
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
  calibration.width = calibration_width, calibration.height = calibration_height;
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

}  // namespace lightgrid
