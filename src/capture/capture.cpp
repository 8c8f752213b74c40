#include "capture/capture.h"

#include "passes/depth_prepass.h"
#include "passes/read_outs/depth.h"

namespace lightgrid {

CapturedFrame capture_frame(Renderer& renderer, const Scene& scene, const View& view,
                            const Settings& settings) {
  GpuScene gpu(renderer, scene);
  RenderView seen(renderer, gpu, view, settings, find_technique("forward_plus").needs);
  depth_prepass(seen);
  return {scene.name, view, settings.tile, seen.plan.slice_far_m, scene.lights, read_depth(seen)};
}

}  // namespace lightgrid
