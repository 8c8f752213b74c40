#include "bench/standard_scene.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace lightgrid {
namespace {

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
    t0 = std::max(t0, std::min(a, b)), t1 = std::min(t1, std::max(a, b));
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

}  // namespace

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

}  // namespace lightgrid
