// Tables, chairs, parasols, lantern posts and the fountain of the square.
#include <algorithm>
#include <cmath>

#include "scenes/shapes.h"
#include "scenes/square_parts.h"

namespace lightgrid::square {
namespace {

using namespace shapes;

// All legs bend out a little below.
void add_leg(Mesh& mesh, glm::vec3 top, glm::vec3 foot, float radius_m, bool fine) {
  const glm::vec3 bend = glm::mix(top, foot, 0.7f) + glm::vec3(0, 0.01f, 0);
  const glm::vec3 bent[] = {top, glm::mix(top, bend, 0.5f), bend, glm::mix(bend, foot, 0.6f), foot};
  const glm::vec3 straight[] = {top, foot};
  add_tube(mesh, fine ? std::span<const glm::vec3>(bent) : straight, radius_m, fine ? 8 : 4);
}

void add_disc(Mesh& mesh, float y, float radius_m, float thick_m, int sides) {
  const glm::vec2 profile[] = {
      {0, y - thick_m},       {radius_m, y - thick_m}, {radius_m, y - thick_m}, {radius_m, y - 0.008f},
      {radius_m, y - 0.008f}, {radius_m - 0.008f, y},  {radius_m - 0.008f, y},  {0, y}};
  add_lathe(mesh, glm::vec3(0), profile, sides);
}

}  // namespace

void add_tube(Mesh& mesh, std::span<const glm::vec3> line, float radius_m, int sides) {
  const int count = int(line.size());
  std::vector<SurfacePoint> points;
  float length = 0;
  glm::vec3 right(0);
  for (int i = 0; i < count; ++i) {
    if (i) length += glm::distance(line[i], line[i - 1]);
    const glm::vec3 along = glm::normalize(line[std::min(i + 1, count - 1)] - line[std::max(i - 1, 0)]);
    if (i == 0) right = std::abs(along.y) > 0.7f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
    right = glm::normalize(right - along * glm::dot(right, along));  // carried along: the tube does not twist
    const glm::vec3 up = glm::cross(along, right);
    for (int side = 0; side <= sides; ++side) {
      const double turn = 2 * glm::pi<double>() * (side % sides) / sides;
      const float c = float(std::cos(turn)), s = float(std::sin(turn));
      const glm::vec3 out = right * c + up * s;
      points.push_back({line[i] + out * radius_m,
                        out,
                        up * c - right * s,
                        {float(side) / sides * 2 * glm::pi<float>() * radius_m, -length}});
    }
  }
  add_grid(mesh, sides, count - 1, points);
}

Mesh table(const Materials& m, bool fine) {
  Mesh mesh;
  add_disc(mesh, table_m, 0.34f, 0.03f, fine ? 40 : 10);
  const glm::vec2 stem[] = {{0.05f, 0.12f}, {0.028f, 0.2f}, {0.028f, 0.5f}, {0.04f, 0.6f}, {0.1f, 0.71f}};
  const glm::vec2 plain[] = {{0.03f, 0.12f}, {0.03f, 0.71f}};
  add_lathe(mesh, glm::vec3(0), fine ? std::span<const glm::vec2>(stem) : plain, fine ? 16 : 11);
  for (int i = 0; i < 3; ++i) {
    const double turn = 2 * glm::pi<double>() * i / 3;
    const glm::vec3 out(float(std::cos(turn)), 0, float(std::sin(turn)));
    add_leg(mesh, glm::vec3(0, 0.2f, 0) + out * 0.02f, glm::vec3(0, 0.015f, 0) + out * 0.3f, 0.02f, fine);
  }
  return finished(std::move(mesh), "table", m.zinc);
}

Mesh crockery(const Materials& m) {
  Mesh mesh;
  const glm::vec2 saucer[] = {{0, 0.004f},      {0.04f, 0.004f}, {0.075f, 0.016f},
                              {0.075f, 0.016f}, {0.04f, 0.01f},  {0, 0.01f}};
  const glm::vec2 cup[] = {{0.025f, 0.01f},  {0.036f, 0.03f},  {0.042f, 0.075f}, {0.042f, 0.075f},
                           {0.038f, 0.075f}, {0.038f, 0.075f}, {0.03f, 0.03f},   {0, 0.018f}};
  const glm::vec2 bottle[] = {{0.036f, 0},     {0.038f, 0.02f}, {0.038f, 0.18f}, {0.03f, 0.215f},
                              {0.014f, 0.24f}, {0.013f, 0.3f},  {0.013f, 0.3f},  {0, 0.3f}};
  for (const glm::vec3 at : {glm::vec3(0.16f, 0, 0.05f), glm::vec3(-0.14f, 0, -0.1f)}) {
    add_lathe(mesh, at, saucer, 20);
    add_lathe(mesh, at, cup, 20);
  }
  add_lathe(mesh, {-0.05f, 0, 0.17f}, bottle, 18);
  return finished(std::move(mesh), "crockery", m.china);
}

Mesh chair(const Materials& m, bool fine) {
  Mesh mesh;
  const float seat = 0.45f;
  add_disc(mesh, seat, 0.21f, 0.035f, fine ? 28 : 8);
  for (const float x : {-1.f, 1.f}) {
    for (const float z : {-1.f, 1.f})
      add_leg(mesh, {x * 0.15f, seat - 0.02f, z * 0.15f}, {x * 0.2f, 0, z * 0.2f}, 0.013f, fine);
  }
  // The back: a hoop at -z, and one within it.
  for (const float scale : {1.f, 0.62f}) {
    if (!fine && scale < 1) continue;
    const std::vector<glm::vec3> hoop =
        arc({0, seat + 0.2f, -0.19f}, {0.19f * scale, 0, 0}, {0, 0.26f * scale, -0.05f}, -0.6f,
            glm::pi<float>() + 0.6f, fine ? 16 : 11);
    add_tube(mesh, hoop, 0.012f, fine ? 8 : 4);
  }
  if (fine) {
    for (const float y : {0.16f, 0.24f}) {
      const std::vector<glm::vec3> ring =
          arc({0, y, 0}, {0.19f, 0, 0}, {0, 0, -0.19f}, 0, 2 * glm::pi<float>(), 20);
      add_tube(mesh, ring, 0.008f, 6);
    }
  }
  return finished(std::move(mesh), "chair", m.rattan);
}

Mesh parasol_canopy(const Materials& m, int canvas) {
  Mesh mesh;
  const glm::vec2 top[] = {{1.5f, 2.12f}, {1.5f, 2.32f}, {1.5f, 2.32f}, {1.2f, 2.42f},
                           {0.9f, 2.53f}, {0.6f, 2.66f}, {0.3f, 2.8f},  {0.03f, 2.93f}};
  add_lathe(mesh, glm::vec3(0), top, 24);
  return finished(std::move(mesh), "parasol", m.canvas[canvas]);
}

Mesh parasol_pole(const street::Materials& m) {
  Mesh mesh;
  const glm::vec2 pole[] = {{0.3f, 0},     {0.3f, 0.06f},   {0.3f, 0.06f},
                            {0.05f, 0.1f}, {0.024f, 0.16f}, {0.022f, 2.95f}};
  add_lathe(mesh, glm::vec3(0), pole, 12);
  for (int i = 0; i < 8; ++i) {
    const double turn = 2 * glm::pi<double>() * i / 8;
    const glm::vec3 out(float(std::cos(turn)), 0, float(std::sin(turn)));
    const glm::vec3 rib[] = {glm::vec3(0, 2.86f, 0) + out * 0.05f, glm::vec3(0, 2.28f, 0) + out * 1.46f};
    const glm::vec3 stay[] = {glm::vec3(0, 2.0f, 0) + out * 0.03f, glm::vec3(0, 2.5f, 0) + out * 0.8f};
    add_tube(mesh, rib, 0.008f, 4);
    add_tube(mesh, stay, 0.007f, 4);
  }
  return finished(std::move(mesh), "parasol pole", m.iron);
}

Mesh lantern_post(const street::Materials& m, bool fine) {
  Mesh mesh;
  const glm::vec2 post[] = {{0.26f, 0},    {0.26f, 0.14f}, {0.26f, 0.14f}, {0.2f, 0.2f},   {0.17f, 0.6f},
                            {0.19f, 0.7f}, {0.12f, 0.78f}, {0.085f, 1.2f}, {0.1f, 1.28f},  {0.075f, 1.36f},
                            {0.06f, 2.9f}, {0.085f, 3.0f}, {0.055f, 3.1f}, {0.05f, 3.85f}, {0.14f, 4.0f}};
  const glm::vec2 plain[] = {{0.22f, 0}, {0.17f, 0.7f}, {0.08f, 0.8f}, {0.05f, 3.85f}, {0.14f, 4.0f}};
  add_lathe(mesh, glm::vec3(0), fine ? std::span<const glm::vec2>(post) : plain, fine ? 24 : 8);
  // The lantern's cage and roof; the glass between them is a lamp of its own.
  const glm::vec2 lid[] = {{0.3f, 4.62f}, {0.2f, 4.76f}, {0.05f, 4.86f}, {0.03f, 5.0f}};
  add_lathe(mesh, glm::vec3(0), lid, fine ? 24 : 8);
  for (int i = 0; i < 6; ++i) {
    const double turn = 2 * glm::pi<double>() * i / 6;
    const glm::vec3 out(float(std::cos(turn)), 0, float(std::sin(turn)));
    const glm::vec3 bar[] = {glm::vec3(0, 3.98f, 0) + out * 0.15f, glm::vec3(0, 4.64f, 0) + out * 0.27f};
    add_tube(mesh, bar, 0.013f, fine ? 8 : 4);
  }
  const glm::vec3 rung[] = {{-0.35f, 3.55f, 0}, {-0.1f, 3.55f, 0}, {0.1f, 3.55f, 0}, {0.35f, 3.55f, 0}};
  add_tube(mesh, rung, 0.02f, fine ? 10 : 4);
  return finished(std::move(mesh), "lantern post", m.iron);
}

Mesh lantern(const street::Materials& m) {
  Mesh mesh;
  const glm::vec2 glass[] = {{0, 4.02f},     {0.13f, 4.02f}, {0.13f, 4.02f},
                             {0.245f, 4.6f}, {0.245f, 4.6f}, {0, 4.61f}};
  add_lathe(mesh, glm::vec3(0), glass, 6);
  return finished(std::move(mesh), "lantern", m.warm_lamp);
}

Mesh bollard(const street::Materials& m) {
  Mesh mesh;
  const glm::vec2 profile[] = {{0.11f, 0},      {0.1f, 0.1f},   {0.065f, 0.16f}, {0.06f, 0.7f},
                               {0.085f, 0.76f}, {0.085f, 0.8f}, {0.06f, 0.86f},  {0, 0.9f}};
  add_lathe(mesh, glm::vec3(0), profile, 16);
  return finished(std::move(mesh), "bollard", m.iron);
}

Mesh bench(const Materials& m) {
  Mesh mesh;
  for (int i = 0; i < 5; ++i)
    add_box(mesh, {-0.25f + 0.1f * i, 0.42f, -0.9f}, {-0.17f + 0.1f * i, 0.45f, 0.9f});
  for (int i = 0; i < 4; ++i) add_box(mesh, {0.27f, 0.52f + 0.1f * i, -0.9f}, {0.3f, 0.6f + 0.1f * i, 0.9f});
  for (const float z : {-0.75f, 0.75f}) {
    add_box(mesh, {-0.24f, 0, z - 0.03f}, {-0.18f, 0.42f, z + 0.03f});
    add_box(mesh, {0.22f, 0, z - 0.03f}, {0.27f, 0.92f, z + 0.03f});
  }
  return finished(std::move(mesh), "bench", m.rattan);
}

Mesh fountain(const street::Materials& m) {
  Mesh mesh;
  const glm::vec2 basin[] = {{4.2f, 0},     {4.2f, 0.16f}, {4.2f, 0.16f}, {3.9f, 0.16f}, {3.9f, 0.16f},
                             {3.7f, 0.24f}, {3.62f, 0.5f}, {3.7f, 0.6f},  {3.7f, 0.7f},  {3.7f, 0.7f},
                             {3.3f, 0.7f},  {3.3f, 0.7f},  {3.25f, 0.3f}};
  add_lathe(mesh, glm::vec3(0), basin, 96);
  const glm::vec2 column[] = {{0.9f, 0.3f},  {0.9f, 0.7f},   {0.9f, 0.7f},   {0.6f, 0.8f},   {0.38f, 1.1f},
                              {0.32f, 1.7f}, {0.45f, 1.95f}, {0.9f, 2.1f},   {1.5f, 2.3f},   {1.7f, 2.5f},
                              {1.7f, 2.56f}, {1.7f, 2.56f},  {1.55f, 2.54f}, {1.55f, 2.54f}, {0.5f, 2.36f},
                              {0.3f, 2.4f},  {0.3f, 2.4f},   {0.2f, 2.7f},   {0.18f, 3.1f},  {0.4f, 3.3f},
                              {0.75f, 3.5f}, {0.8f, 3.6f},   {0.8f, 3.6f},   {0.15f, 3.5f},  {0.15f, 3.5f},
                              {0.1f, 3.8f}};
  add_lathe(mesh, glm::vec3(0), column, 64);
  add_sphere(mesh, {0, 3.95f, 0}, 0.22f, 12);
  return finished(std::move(mesh), "fountain", m.trim);
}

Mesh fountain_water(const Materials& m) {
  Mesh mesh;
  const glm::vec2 pool[] = {{3.3f, 0.55f}, {2, 0.552f}, {0.5f, 0.554f}};
  add_lathe(mesh, glm::vec3(0), pool, 48);
  return finished(std::move(mesh), "water", m.water);
}

}  // namespace lightgrid::square
