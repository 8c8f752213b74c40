// Trees, hedges, ivy and flowers of the square, as cards that a mask cuts out.
#include <cmath>

#include "scene/random.h"
#include "scenes/shapes.h"
#include "scenes/square_parts.h"

namespace lightgrid::square {
namespace {

using namespace shapes;

// A card about `center`, turned at random but with its front outward. Normals lean outward: leaves are then
// lit as the plant is round, not each by its own chance.
void add_card(Mesh& mesh, Random& random, glm::vec3 center, glm::vec3 out, float size_m) {
  glm::vec3 face = glm::normalize(out + 0.8f * glm::vec3(any_direction(random)));
  if (glm::dot(face, out) < 0) face = -face;
  const glm::vec3 any = glm::vec3(any_direction(random));
  const glm::vec3 across = glm::cross(face, any);
  if (glm::dot(across, across) < 0.01f) return add_card(mesh, random, center, out, size_m);
  const glm::vec3 right = glm::normalize(across) * size_m, up = glm::cross(face, right);
  const glm::vec3 corner = center - (right + up) * 0.5f, normal = glm::normalize(face + 0.7f * out);
  const SurfacePoint points[] = {{corner, normal, right, {0, 0}},
                                 {corner + right, normal, right, {1, 0}},
                                 {corner + up, normal, right, {0, -1}},
                                 {corner + right + up, normal, right, {1, -1}}};
  add_grid(mesh, 1, 1, points);
}

// Cards all over a box but its underside, no further than `depth_m` within.
void add_box_cards(Mesh& mesh, Random& random, glm::vec3 low, glm::vec3 high, int cards, float card_m,
                   float depth_m) {
  const glm::vec3 size = high - low;
  const float top = size.x * size.z, long_side = size.y * size.z, short_side = size.x * size.y;
  for (int i = 0; i < cards; ++i) {
    glm::vec3 p = low + size * glm::vec3(random.uniform(), random.uniform(), random.uniform());
    const float pick = random.uniform() * (top + 2 * long_side + 2 * short_side);
    const float within = random.uniform() * depth_m;
    glm::vec3 out(0);
    if (pick < top) {
      p.y = high.y - within;
      out.y = 1;
    } else if (pick < top + long_side) {
      p.x = low.x + within;
      out.x = -1;
    } else if (pick < top + 2 * long_side) {
      p.x = high.x - within;
      out.x = 1;
    } else if (pick < top + 2 * long_side + short_side) {
      p.z = low.z + within;
      out.z = -1;
    } else {
      p.z = high.z - within;
      out.z = 1;
    }
    add_card(mesh, random, p, out, card_m * random.uniform(0.75f, 1.25f));
  }
}

}  // namespace

Mesh crown(const Materials& m, int cards, float card_m, uint64_t seed) {
  Mesh mesh;
  Random random(seed);
  constexpr int clumps = 30;
  std::vector<glm::vec4> balls;
  for (int i = 0; i < clumps; ++i) {
    const glm::vec3 d(any_direction(random));
    const float out = std::cbrt(random.uniform(0.25f, 1));
    balls.emplace_back(glm::vec3(0, 5.7f, 0) + d * glm::vec3(2.1f, 1.7f, 2.1f) * out,
                       random.uniform(0.65f, 1.0f));
  }
  for (int i = 0; i < cards; ++i) {
    const glm::vec4& ball = balls[i % clumps];
    const glm::vec3 out(any_direction(random));
    add_card(mesh, random, glm::vec3(ball) + out * ball.w * random.uniform(0.8f, 1.f), out,
             card_m * random.uniform(0.7f, 1.3f));
  }
  return finished(std::move(mesh), "crown", m.leaves);
}

Mesh trunk(const Materials& m) {
  Mesh mesh;
  const std::vector<glm::vec2> bole = {{0.34f, -0.05f}, {0.24f, 0.2f}, {0.2f, 0.8f}, {0.18f, 1.8f},
                                       {0.17f, 2.8f},   {0.19f, 3.4f}, {0.12f, 4.2f}};
  add_lathe(mesh, glm::vec3(0), bole, 14);
  Random random(88);
  for (int i = 0; i < 9; ++i) {
    const double turn = 6.283185307179586 * i / 9 + random.uniform(-0.3f, 0.3f);
    const glm::vec3 side(float(std::cos(turn)), 0, float(std::sin(turn)));
    const float rise = random.uniform(1.4f, 2.6f);
    const glm::vec3 line[] = {glm::vec3(0, 2.9f, 0), glm::vec3(0, 3.6f, 0) + side * 0.5f,
                              glm::vec3(0, 3.4f + 0.6f * rise, 0) + side * 1.1f,
                              glm::vec3(0, 3.5f + rise, 0) + side * 1.5f};
    add_tube(mesh, line, 0.06f, 7);
  }
  return finished(std::move(mesh), "trunk", m.bark);
}

Mesh hedge(const Materials& m, int cards, float card_m, uint64_t seed) {
  Mesh mesh;
  Random random(seed);
  const float half = hedge_m / 2;
  add_box_cards(mesh, random, {-0.3f, 0.4f, -half}, {0.3f, 1.15f, half}, cards, card_m, 0.08f);
  return finished(std::move(mesh), "hedge", m.hedge);
}

Mesh hedge_core(const Materials& m) {
  Mesh mesh;
  const float half = hedge_m / 2;
  add_box(mesh, {-0.24f, 0.4f, -half + 0.05f}, {0.24f, 1.08f, half - 0.05f});
  return finished(std::move(mesh), "hedge core", m.hedge_core);
}

Mesh hedge_box(const Materials& m) {
  Mesh mesh;
  const float half = hedge_m / 2;
  add_box(mesh, {-0.32f, 0, -half}, {0.32f, 0.42f, half});
  add_box(mesh, {-0.36f, 0.42f, -half - 0.02f}, {0.36f, 0.47f, half + 0.02f});
  return finished(std::move(mesh), "hedge box", m.kerb);
}

Mesh ivy(const Materials& m, uint64_t seed) {
  Mesh mesh;
  Random random(seed);
  // Denser and wider below.
  for (int i = 0; i < 900; ++i) {
    const float up = random.uniform(), high = 0.1f + 9.5f * up * std::sqrt(up);
    const float across = random.uniform() * random.uniform() * (1.9f - 1.3f * up);
    add_card(
        mesh, random,
        {street::front_x_m - 0.05f - 0.06f * random.uniform(), high, -street::house_m / 2 + 0.15f + across},
        {-1, 0, 0}, random.uniform(0.16f, 0.28f));
  }
  return finished(std::move(mesh), "ivy", m.ivy);
}

Mesh flowers(const Materials& m, uint64_t seed) {
  Mesh mesh;
  Random random(seed);
  add_box_cards(mesh, random, {-0.14f, 0.08f, -0.55f}, {0.08f, 0.3f, 0.55f}, 70, 0.16f, 0.08f);
  return finished(std::move(mesh), "flowers", m.hedge);
}

}  // namespace lightgrid::square
