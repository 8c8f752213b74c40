#include "passes/light_volumes/light_volumes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

namespace lightgrid {
namespace {

using std::numbers::pi;
constexpr int sides = 12;  // sides of a cone

using Triangle = std::array<int, 3>;

struct Shape {
  std::vector<glm::dvec3> points;
  std::vector<Triangle> triangles;

  void quad(int a, int b, int c, int d) {
    triangles.push_back({a, b, c});
    triangles.push_back({a, c, d});
  }
};

// Distance of a triangle's plane from the origin.
double plane_distance(const Shape& shape, const Triangle& t) {
  const glm::dvec3 &a = shape.points[t[0]], &b = shape.points[t[1]], &c = shape.points[t[2]];
  return glm::dot(glm::normalize(glm::cross(b - a, c - a)), a);
}

// Vertices are rounded to float once; the slack of volumes covers that (light_volumes.cpp).
LightMesh finished(const Shape& shape) {
  LightMesh mesh;
  for (const glm::dvec3& p : shape.points) mesh.positions.emplace_back(p);
  for (const Triangle& t : shape.triangles)
    mesh.indices.insert(mesh.indices.end(), {uint16_t(t[0]), uint16_t(t[1]), uint16_t(t[2])});
  return mesh;
}

Shape icosahedron() {
  const double g = std::numbers::phi;
  Shape shape;
  shape.points = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                  {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  shape.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                     {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                     {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (glm::dvec3& p : shape.points) p = glm::normalize(p);
  return shape;
}

Shape subdivided(const Shape& coarse) {
  Shape fine;
  fine.points = coarse.points;
  std::map<std::pair<int, int>, int> middles;
  const auto middle = [&](int a, int b) {
    const auto [found, added] = middles.try_emplace(std::minmax(a, b), int(fine.points.size()));
    if (added) fine.points.push_back(glm::normalize(fine.points[a] + fine.points[b]));
    return found->second;
  };
  for (const Triangle& t : coarse.triangles) {
    const int ab = middle(t[0], t[1]), bc = middle(t[1], t[2]), ca = middle(t[2], t[0]);
    fine.triangles.insert(fine.triangles.end(),
                          {{t[0], ab, ca}, {t[1], bc, ab}, {t[2], ca, bc}, {ab, bc, ca}});
  }
  return fine;
}

// Appends a ring of points at this angle from +z, at distance 1.
int add_ring(Shape& shape, double angle_rad) {
  const int first = int(shape.points.size());
  for (int i = 0; i < sides; ++i) {
    const double turn = 2 * pi * i / sides;
    shape.points.emplace_back(std::sin(angle_rad) * std::cos(turn), std::sin(angle_rad) * std::sin(turn),
                              std::cos(angle_rad));
  }
  return first;
}

}  // namespace

LightMesh ball_mesh(int subdivisions) {
  Shape shape = icosahedron();
  for (int i = 0; i < subdivisions; ++i) shape = subdivided(shape);
  double nearest_face = 1;
  for (const Triangle& t : shape.triangles) nearest_face = std::min(nearest_face, plane_distance(shape, t));
  for (glm::dvec3& p : shape.points) p /= nearest_face;
  return finished(shape);
}

LightMesh box_mesh() {
  Shape shape;
  for (int corner = 0; corner < 8; ++corner) {
    shape.points.emplace_back(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
  }
  shape.quad(0, 4, 6, 2);
  shape.quad(1, 3, 7, 5);
  shape.quad(0, 1, 5, 4);
  shape.quad(2, 6, 7, 3);
  shape.quad(0, 2, 3, 1);
  shape.quad(4, 5, 7, 6);
  return finished(shape);
}

LightMesh cone_mesh(double half_angle_rad) {
  // The flat sides are tangent to the cone along their centre lines, so their edges are slightly farther out.
  const double edge_angle =
      std::atan2(std::sin(half_angle_rad), std::cos(half_angle_rad) * std::cos(pi / sides));
  Shape shape;
  const int tip = 0, apex = 1;
  shape.points = {{0, 0, 1}, {0, 0, 0}};
  const int inner = add_ring(shape, edge_angle / 3), middle = add_ring(shape, edge_angle * 2 / 3),
            outer = add_ring(shape, edge_angle);
  double nearest_cap = 1;
  for (int i = 0; i < sides; ++i) {
    const int j = (i + 1) % sides;
    const size_t first = shape.triangles.size();
    shape.triangles.push_back({tip, inner + i, inner + j});
    shape.quad(inner + i, middle + i, middle + j, inner + j);
    shape.quad(middle + i, outer + i, outer + j, middle + j);
    for (size_t t = first; t < shape.triangles.size(); ++t)
      nearest_cap = std::min(nearest_cap, plane_distance(shape, shape.triangles[t]));
    shape.triangles.push_back({apex, outer + j, outer + i});
  }
  for (glm::dvec3& p : shape.points) p /= nearest_cap;
  return finished(shape);
}

LightMesh pyramid_mesh() {
  Shape shape;
  const int apex = 0, base = 1;
  shape.points = {{0, 0, 0}, {0, 0, 1}};
  const int ring = add_ring(shape, pi / 2);
  for (int i = 0; i < sides; ++i) {
    glm::dvec3& p = shape.points[ring + i];
    p = {glm::dvec2(p) / std::cos(pi / sides), 1};
    const int j = (i + 1) % sides;
    shape.triangles.push_back({base, ring + i, ring + j});
    shape.triangles.push_back({apex, ring + j, ring + i});
  }
  return finished(shape);
}

LightMesh everything_mesh() { return {{{-2, -2, 0}, {-2, 6, 0}, {6, -2, 0}}, {0, 1, 2}}; }

}  // namespace lightgrid
