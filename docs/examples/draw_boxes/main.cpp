// Which triangle does each pixel show? Two boxes on a floor, drawn with OpenCL only.
//
// The rasteriser gives the number and the depth of the nearest triangle at each pixel. What the number leads
// to - its instance, its corners - lies in buffers beside it; here the host reads the instance and prints a
// letter for it.
#include <cmath>
#include <cstdio>
#include <vector>

#include "base/error.h"
#include "cl/transfer.h"
#include "raster/raster_view.h"

using namespace lightgrid;

constexpr int width = 72, height = 24;
constexpr double near_m = 0.1, slope_y = 0.5,
                 slope_x = slope_y * width / height / 2;  // characters are twice as high

// From three metres above the floor, looking 20 degrees down along -z. Depth is reversed: near_m / distance.
RasterCamera make_camera() {
  RasterCamera camera{.grid = {width, height}, .eye = {0, 3, 8}};
  camera.clip_from_view = glm::dmat4(0);
  camera.clip_from_view[0][0] = 1 / slope_x, camera.clip_from_view[1][1] = 1 / slope_y;
  camera.clip_from_view[3][2] = near_m, camera.clip_from_view[2][3] = -1;
  const double down = 20 * 3.14159265358979 / 180;
  camera.view_from_world[1] = {0, std::cos(down), std::sin(down), 0};
  camera.view_from_world[2] = {0, -std::sin(down), std::cos(down), 0};
  return camera;
}

// From (-1, 0, -1) to (1, 2, 1), each side counter-clockwise from without.
const std::vector<glm::vec3> box = {{-1, 0, -1}, {1, 0, -1}, {1, 2, -1}, {-1, 2, -1},
                                    {-1, 0, 1},  {1, 0, 1},  {1, 2, 1},  {-1, 2, 1}};
const std::vector<uint32_t> box_indices = {4, 5, 6, 4, 6, 7, 1, 0, 3, 1, 3, 2, 5, 1, 2, 5, 2, 6,
                                           0, 4, 7, 0, 7, 3, 7, 6, 2, 7, 2, 3, 0, 1, 5, 0, 5, 4};
const std::vector<glm::vec3> floor_corners = {{-20, 0, 20}, {20, 0, 20}, {20, 0, -20}, {-20, 0, -20}};
const std::vector<uint32_t> floor_indices = {0, 1, 2, 0, 2, 3};

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
  RasterScene scene(device);      // the meshes, for any number of views
  scene.set_meshes(std::vector<RasterMesh>{{floor_corners, floor_indices}, {box, box_indices}});
  RasterView view(scene, programs);
  view.set_instances(std::vector<RasterInstance>{{.mesh = 0},
                                                 {.mesh = 1, .world_from_object = placed(-2, 0, 0.4)},
                                                 {.mesh = 1, .world_from_object = placed(0.5, -3, 0.8)}});
  view.set_camera(make_camera());  // again when the camera moves
  const Visibility seen = view.draw();

  // Kernels that shade read these buffers as they are. Triangles are numbered in drawing order, instance by
  // instance.
  std::vector<uint32_t> triangles(width * height), instance_of(view.counts().triangles);
  read_buffer(device, "triangles", seen.triangle, triangles.data(), triangles.size() * 4);
  read_buffer(device, "instances", view.buffers().triangle_instance, instance_of.data(),
              instance_of.size() * 4);
  for (int y = height - 1; y >= 0; --y) {  // row 0 is the lowest one
    for (int x = 0; x < width; ++x) {
      const uint32_t triangle = triangles[y * width + x];
      std::putchar(triangle == no_triangle ? ' ' : ".ab"[instance_of[triangle]]);
    }
    std::putchar('\n');
  }
  return 0;
} catch (const Error& error) {  // wrong input is exit status 2, a machine that cannot do it 3
  std::fprintf(stderr, "draw_boxes: %s\n", error.what());
  return error.exit_code();
}
