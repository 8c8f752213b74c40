// What the host reads of the last frame, for tests and the oracle: not part of any technique's frame.
#pragma once

#include <algorithm>
#include <array>
#include <compare>
#include <functional>
#include <vector>

#include "base/image.h"
#include "passes/common/frame.h"

namespace lightgrid {

// The depth image of the last frame: width * height, row 0 at the bottom, 0 for background.
std::vector<float> read_depth(Work& work);

inline constexpr uint32_t no_cell = 0xffffffffu;

// The unsigned integer that `draw` writes at each pixel, else no_cell. Uses the depth image of the last
// frame.
std::vector<uint32_t> indices_drawn(Work& work, const std::function<void()>& draw);

// The cell of each pixel that shows an opaque surface, else no_cell. Uses the depth image of the last frame.
std::vector<uint32_t> shaded_cells(Work& work);

// The cell of the light grid that shading reads at each pixel, from the depth of the frame's surfaces.
std::vector<uint32_t> cells_of_pixels(const Seen& seen, const std::vector<float>& depth);

// The pixel's z-bin: 0 without z-bins.
std::vector<uint32_t> z_bins_of_pixels(const Seen& seen, const std::vector<float>& depth);

// The cell of each pixel if it had the given depth, as shaders find it.
std::vector<uint32_t> cells_at_depths(Work& work, const std::vector<float>& depths);

struct SurfaceImages {
  Image normal_roughness;  // view-space shading normal; perceptual roughness
  Image base_color_metallic;
  Image emissive_occlusion;                  // occlusion -1: unlit
  Image coat_normal_roughness, coat_factor;  // as above; red. Empty if no material in view has a coat
  Image model;  // red: the number. Empty if no material in view has a model but Lambert's
  std::vector<MaterialModel> models;  // by number
  Image specular;  // f0, f90 of the dielectric part. Empty if no material in view has another than 0.04, 1
  std::vector<bool> blended;  // pixels covered by a blended surface
};

// Draws and reads them. Uses the depth image of the last frame.
SurfaceImages read_surfaces(Work& work);

// The surfaces of the last frame from its geometry buffer; without emission and blended surfaces.
SurfaceImages read_gbuffer_surfaces(Work& work);

// A triangle by what it connects and which way it turns, so that two drawings of a mesh in different orders
// can be compared.
struct SceneTriangle {
  int instance = -1;  // of the scene; -1: nothing
  // Of its mesh, in the order of the mesh, which side faces front included; the least one first.
  std::array<uint32_t, 3> vertices{};
  auto operator<=>(const SceneTriangle&) const = default;
};

// corners: three indices of the mesh.
inline SceneTriangle scene_triangle(int instance, const uint32_t* corners) {
  SceneTriangle triangle{instance, {corners[0], corners[1], corners[2]}};
  std::ranges::rotate(triangle.vertices, std::ranges::min_element(triangle.vertices));
  return triangle;
}

struct ShownTriangles {
  std::vector<SceneTriangle> opaque;  // a pixel each, row 0 at the bottom
  std::vector<bool> blended;          // whether a blended surface lies over it
};

// Draws and reads them. Uses the depth image of the last frame.
ShownTriangles read_triangles(Work& work);

}  // namespace lightgrid
