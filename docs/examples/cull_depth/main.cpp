// Which lights can reach which part of a picture? From a plain array of depths and a list of lights, with
// OpenCL only.
//
// The picture is cut into tiles of 16 x 16 pixels. For each, lightgrid takes the nearest and the farthest
// surface from the depth buffer, and lists the lights whose spheres reach the space between. A renderer then
// shades a pixel with the lights of its tile and with no others.
#include <algorithm>
#include <cstdio>
#include <random>
#include <vector>

#include "base/error.h"
#include "culling/light_culler.h"
#include "shared/light_grid.h"

using namespace lightgrid;

constexpr int width = 1280, height = 720;
constexpr double near_m = 0.1, eye_height_m = 2, slope_y = 0.5, slope_x = slope_y * width / height;

// The view: at the origin, along -z, `slope_y` up and down at a distance of 1. Depth is reversed, near_m /
// distance, so that it is 1 at the near plane and 0 at infinity. Matrices are GLM's, m[column][row].
CullView make_view() {
  CullView view{.width = width, .height = height};
  glm::dmat4& m = view.clip_from_view;
  m = glm::dmat4(0);
  m[0][0] = 1 / slope_x, m[1][1] = 1 / slope_y, m[3][2] = near_m, m[2][3] = -1;
  return view;
}

// A floor two metres below the eye, under a sky: row 0 is the lowest one, and 0 means no surface.
std::vector<float> make_depth() {
  std::vector<float> depth;
  for (int y = 0; y < height; ++y) {
    // Descent of the ray through this row per metre.
    const double down = slope_y * (1 - (y + 0.5) * 2 / height);
    depth.insert(depth.end(), width, down > 0 ? float(near_m * down / eye_height_m) : 0.0f);
  }
  return depth;
}

// Point lights over the floor, in world space, which is also this camera's.
std::vector<CullLight> make_lights(int count) {
  std::mt19937 random(1);  // the same numbers everywhere, unlike the standard distributions
  const auto between = [&](double low, double high) {
    return low + (high - low) * (random() / 4294967295.0);
  };
  std::vector<CullLight> lights(count);
  for (CullLight& light : lights) {
    const double d = between(3, 60);
    light.position = {between(-d, d), between(-2, 1), -d};
    light.radius_m = between(0.5, 4);
  }
  return lights;
}

int main() try {
  const std::vector<float> depth = make_depth();
  const std::vector<CullLight> lights = make_lights(500);

  ClDevice device;                // a GPU if there is one; ClDevice("pthread") selects by name
  ProgramCache programs(device);  // compiled kernels are kept in ~/.cache/lightgrid
  LightCuller culler(device, programs, {.tile = 16});
  ClGridStorage storage(device);
  culler.set_lights(lights);     // call again when they change
  culler.set_view(make_view());  // call again when the camera moves

  // A renderer that already has its depth in OpenCL passes that buffer instead.
  const cl::Buffer values(device.context(), CL_MEM_READ_ONLY | CL_MEM_COPY_HOST_PTR,
                          depth.size() * sizeof(float), const_cast<float*>(depth.data()));
  const DepthBounds bounds = culler.depth_bounds({values});
  const LightGrid grid = culler.cull(bounds.opaque, storage);

  // storage now holds the grid on the device, for a shading kernel. Here it is read back.
  const HostGrid host = read_grid(device, grid, storage);
  size_t lit = 0, longest = 0;
  for (const glm::uvec2& cell : host.cells) lit += cell.y > 0, longest = std::max<size_t>(longest, cell.y);
  std::printf("%s\n", device.info().name.c_str());
  std::printf("%d x %d tiles, %zu of them with lights\n", grid.cells_x, grid.cells_y, lit);
  std::printf("%zu lights, %zu entries in all lists, %zu in the longest\n", lights.size(),
              host.indices.size(), longest);

  // A pixel's list: the same function finds it in C++, in OpenCL C and in GLSL.
  const uint x = 640, y = 200;
  const glm::uvec2 cell = host.cells[cell_of_pixel(x, y, 16, grid.cells_x)];
  std::printf("pixel %u %u:", x, y);
  for (uint i = 0; i < cell.y; ++i) std::printf(" %u", host.indices[cell.x + i]);
  std::printf("\n");
  return 0;
} catch (const Error& error) {  // wrong input is exit status 2, a machine that cannot do it 3
  std::fprintf(stderr, "cull_depth: %s\n", error.what());
  return error.exit_code();
}
