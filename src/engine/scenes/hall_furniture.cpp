// Columns, lamps and other furniture of the hall.
#include "scenes/hall_parts.h"
#include "scenes/shapes.h"

namespace lightgrid::hall {
namespace {

using namespace shapes;
using Profile = std::vector<glm::vec2>;

// A half-round moulding that bulges out by radius, climbing from `bottom` to bottom + 2 * radius, sharp at
// both ends.
void add_torus_moulding(Profile& profile, float at_radius, float bottom, float radius) {
  const auto curve = arc({at_radius, bottom + radius, 0}, {radius, 0, 0}, {0, radius, 0},
                         -glm::half_pi<float>(), glm::half_pi<float>(), 4);
  if (!profile.empty()) profile.emplace_back(curve.front());
  for (const glm::vec3& p : curve) profile.emplace_back(p);
  profile.emplace_back(curve.back());
}

// Each point but the ends twice: every edge sharp.
Profile sharp(const Profile& points) {
  Profile doubled;
  for (size_t i = 0; i < points.size(); ++i) {
    doubled.push_back(points[i]);
    if (i > 0 && i + 1 < points.size()) doubled.push_back(points[i]);
  }
  return doubled;
}

Mesh turned(const Profile& profile, int sides, const char* name, int material) {
  Mesh mesh;
  add_lathe(mesh, glm::vec3(0), profile, sides);
  return finished(std::move(mesh), name, material);
}

}  // namespace

Mesh column_shaft(const Materials& m) {
  Profile profile;
  for (int i = 0; i <= 6; ++i) {
    const float t = i / 6.f;
    // Entasis: widest a third of the way up.
    profile.emplace_back(0.325f + 0.02f * (1 - (3 * t - 1) * (3 * t - 1)) - 0.02f * t, 0.56f + 3.44f * t);
  }
  return turned(profile, 24, "column shaft", m.marble);
}

Mesh column_stone(const Materials& m) {
  Mesh mesh;
  add_box(mesh, {-0.46f, 0, -0.46f}, {0.46f, 0.2f, 0.46f});
  Profile base;
  add_torus_moulding(base, 0.36f, 0.2f, 0.08f);
  base.insert(base.end(), {{0.35f, 0.38f}, {0.345f, 0.415f}});
  add_torus_moulding(base, 0.34f, 0.42f, 0.05f);
  base.emplace_back(0.31f, 0.56f);
  add_lathe(mesh, glm::vec3(0), base, 24);
  const Profile bell = {{0.28f, 4.06f}, {0.285f, 4.2f}, {0.31f, 4.35f}, {0.37f, 4.5f},
                        {0.44f, 4.58f}, {0.44f, 4.58f}, {0.44f, 4.62f}};
  add_lathe(mesh, glm::vec3(0), bell, 24);
  add_box(mesh, {-0.46f, 4.62f, -0.46f}, {0.46f, springing_m, 0.46f});
  return finished(std::move(mesh), "column base and capital", m.trim);
}

Mesh column_rings(const Materials& m) {
  Mesh mesh;
  for (const float y : {4.0f, 0.58f}) {
    add_torus(mesh, {0, y + 0.02f, 0}, {0, 1, 0}, y > 1 ? 0.285f : 0.325f, 0.035f, 24, 4);
  }
  // Leaves of the capital.
  for (int i = 0; i < 8; ++i) {
    const glm::vec3 out = arc(glm::vec3(0), {1, 0, 0}, {0, 0, 1}, i * glm::quarter_pi<float>(), 0, 1)[0];
    add_sphere(mesh, out * 0.36f + glm::vec3(0, 4.42f, 0), 0.06f, 2);
  }
  return finished(std::move(mesh), "column rings", m.gold);
}

Mesh rib(const Materials& m) {
  constexpr float outer = nave_half_width_m, inner = outer - 0.22f, half_depth = 0.2f;
  const glm::vec3 center(0, vault_springing_m, 0), x(1, 0, 0), y(0, 1, 0), z(0, 0, half_depth);
  const auto curve = [&](float radius, glm::vec3 offset, bool left_to_right) {
    return arc(center + offset, x * radius, y * radius, left_to_right ? glm::pi<float>() : 0.f,
               left_to_right ? 0.f : glm::pi<float>(), 32);
  };
  Mesh mesh;
  add_sweep(mesh, curve(inner, z, false), -2.f * z, true);
  add_strip(mesh, curve(inner, z, true), curve(outer, z, true), {0, 0, 1}, x);
  add_strip(mesh, curve(inner, -z, false), curve(outer, -z, false), {0, 0, -1}, -x);
  return finished(std::move(mesh), "vault rib", m.trim);
}

Mesh urn(int material) {
  return turned({{0.02f, 0},
                 {0.13f, 0},
                 {0.13f, 0},
                 {0.13f, 0.03f},
                 {0.13f, 0.03f},
                 {0.07f, 0.08f},
                 {0.06f, 0.12f},
                 {0.12f, 0.2f},
                 {0.20f, 0.32f},
                 {0.235f, 0.46f},
                 {0.22f, 0.58f},
                 {0.15f, 0.68f},
                 {0.10f, 0.74f},
                 {0.09f, 0.80f},
                 {0.10f, 0.84f},
                 {0.145f, 0.88f},
                 {0.145f, 0.88f},
                 {0.09f, 0.87f},
                 {0.06f, 0.8f}},
                18, "urn", material);
}

Mesh chandelier(const Materials& m) {
  Mesh mesh;
  add_torus(mesh, glm::vec3(0), {0, 1, 0}, 1.15f, 0.04f, 36, 6);
  add_torus(mesh, {0, 0.35f, 0}, {0, 1, 0}, 0.45f, 0.03f, 24, 5);
  add_sphere(mesh, {0, -0.1f, 0}, 0.13f, 4);
  const auto spokes = arc(glm::vec3(0), {1, 0, 0}, {0, 0, 1}, 0, 2 * glm::pi<float>(), 12);
  for (int i = 0; i < 12; ++i) {
    const glm::vec3 side = glm::cross(spokes[i], glm::vec3(0, 1, 0)) * 0.012f;
    // A flat bar from the small ring down to the large one, seen from both sides.
    const glm::vec3 from = spokes[i] * 0.45f + glm::vec3(0, 0.35f, 0), along = spokes[i] * 1.15f - from;
    add_quad(mesh, from - side, side * 2.f, along);
    add_quad(mesh, from + side, side * -2.f, along);
    add_lathe(mesh, spokes[i] * 1.15f,
              sharp({{0.02f, 0.03f}, {0.06f, 0.06f}, {0.06f, 0.09f}, {0.025f, 0.09f}, {0.025f, 0.2f}}), 7);
  }
  add_lathe(mesh, glm::vec3(0), Profile{{0.018f, 0}, {0.018f, 3.4f}}, 8);
  return finished(std::move(mesh), "chandelier", m.bronze);
}

Mesh candle_stand(const Materials& m) {
  return turned(sharp({{0.11f, 0},
                       {0.11f, 0.02f},
                       {0.02f, 0.05f},
                       {0.02f, 0.26f},
                       {0.07f, 0.3f},
                       {0.07f, 0.33f},
                       {0.01f, 0.33f}}),
                8, "candle stand", m.bronze);
}

Mesh sconce(const Materials& m) {
  Mesh mesh;
  add_lathe(mesh, glm::vec3(0),
            sharp({{0.01f, -0.14f}, {0.05f, -0.1f}, {0.1f, -0.02f}, {0.1f, 0.01f}, {0.03f, 0.01f}}), 10);
  // The arm to the column, along -x.
  add_box(mesh, {-0.3f, -0.1f, -0.015f}, {-0.03f, -0.07f, 0.015f});
  return finished(std::move(mesh), "sconce", m.bronze);
}

Mesh lantern(const Materials& m) {
  Mesh mesh;
  add_lathe(mesh, glm::vec3(0), sharp({{0.02f, -0.26f}, {0.14f, -0.2f}, {0.14f, -0.17f}, {0.02f, -0.17f}}),
            12);
  add_lathe(mesh, glm::vec3(0), sharp({{0.02f, 0.15f}, {0.16f, 0.15f}, {0.16f, 0.18f}, {0.02f, 0.32f}}), 12);
  for (const glm::vec3& p : arc(glm::vec3(0), {0.13f, 0, 0}, {0, 0, 0.13f}, 0, 1.5f * glm::pi<float>(), 3)) {
    add_lathe(mesh, p, Profile{{0.008f, -0.17f}, {0.008f, 0.15f}}, 6);
  }
  add_lathe(mesh, glm::vec3(0), Profile{{0.01f, 0.3f}, {0.01f, 2.0f}}, 6);
  return finished(std::move(mesh), "lantern", m.bronze);
}

Mesh lamp_globe(int material, float radius_m) {
  Mesh mesh;
  // Small ones are a few pixels wide.
  add_sphere(mesh, glm::vec3(0), radius_m, radius_m < 0.07f ? 2 : radius_m < 0.2f ? 3 : 6);
  return finished(std::move(mesh), "lamp", material);
}

Mesh baluster(const Materials& m) {
  return turned({{0.09f, 0},
                 {0.09f, 0.06f},
                 {0.09f, 0.06f},
                 {0.05f, 0.1f},
                 {0.05f, 0.16f},
                 {0.085f, 0.3f},
                 {0.075f, 0.42f},
                 {0.04f, 0.6f},
                 {0.04f, 0.72f},
                 {0.08f, 0.78f},
                 {0.08f, 0.78f},
                 {0.08f, 0.84f}},
                10, "baluster", m.trim);
}

Mesh armillary(const Materials& m) {
  Mesh mesh;
  const glm::vec3 axes[] = {
      glm::normalize(glm::vec3(0.4f, 0.9f, 0.15f)), glm::normalize(glm::vec3(0.9f, -0.3f, 0.25f)),
      glm::normalize(glm::vec3(0.1f, -0.25f, 1)), glm::normalize(glm::vec3(-0.6f, 0.6f, 0.6f))};
  float radius = 1.0f;
  for (const glm::vec3& axis : axes) {
    add_torus(mesh, glm::vec3(0), axis, radius, 0.045f, 48, 8);
    radius -= 0.1f;
  }
  return finished(std::move(mesh), "armillary sphere", m.gold);
}

Mesh pedestal(const Materials& m) {
  return turned(sharp({{0.55f, 0},
                       {0.55f, 0.12f},
                       {0.42f, 0.2f},
                       {0.3f, 0.3f},
                       {0.28f, 0.75f},
                       {0.4f, 0.85f},
                       {0.4f, 0.95f},
                       {0.05f, 0.95f}}),
                32, "pedestal", m.porcelain);
}

}  // namespace lightgrid::hall
