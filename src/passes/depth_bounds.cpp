// The depth image goes over to OpenCL, which reduces it to an interval of distances per tile.
#include "passes/passes.h"

namespace lightgrid {

cl::Buffer& depth_to_cl(Frame& f, const DepthImage& depth) {
  const size_t bytes = size_t(f.view.width) * f.view.height * 4;
  auto pass = f.timer.pass("depth_to_cl", "gl");
  glBindFramebuffer(GL_READ_FRAMEBUFFER, depth.framebuffer);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, f.depth_copy().gl_buffer());
  glReadPixels(0, 0, f.view.width, f.view.height, GL_DEPTH_COMPONENT, GL_FLOAT, nullptr);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  f.depth_copy().hand_to_cl(bytes);
  pass.moves(bytes, bytes);
  return f.depth_copy().cl_buffer();
}

DepthBounds depth_bounds(Frame& f, const DepthImage& depth) {
  if (f.plan.settings.depth_bounds == DepthBoundsMode::none) {
    return f.culler().depth_bounds({});
  }
  cl::Buffer& values = depth_to_cl(f, depth);
  auto pass = f.timer.pass("depth_bounds", "cl");
  pass.moves(size_t(f.view.width) * f.view.height * 4, size_t(f.params.tiles_x) * f.params.tiles_y * 8);
  return f.culler().depth_bounds({values});
}

TileDistances tile_distances(Frame& f, const DepthBounds& bounds) {
  TileDistances distances;
  if (f.plan.settings.depth_bounds == DepthBoundsMode::none) return distances;
  auto pass = f.timer.pass("tile_distances", "cl");
  distances.intervals = f.culler().read_bounds(bounds.opaque);
  const size_t bytes = distances.intervals.size() * sizeof(DepthInterval);
  pass.moves(bytes, bytes);
  return distances;
}

}  // namespace lightgrid
