// Scenes of a few triangles, for tests of shadows.
#pragma once

#include <vector>

#include "oracle/occlusion.h"

namespace lightgrid::lab {

inline Mesh mesh_of(const std::vector<glm::vec3>& corners, int material = 0) {
  Mesh mesh;
  mesh.positions = corners;
  mesh.normals.assign(corners.size(), {0, 1, 0});
  for (uint32_t i = 0; i < corners.size(); ++i) {
    mesh.bounds.add(corners[i]);
    mesh.indices.push_back(i);
  }
  mesh.material = material;
  return mesh;
}

// Instance i shows mesh i.
inline Scene scene_of(const std::vector<Mesh>& meshes) {
  Scene scene;
  scene.materials = {Material{}};
  scene.meshes = meshes;
  for (int i = 0; i < int(meshes.size()); ++i) scene.instances.push_back({.mesh = i});
  return scene;
}

// Ground at y = 0, 20 m long and wide, instance 0: triangle 0 has x > z.
inline Mesh ground_mesh() {
  return mesh_of({{-10, 0, -10}, {10, 0, 10}, {10, 0, -10}, {-10, 0, -10}, {-10, 0, 10}, {10, 0, 10}});
}

inline Light light_at(const glm::dvec3& position) {
  Light light;
  light.position = position;
  return light;
}

// On triangle 0 of instance 0, seen from 5 m above.
inline Receiver receiver_at(const glm::dvec3& place) {
  return {.own = {0, 0}, .place = {place, 1e-6}, .gap_m = 1e-3, .eye = {place + glm::dvec3(0, 5, 0), 1e-6}};
}

}  // namespace lightgrid::lab
