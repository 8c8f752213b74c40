#include "scenes/shapes.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "scene/deform.h"

namespace lightgrid::shapes {
namespace {

// Angles in double, rounded once: libraries that differ in the last place then agree.
glm::vec2 on_circle(double angle) { return {float(std::cos(angle)), float(std::sin(angle))}; }

glm::vec3 any_perpendicular(glm::vec3 axis) {
  return glm::normalize(glm::cross(std::abs(axis.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0), axis));
}

void add_triangle(Mesh& mesh, uint32_t a, uint32_t b, uint32_t c) {
  const glm::vec3 p = mesh.positions[a], q = mesh.positions[b], r = mesh.positions[c];
  const glm::vec3 doubled_area = glm::cross(q - p, r - p);
  if (glm::dot(doubled_area, doubled_area) > 1e-16f) mesh.indices.insert(mesh.indices.end(), {a, b, c});
}

}  // namespace

void add_grid(Mesh& mesh, int columns, int rows, std::span<const SurfacePoint> points) {
  assert(points.size() == size_t(columns + 1) * (rows + 1));
  const uint32_t first = uint32_t(mesh.positions.size());
  for (const SurfacePoint& p : points) {
    const glm::vec3 normal = glm::normalize(p.normal);
    mesh.positions.push_back(p.position);
    mesh.normals.push_back(normal);
    mesh.tangents.emplace_back(glm::normalize(p.tangent - normal * glm::dot(normal, p.tangent)), 1.f);
    mesh.uv0.push_back(p.uv);
  }
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const uint32_t a = first + row * (columns + 1) + column, b = a + 1, d = a + columns + 1, c = d + 1;
      add_triangle(mesh, a, b, c);
      add_triangle(mesh, a, c, d);
    }
  }
}

void add_quad(Mesh& mesh, glm::vec3 corner, glm::vec3 right, glm::vec3 up, int columns, int rows) {
  const glm::vec3 normal = glm::cross(right, up);
  const float width = glm::length(right), height = glm::length(up);
  std::vector<SurfacePoint> points;
  for (int row = 0; row <= rows; ++row) {
    for (int column = 0; column <= columns; ++column) {
      const float s = float(column) / columns, t = float(row) / rows;
      points.push_back({corner + right * s + up * t, normal, right, {s * width, -t * height}});
    }
  }
  add_grid(mesh, columns, rows, points);
}

void add_box(Mesh& mesh, glm::vec3 low, glm::vec3 high) {
  const glm::vec3 size = high - low, x(size.x, 0, 0), y(0, size.y, 0), z(0, 0, size.z);
  add_quad(mesh, low + z, x, y);
  add_quad(mesh, low + x, -x, y);
  add_quad(mesh, low + x + z, -z, y);
  add_quad(mesh, low, z, y);
  add_quad(mesh, low + y + z, x, -z);
  add_quad(mesh, low, x, z);
}

void add_strip(Mesh& mesh, std::span<const glm::vec3> lower, std::span<const glm::vec3> upper,
               glm::vec3 normal, glm::vec3 right) {
  assert(lower.size() == upper.size());
  const glm::vec3 up = glm::cross(normal, right);
  std::vector<SurfacePoint> points;
  for (const auto& line : {lower, upper}) {
    for (const glm::vec3& p : line)
      points.push_back({p, normal, right, {glm::dot(p, right), -glm::dot(p, up)}});
  }
  add_grid(mesh, int(lower.size()) - 1, 1, points);
}

void add_sweep(Mesh& mesh, std::span<const glm::vec3> line, glm::vec3 sweep, bool smooth) {
  const int segments = int(line.size()) - 1;
  const float height = glm::length(sweep);
  std::vector<glm::vec3> along(segments);
  for (int i = 0; i < segments; ++i) along[i] = glm::normalize(line[i + 1] - line[i]);

  float u = 0;
  std::vector<SurfacePoint> lower, upper;
  const auto add_point = [&](int i, glm::vec3 tangent) {
    const glm::vec3 normal = glm::cross(tangent, sweep);
    lower.push_back({line[i], normal, tangent, {u, 0}});
    upper.push_back({line[i] + sweep, normal, tangent, {u, -height}});
  };
  const auto flush = [&] {
    const int columns = int(lower.size()) - 1;
    lower.insert(lower.end(), upper.begin(), upper.end());
    add_grid(mesh, columns, 1, lower);
    lower.clear();
    upper.clear();
  };
  for (int i = 0; i < segments; ++i) {
    if (!smooth || i == 0) add_point(i, along[i]);
    u += glm::length(line[i + 1] - line[i]);
    add_point(i + 1, smooth && i + 1 < segments ? along[i] + along[i + 1] : along[i]);
    if (!smooth || i + 1 == segments) flush();
  }
}

void add_lathe(Mesh& mesh, glm::vec3 center, std::span<const glm::vec2> profile, int sides) {
  const int count = int(profile.size());
  const auto direction = [&](int i) { return glm::normalize(profile[i + 1] - profile[i]); };
  // A band ends where a point is repeated.
  for (int begin = 0; begin + 1 < count;) {
    int end = begin + 1;
    while (end + 1 < count && profile[end] != profile[end + 1]) ++end;
    float widest = 0, v = 0;
    for (int i = begin; i <= end; ++i) widest = std::max(widest, profile[i].x);
    std::vector<SurfacePoint> points;
    for (int i = begin; i <= end; ++i) {
      if (i > begin) v -= glm::length(profile[i] - profile[i - 1]);
      const glm::vec2 slope =
          (i > begin ? direction(i - 1) : glm::vec2(0)) + (i < end ? direction(i) : glm::vec2(0));
      for (int side = 0; side <= sides; ++side) {
        const float turn = float(side) / sides;
        // s is oriented so that the outside is to the right of a climbing profile: z = -sin.
        const glm::vec2 c = on_circle(2 * glm::pi<double>() * (side % sides) / sides);
        const glm::vec3 out(c.x, 0, -c.y);
        points.push_back({center + out * profile[i].x + glm::vec3(0, profile[i].y, 0),
                          out * slope.y - glm::vec3(0, slope.x, 0),
                          glm::vec3(-c.y, 0, -c.x),
                          {turn * 2 * glm::pi<float>() * widest, v}});
      }
    }
    add_grid(mesh, sides, end - begin, points);
    begin = end + 1;
  }
}

void add_sphere(Mesh& mesh, glm::vec3 center, float radius, int cells) {
  const glm::vec3 rights[6] = {{0, 0, -1}, {0, 0, 1}, {1, 0, 0}, {1, 0, 0}, {1, 0, 0}, {-1, 0, 0}};
  const glm::vec3 ups[6] = {{0, 1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}, {0, 1, 0}, {0, 1, 0}};
  const float face_m = radius * glm::half_pi<float>();
  for (int face = 0; face < 6; ++face) {
    const glm::vec3 right = rights[face], up = ups[face], front = glm::cross(right, up);
    std::vector<SurfacePoint> points;
    for (int row = 0; row <= cells; ++row) {
      for (int column = 0; column <= cells; ++column) {
        // Equal angles rather than equal steps: triangles of nearly equal size.
        const auto warped = [cells](int i) {
          return float(std::tan(glm::quarter_pi<double>() * (2.0 * i / cells - 1)));
        };
        const glm::vec3 n = glm::normalize(front + right * warped(column) + up * warped(row));
        points.push_back(
            {center + n * radius, n, right, {float(column) / cells * face_m, -float(row) / cells * face_m}});
      }
    }
    add_grid(mesh, cells, cells, points);
  }
}

void add_torus(Mesh& mesh, glm::vec3 center, glm::vec3 axis, float ring_radius, float tube_radius, int sides,
               int tube_sides) {
  const glm::vec3 right = any_perpendicular(axis), forward = glm::cross(axis, right);
  std::vector<SurfacePoint> points;
  for (int row = 0; row <= tube_sides; ++row) {
    const glm::vec2 tube = on_circle(2 * glm::pi<double>() * (row % tube_sides) / tube_sides);
    for (int side = 0; side <= sides; ++side) {
      const glm::vec2 c = on_circle(2 * glm::pi<double>() * (side % sides) / sides);
      const glm::vec3 out = right * c.x + forward * c.y;
      const glm::vec3 normal = out * tube.x + axis * tube.y;
      points.push_back({center + out * ring_radius + normal * tube_radius,
                        normal,
                        forward * c.x - right * c.y,
                        {float(side) / sides * 2 * glm::pi<float>() * ring_radius,
                         -float(row) / tube_sides * 2 * glm::pi<float>() * tube_radius}});
    }
  }
  add_grid(mesh, sides, tube_sides, points);
}

std::vector<glm::vec3> arc(glm::vec3 center, glm::vec3 right, glm::vec3 up, float from, float to,
                           int segments) {
  std::vector<glm::vec3> points;
  for (int i = 0; i <= segments; ++i) {
    const glm::vec2 c = on_circle(from + (double(to) - from) * i / segments);
    points.push_back(center + right * c.x + up * c.y);
  }
  return points;
}

Mesh finished(Mesh mesh, std::string name, int material) {
  mesh.name = std::move(name);
  mesh.material = material;
  measure(mesh);
  return mesh;
}

}  // namespace lightgrid::shapes
