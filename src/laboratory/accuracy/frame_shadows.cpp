#include "accuracy/frame_shadows.h"

#include "accuracy/oracle.h"
#include "accuracy/shadow_truth.h"
#include "accuracy/surfaces_in_double.h"
#include "plan/settings/shadows.h"

namespace lightgrid::lab {

PixelShadows FrameShadows::at(int x, int y, SceneOcclusion& occlusion) const {
  const size_t pixel = view.grid().index(x, y);
  const CastingTriangle own = casting_triangles(occlusion.scene(), {shown[pixel]}).front();
  PixelShadows here{occlusion.get(by_blended), {}, shaded ? &*shaded : nullptr};
  if (own.instance >= 0) here.receiver = here.occlusion.receiver(view, x, y, double(depth[pixel]), own);
  return here;
}

FrameShadows read_frame_shadows(TechniqueRun& run) {
  const RenderView& v = run.view();
  FrameShadows frame{
      v.view, read_depth(run), shown_triangles(run), {}, v.plan.settings[setting::shadow_blended]};
  if (run.frame().shadows) frame.shaded = run.frame().shadows();
  return frame;
}

}  // namespace lightgrid::lab
