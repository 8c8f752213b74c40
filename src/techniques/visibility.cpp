// Triangle numbers first, in OpenCL; then attributes, textures and light of each pixel in one pass, from its
// tile's list.
#include "passes/cull_lights.h"
#include "passes/depth_bounds.h"
#include "passes/resolve.h"
#include "techniques/technique.h"

namespace lightgrid {

static Frame render(RenderView& v) {
  Frame frame;
  const VisibilityBuffer visible = rasterize(v);
  frame.depth = visible.depth();
  frame.triangles = visible.triangles();
  DepthBounds bounds;
  GridInCl lights;
  if (v.plan.light_grid) {
    bounds = depth_bounds(v, *frame.depth);
    frame.grid = cull_lights(v, bounds);
    lights = {&*frame.grid, &v.opaque_grid()};
  }
  frame.image = resolve(v, visible, lights);
  blend_resolved_from_grid(v, bounds, frame);
  return frame;
}

extern const Technique visibility{
    .name = "visibility",
    .summary = "a visibility buffer, resolved and lit in OpenCL from per-tile light lists",
    .source = "Burns, Hunt: The Visibility Buffer, JCGT 2013",
    .needs = {.light_grid = true,
              .given_slices = true,
              .lists = true,
              .z_bins = true,
              .opengl = false,
              .chosen_lights = true},
    .settings = {"brdf", "cull-test", "depth-bounds", "tile", "slices", "slice-spacing", "z-bins", "lights",
                 "texels", "kernel-shape", "portable", "group-size"},
    .render = render};

}  // namespace lightgrid
