// Reads a part of the last frame to the host, for tests and the oracle: not part of any technique's frame.
#pragma once

#include <algorithm>
#include <array>
#include <compare>
#include <functional>
#include <span>
#include <vector>

#include "base/image.h"
#include "passes/common/frame.h"
#include "scene/listed_lights.h"
#include "scene/triangle_numbers.h"
#include "shared/slices.h"

namespace lightgrid {

// The depth image of the last frame: width * height, row 0 at the bottom, 0 for background. With several
// samples a pixel: at centres, and 0 too where samples and centre do not see one plane.
std::vector<float> read_depth(PassContext& work);

inline constexpr uint32_t no_cell = 0xffffffffu;

// The unsigned integer that `draw` writes at each pixel, else no_cell. Uses the depth image of the last
// frame.
std::vector<uint32_t> indices_drawn(PassContext& work, const std::function<void()>& draw);

// The cell of each pixel that shows an opaque surface, else no_cell. Uses the depth image of the last frame.
std::vector<uint32_t> shaded_cells(PassContext& work);

// The cell of each pixel if it had the given depth, as shaders find it.
std::vector<uint32_t> cells_at_depths(PassContext& work, const std::vector<float>& depths);

// The cells of a light grid that pixels read: compares the depths themselves with the edges' keys
// (shared/slices.h). `view`: with the grid's slices and z-bins. `depth`: a value a pixel of the view, row 0
// at the bottom; outlives it. `tile`: side of a tile, pixels; `across`, `down`: tiles.
class PixelCells {
 public:
  PixelCells(CullView view, const std::vector<float>& depth, uint tile, uint across, uint down);
  int slice(int x, int y) const;
  uint32_t z_bin(int x, int y) const;  // 0 without z-bins
  uint32_t cell(int x, int y) const { return cell(x, y, slice(x, y)); }
  uint32_t cell(int x, int y, int slice) const;
  int width() const { return int(view_.width); }
  int height() const { return int(view_.height); }

 private:
  float key(int x, int y) const;

  CullView view_;
  const std::vector<float>& depth_;
  uint tile_, across_, down_;
  std::array<float, MOST_SLICES> slices_;
  std::array<float, MOST_Z_BINS> z_bins_;
};
PixelCells cells_of_pixels(const ViewState& seen, const std::vector<float>& depth);

// The lists of a grid's cells with each pixel's cell, as the oracle reads them. With z-bins (a word a light,
// shared/slices.h), each pair of a cell and a z-bin that occurs at a pixel has its own list: the cell's
// lights that reach the bin. Entries that are no light stay.
ListedLights at_pixels(ListedLights lists, const PixelCells& cells, std::span<const uint32_t> z_bins);

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
SurfaceImages read_surfaces(PassContext& work);

// The surfaces of the last frame from its geometry buffer; without emission and blended surfaces.
SurfaceImages read_gbuffer_surfaces(PassContext& work);

// A triangle by what it connects and which way it turns, so that two drawings of a mesh in different orders
// can be compared.
struct SceneTriangle {
  int instance = -1;            // number in the scene; -1: nothing
  TriangleVertices vertices{};  // in its mesh
  auto operator<=>(const SceneTriangle&) const = default;
};

// corners: three indices of the mesh.
inline SceneTriangle scene_triangle(int instance, const uint32_t* corners) {
  return {instance, triangle_vertices(corners)};
}

struct ShownTriangles {
  std::vector<SceneTriangle> opaque;  // a pixel each, row 0 at the bottom
  std::vector<bool> blended;          // true where a blended surface lies over it
};

// Draws and reads them. Uses the depth image of the last frame.
ShownTriangles read_triangles(PassContext& work);

}  // namespace lightgrid
