#include "verify/shadow_scenes.h"

#include <cmath>

#include "scenes/compose.h"
#include "scenes/shapes.h"

namespace lightgrid::lab::verify {

using glm::dvec3;
using glm::vec3;

namespace {

Bitmap random_texels(int side) {
  Random random(53);
  Bitmap texels{.name = "leaves", .width = side, .height = side};
  for (int i = 0; i < side * side; ++i) {
    texels.rgba.insert(texels.rgba.end(), {90, 140, 60});
    texels.rgba.push_back(uint8_t(random.next() % 2 ? random.next() % 256 : 255 * (random.next() % 2)));
  }
  return texels;
}

vec3 corner_in(Random& random, double half) { return vec3(in_cube(random, half)); }

}  // namespace

Scene empty_shadow_scene() {
  Scene scene;
  add_material(scene, "plaster", {0.7f, 0.7f, 0.7f}, 0, 0.8f);
  const int leaves = add_material(scene, "leaves", {0.3f, 0.6f, 0.2f}, 0, 0.8f);
  const int glass = add_material(scene, "glass", {0.7f, 0.8f, 0.9f}, 0, 0.1f);
  for (Material& material : scene.materials) material.double_sided = true;
  scene.materials[size_t(leaves)].alpha_mode = AlphaMode::mask;
  scene.materials[size_t(leaves)].base_color_map.texture = add_texture(scene, random_texels(8), true);
  scene.materials[size_t(glass)].alpha_mode = AlphaMode::blend;
  return scene;
}

Instance& add_triangles(Scene& scene, std::span<const ShadowTriangle> triangles, const glm::dmat4& world,
                        int material) {
  Mesh mesh;
  for (const ShadowTriangle& t : triangles) {
    const dvec3 across = glm::cross(dvec3(t[1] - t[0]), dvec3(t[2] - t[0]));
    const double length = glm::length(across);
    for (const vec3& p : t) {
      mesh.indices.push_back(uint32_t(mesh.positions.size()));
      mesh.positions.push_back(p);
      mesh.uv0.emplace_back(p.x, p.y);
      mesh.normals.push_back(length > 0 ? vec3(across / length) : vec3(0, 1, 0));
    }
  }
  const std::string name = "triangles " + std::to_string(scene.meshes.size());
  add_instance(scene, name, add_mesh(scene, shapes::finished(std::move(mesh), name, material)), world);
  return scene.instances.back();
}

void add_quad(ShadowTriangles& triangles, const vec3& from, const vec3& u, const vec3& v, int columns,
              int rows) {
  const auto at = [&](int x, int y) {
    return from + u * (float(x) / float(columns)) + v * (float(y) / float(rows));
  };
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      triangles.push_back({at(x, y), at(x + 1, y), at(x + 1, y + 1)});
      triangles.push_back({at(x, y), at(x + 1, y + 1), at(x, y + 1)});
    }
  }
}

void add_box(ShadowTriangles& triangles, const vec3& low, const vec3& high) {
  const vec3 x(high.x - low.x, 0, 0), y(0, high.y - low.y, 0), z(0, 0, high.z - low.z);
  for (const vec3& from : {low, low + z}) add_quad(triangles, from, x, y);
  for (const vec3& from : {low, low + y}) add_quad(triangles, from, z, x);
  for (const vec3& from : {low, low + x}) add_quad(triangles, from, y, z);
}

ShadowTriangles quad_of(const vec3& from, const vec3& u, const vec3& v, int columns, int rows) {
  ShadowTriangles made;
  add_quad(made, from, u, v, columns, rows);
  return made;
}

ShadowTriangles box_of(const vec3& low, const vec3& high) {
  ShadowTriangles made;
  add_box(made, low, high);
  return made;
}

Light& add_lamp(Scene& scene, const dvec3& position, float radius_m) {
  Light light;
  light.name = "lamp";
  light.position = position;
  light.radius_m = radius_m;
  light.casts_shadow = true;
  return scene.lights.emplace_back(light);
}

Light& add_spot_lamp(Scene& scene, const dvec3& position, const dvec3& target, float outer_rad,
                     float radius_m) {
  Light& light = add_lamp(scene, position, radius_m);
  light.type = LightType::spot;
  light.direction = vec3(glm::normalize(target - position));
  light.outer_cone_rad = outer_rad;
  light.inner_cone_rad = outer_rad / 2;
  return light;
}

View shadow_view(const dvec3& eye, const dvec3& target, int width, int height, double fov_y_rad) {
  Camera camera = look_at(eye, target);
  camera.fov_y_rad = fov_y_rad;
  camera.near_m = 0.01;
  return make_view(camera, width, height);
}

dvec3 in_cube(Random& random, double half) {
  const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
  return dvec3(x, y, z) * half;
}

ShadowTriangles sliver_soup(Random& random, int count) {
  ShadowTriangles made;
  for (int i = 0; i < count; ++i) {
    const vec3 a = corner_in(random, 1.8), along = corner_in(random, 1.5);
    const float t = random.uniform();
    made.push_back({a, a + along, a + along * t + corner_in(random, std::pow(10.0, random.uniform(-6, -1)))});
  }
  return made;
}

ShadowTriangles duplicate_soup(Random& random, int count) {
  ShadowTriangles made;
  for (int i = 0; i < count; ++i) {
    const vec3 a = corner_in(random, 1.8), b = a + corner_in(random, 0.8), c = a + corner_in(random, 0.8);
    made.push_back({a, b, c});
    made.push_back({c, b, a});
    made.push_back({b, c, a});
    made.push_back({a, a, b});
    made.push_back({a, b, a + (b - a) * 2.0f});
    made.push_back({c, c, c});
  }
  return made;
}

ShadowTriangles coplanar_soup(Random& random, int count) {
  ShadowTriangles made;
  for (int i = 0; i < count; ++i) {
    const vec3 a = corner_in(random, 1.8), b = corner_in(random, 1.8), c = corner_in(random, 1.8);
    made.push_back({a, b, c});
    made.push_back({a, b, glm::mix(a, c, 0.5f)});
    made.push_back({glm::mix(a, b, 0.25f), glm::mix(a, b, 0.75f), c});
  }
  return made;
}

ShadowTriangles junction_soup(Random& random, int count) {
  ShadowTriangles made;
  for (int i = 0; i < count; ++i) {
    const int axis = i % 3;
    vec3 u(0), v(0), at(-1.5f);
    u[(axis + 1) % 3] = v[(axis + 2) % 3] = 1;
    at[axis] = i < 3 ? 1 : i < 6 ? -1 : random.uniform(-2, 2);
    add_quad(made, at, u, v * 3.0f, 1, 3);
    add_quad(made, at + u, u * 0.5f, v * 3.0f, 1, 6);
  }
  return made;
}

ShadowTriangles soup_of_all_sizes(Random& random, int count) {
  ShadowTriangles made;
  for (int i = 0; i < count; ++i) {
    const vec3 a = corner_in(random, 1.5);
    made.push_back({a, a + corner_in(random, 1e-4), a + corner_in(random, 1e-4)});
    made.push_back({a, a + corner_in(random, 0.05), a + corner_in(random, 0.05)});
    if (i % 40) continue;
    const vec3 b = corner_in(random, 1.5), flat(1, 0.01f, 1);
    made.push_back({b - vec3(0, 2, 0), b + flat * corner_in(random, 1e3), b + flat * corner_in(random, 1e3)});
  }
  return made;
}

dvec3 on_triangle(Random& random, const ShadowTriangle& t) {
  double u = random.uniform(), v = random.uniform();
  if (u + v > 1) {
    u = 1 - u;
    v = 1 - v;
  }
  const uint64_t place = random.next() % 4, first = random.next() % 3;
  if (place < 2) u = 0;
  if (place == 1) v = double(random.next() % 2);
  return dvec3(t[first]) * (1 - u - v) + dvec3(t[(first + 1) % 3]) * u + dvec3(t[(first + 2) % 3]) * v;
}

}  // namespace lightgrid::lab::verify
