// Every light at every pixel: the brute-force image that every other technique is compared with.
#include "base/error.h"
#include "passes/depth_prepass.h"
#include "passes/shade_forward.h"
#include "techniques/recipes.h"

namespace lightgrid {

static const Setting<bool> prepass{
    15,
    "prepass",
    "whether depth is drawn first, so that each pixel is shaded once; off: hidden surfaces that are drawn "
    "before the visible one are shaded too (overdraw)",
    {{"on", true}, {"off", false}}};

static Frame shade_with_overdraw(RenderView& v) {
  if (v.plan.shadows.light_reaches)
    throw input_error(
        "forward: shadows are found at the surfaces of a depth prepass; use prepass=on, or shadows=none");
  const Surfaces surfaces{.image = no_depth_yet(v), .drawn = v.opaque};
  const LightSource lights = every_light(v);
  Frame frame = frame_of(v, surfaces);
  frame.image = shade_forward_and_depth(v, surfaces.drawn, lights);
  blend(v, surfaces, lights, frame.image);
  return frame;
}

extern const Technique forward{.name = "forward",
                               .summary = "every light at every pixel",
                               .source = "the baseline",
                               .needs = {.effects = all_effects, .samples = {.most = 8}},
                               .settings = {"brdf", "prepass", "depth-bounds", "tile", "samples",
                                            "samples-masks", "samples-resolve", "kernel-shape"},
                               .render = [](RenderView& v) {
                                 return v.plan.settings[prepass] ? shade_every_light(v, find_surfaces(v))
                                                                 : shade_with_overdraw(v);
                               }};

}  // namespace lightgrid
