// Small helpers that put a scene together.
#pragma once

#include <string>

#include <glm/gtc/matrix_transform.hpp>

#include "scene/scene.h"

namespace lightgrid {

// These return the index of the added element.
int add_mesh(Scene& scene, Mesh mesh);
int add_texture(Scene& scene, Bitmap bitmap, bool srgb);
int add_material(Scene& scene, const std::string& name, glm::vec3 color, float metallic, float roughness);

void add_instance(Scene& scene, const std::string& name, int mesh,
                  const glm::dmat4& world_from_object = glm::dmat4(1));

// The surface of a lamp around its light, which it does not hide.
void add_lamp(Scene& scene, const std::string& name, int mesh, const glm::dmat4& world_from_object);

// A texture that repeats every `metres`, on texture coordinates in metres.
TextureSlot repeat_every(int texture, float metres);

Light& add_point(Scene& scene, const std::string& name, glm::vec3 position, glm::vec3 color, float candela,
                 float radius_m);
// Half-angles in degrees.
Light& add_spot(Scene& scene, const std::string& name, glm::vec3 position, glm::vec3 target, glm::vec3 color,
                float candela, float radius_m, float inner_deg, float outer_deg);

Camera& add_camera(Scene& scene, const std::string& name, glm::dvec3 eye, glm::dvec3 target,
                   double fov_y_deg);

// World from object, turned about y by `degrees` (exact for multiples of 90) and moved.
glm::dmat4 placed(glm::dvec3 position, double degrees = 0, double scale = 1);

// The images of one material.
struct SurfaceMaps {
  Bitmap color, normal, roughness;  // roughness may be empty
};

// Repeating every `metres`.
void use_maps(Scene& scene, int material, SurfaceMaps maps, float metres);
void use_color(Scene& scene, int material, Bitmap color, float metres);

struct Masonry {
  const char* name;
  int columns, rows;  // pieces across and up the image; each second row shifted by half a piece
  float joint_px;
  glm::vec3 color, mortar;
  float depth_px;  // depth of the joints
  uint64_t seed;
};

// Blocks or bricks, each with its own shade.
SurfaceMaps masonry(const Masonry& masonry);

}  // namespace lightgrid
