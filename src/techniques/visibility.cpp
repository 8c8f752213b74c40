// Triangle numbers first, in OpenCL; then attributes, textures and light of each pixel in one pass, from its
// tile's list.
#include "passes/cull_lights.h"
#include "passes/depth_bounds.h"
#include "passes/resolve.h"
#include "techniques/technique.h"

namespace lightgrid {

// Over the frame's image, from a grid of their own, whose cells begin at the near plane; where there are no
// depth bounds, from that of opaque ones.
static void blend(RenderView& v, const DepthBounds& bounds, Frame& frame) {
  if (v.plan.blended.empty()) return;
  if (v.plan.blend_grid) frame.blend_grid = cull_lights_for_blended(v, bounds);
  GridInCl lights;
  if (v.plan.light_grid) lights = {&*frame.grid, &v.opaque_grid()};
  if (v.plan.blend_grid) lights = {&*frame.blend_grid, &v.blend_grid()};
  blend_resolved(v, list_blended(v), *frame.depth, lights);
}

static Frame render(RenderView& v) {
  Frame frame;
  const VisibilityBuffer visible = rasterize(v);
  frame.depth = visible.depth();
  frame.triangles = TriangleBuffer{visible.image.triangle};
  DepthBounds bounds;
  GridInCl lights;
  if (v.plan.light_grid) {
    bounds = depth_bounds(v, *frame.depth);
    frame.grid = cull_lights(v, bounds);
    lights = {&*frame.grid, &v.opaque_grid()};
  }
  frame.image = resolve(v, visible, lights);
  blend(v, bounds, frame);
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
    .render = render,
    .own_surfaces = true};

}  // namespace lightgrid
