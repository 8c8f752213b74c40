#include "study/capture.h"

#include "study/oracle.h"

namespace lightgrid {

CapturedFrame capture_frame(Devices& devices, const Scene& scene, const View& view,
                            const Settings& settings) {
  Frame frame(devices, scene, view, plan_frame(scene, view, settings, find_technique("forward_plus").needs));
  depth_prepass(frame);
  return {scene.name, view, settings.tile, frame.plan.slice_far_m, scene.lights, read_depth(frame)};
}

}  // namespace lightgrid
