// Hands the depth image to OpenCL, which reduces it to an interval of distances a tile.
#include "passes/depth_bounds.h"

namespace lightgrid {

DepthBuffer depth_to_cl(RenderView& v, const DepthImage& depth) {
  const size_t bytes = v.pixels() * 4;
  auto pass = v.timer.pass("depth_to_cl", "gl");
  SharedBuffer& copy = v.shared_pixels("depth", 4);
  v.renderer.pixel_copies.to_buffer({depth.framebuffer, GL_DEPTH_ATTACHMENT, v.targets.depth()},
                                    GL_DEPTH_COMPONENT, GL_FLOAT, v.view.width, v.view.height,
                                    copy.gl_buffer());
  copy.hand_to_cl(bytes);
  pass.moves(bytes, bytes);
  return {copy.cl_buffer()};
}

DepthBounds depth_bounds(RenderView& v, const DepthBuffer& depth) {
  if (v.plan.settings.depth_bounds == DepthBoundsMode::none) return v.culler().depth_bounds({});
  auto pass = v.timer.pass("depth_bounds", "cl");
  pass.moves(v.pixels() * 4, size_t(v.params.tiles_x) * v.params.tiles_y * 8);
  return v.culler().depth_bounds({depth.values});
}

TileDistances tile_distances(RenderView& v, const DepthBounds& bounds) {
  TileDistances distances;
  if (v.plan.settings.depth_bounds == DepthBoundsMode::none) return distances;
  auto pass = v.timer.pass("tile_distances", "cl");
  distances.intervals = v.culler().read_bounds(bounds.opaque);
  const size_t bytes = distances.intervals.size() * sizeof(DepthInterval);
  pass.moves(bytes, bytes);
  return distances;
}

DrawList visible_surfaces(RenderView& v, const TileDistances& distances) {
  return without_hidden(v.opaque, v.gpu.in_gl(), v.transforms, v.params, distances);
}

}  // namespace lightgrid
