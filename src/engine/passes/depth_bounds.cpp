// Hands the depth image to OpenCL, which reduces it to an interval of distances a tile.
#include "passes/depth_bounds.h"

#include "plan/settings/grid.h"

namespace lightgrid {

DepthBuffer depth_to_cl(PassContext& work, const DepthImage& depth) {
  const size_t bytes = work.grid().values() * 4;
  auto pass = work.timer.pass("depth_to_cl", "gl");
  SharedBuffer& copy = work.shared_samples("depth", 4);
  work.renderer.pixel_copies.to_buffer({depth.framebuffer, GL_DEPTH_ATTACHMENT, work.targets.depth()},
                                       GL_DEPTH_COMPONENT, GL_FLOAT, work.grid(), copy.gl_buffer());
  copy.hand_to_cl(bytes);
  pass.moves(bytes, bytes);
  return {copy.cl_buffer()};
}

DepthBounds depth_bounds(PassContext& work, LightCuller& culler, const DepthBuffer& depth) {
  if (work.plan.settings[setting::depth_bounds] == DepthBoundsMode::none) return culler.depth_bounds({});
  auto pass = work.timer.pass("depth_bounds", "cl");
  pass.moves(work.grid().values() * 4, size_t(work.params.tiles_x) * work.params.tiles_y * 8);
  return culler.depth_bounds({depth.values});
}

TileDistances tile_distances(PassContext& work, LightCuller& culler, const DepthBounds& bounds) {
  TileDistances distances;
  if (work.plan.settings[setting::depth_bounds] == DepthBoundsMode::none) return distances;
  auto pass = work.timer.pass("tile_distances", "cl");
  distances.intervals = culler.read_bounds(bounds.opaque);
  const size_t bytes = distances.intervals.size() * sizeof(DepthInterval);
  pass.moves(bytes, bytes);
  return distances;
}

DrawList visible_surfaces(PassContext& work, const TileDistances& distances) {
  return without_hidden(work.opaque, work.gpu.in_gl(), work.transforms, work.params, distances);
}

}  // namespace lightgrid
