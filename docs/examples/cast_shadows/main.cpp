// Where on a floor do two boxes hide a lamp, and where the sun? Exact shadow rays, with OpenCL only.
//
// Points are asked for in blocks of 16 that share a light; a bit a point comes back. Kernels of your own ask
// in place: RayScene::kernel_text(), arguments() and defines().
#include <cmath>
#include <cstdio>
#include <vector>

#include "base/error.h"
#include "rays/ray_scene.h"

using namespace lightgrid;

constexpr int width = 64, height = 20;                   // points of the floor
constexpr double step_x = 0.25, step_z = 0.5;            // metres
const glm::dvec3 lamp{1, 5, 0.3}, to_sun{-0.6, 0.8, 0};  // world; a unit

// From (-1, 0, -1) to (1, 2, 1).
const std::vector<glm::vec3> box = {{-1, 0, -1}, {1, 0, -1}, {1, 2, -1}, {-1, 2, -1},
                                    {-1, 0, 1},  {1, 0, 1},  {1, 2, 1},  {-1, 2, 1}};
const std::vector<uint32_t> box_indices = {4, 5, 6, 4, 6, 7, 1, 0, 3, 1, 3, 2, 5, 1, 2, 5, 2, 6,
                                           0, 4, 7, 0, 7, 3, 7, 6, 2, 7, 2, 3, 0, 1, 5, 0, 5, 4};

// The floor's point in the middle of column x and row z.
glm::dvec3 on_floor(int x, int z) {
  return {(x + 0.5 - width / 2) * step_x, 0, (z + 0.5 - height / 2) * step_z};
}

// Turned about the upright axis, then moved.
glm::dmat4 placed(double x, double z, double turn) {
  glm::dmat4 m(1);
  m[0] = {std::cos(turn), 0, -std::sin(turn), 0}, m[2] = {std::sin(turn), 0, std::cos(turn), 0};
  m[3] = {x, 0, z, 1};
  return m;
}

int main() try {
  ClDevice device;  // a GPU if there is one; ClDevice("pthread") takes the one with that in its name
  ProgramCache programs(device);  // compiled kernels are kept in ~/.cache/lightgrid
  RayScene scene(device, programs);
  scene.set_meshes(std::vector<RayMesh>{{box, box_indices}});
  // Again when they move: the device then moves them in the tree that it has.
  scene.set_instances(std::vector<RayInstance>{{.world_from_object = placed(-2, 0.5, 0.4)},
                                               {.world_from_object = placed(3.5, -1, 0.8)}});
  // Positions are relative to the scene's origin.
  const std::vector<RayLight> lights = {{lamp - scene.origin(), 1}, {to_sun, 0}};
  std::vector<RayPoint> points;
  std::vector<RayPacket> packets;
  for (int z = 0; z < height; ++z) {
    for (int x = 0; x < width; ++x)
      points.push_back({.position = glm::vec3(on_floor(x, z) - scene.origin())});
  }
  for (uint32_t light = 0; light < 2; ++light) {
    for (uint32_t block = 0; block < points.size() / 16; ++block) packets.push_back({block, light});
  }
  const std::vector<uint32_t> hidden = scene.occlusion(points, lights, packets);
  for (int i = 0; i < width * height; ++i) {
    const bool from_lamp = hidden[i / 16] >> i % 16 & 1,
               from_sun = hidden[packets.size() / 2 + i / 16] >> i % 16 & 1;
    std::putchar(from_lamp && from_sun ? '#' : from_lamp ? 'l' : from_sun ? 's' : '.');
    if (i % width == width - 1) std::putchar('\n');
  }
  return 0;
} catch (const Error& error) {  // wrong input is exit status 2, a machine that cannot do it 3
  std::fprintf(stderr, "cast_shadows: %s\n", error.what());
  return error.exit_code();
}
