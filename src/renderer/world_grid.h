// The world grid of a scene (src/world_grid), in memory that OpenGL reads too. GpuScene::world_grid shares
// it.
#pragma once

#include "renderer/renderer.h"
#include "scene/camera.h"
#include "scene/light_ranges.h"
#include "world_grid/world_grid.h"

namespace lightgrid {

class SharedWorldGridStorage;

// Lists of the same key and lights are the same.
struct WorldGridKey {
  WorldGridShape shape;
  std::optional<double> cell;  // the setting world-cell; none: auto
  int index_bits;
  LightRanges ranges;
  bool for_gl = true;  // else OpenCL alone reads them
  bool operator==(const WorldGridKey&) const = default;
};

WorldEye world_eye(const View& view);
WorldViewParams world_view_params(const WorldLayout& layout, const View& view);

class SharedWorldGrid : public WorldGrid {
 public:
  // for_gl: OpenGL may read the lists too, whose memory is then that of the renderer's bridge.
  SharedWorldGrid(Renderer& renderer, WorldGridShape shape, std::optional<double> cell, int index_bits,
                  bool for_gl = true);

  // For a view.
  bool serves(const View& view, int lights_version) {
    return WorldGrid::serves(world_eye(view), lights_version);
  }
  void build(std::span<const CullLight> lights, const WorldBox& bounds, const View& view,
             int lights_version) {
    WorldGrid::build(lights, bounds, world_eye(view), lights_version);
  }

  // Makes the lists visible to OpenGL, once a build. Only with for_gl.
  void hand_to_gl();

  // Buffer textures and the uniform block of the params, after hand_to_gl.
  GLuint texture(WorldArray array) const;
  GLuint block() const { return block_.name(); }

 private:
  SharedWorldGrid(Renderer& renderer, SharedWorldGridStorage* storage, WorldGridShape shape,
                  std::optional<double> cell, int index_bits);

  SharedWorldGridStorage* shared_;  // the grid's storage
  GlBuffer block_;
  int in_gl_ = 0;  // builds and updates that OpenGL has seen
};

}  // namespace lightgrid
