#include "session/frame_shadows.h"

#include "session/oracle.h"
#include "session/shadow_truth.h"
#include "session/surfaces_in_double.h"

namespace lightgrid {

PixelShadows FrameShadows::at(int x, int y, const Scene& scene, const Occlusion& occlusion) const {
  const size_t pixel = view.grid().index(x, y);
  const CastingTriangle own = casting_triangles(scene, {shown[pixel]}).front();
  PixelShadows here{occlusion, {}, shaded ? &*shaded : nullptr};
  if (own.instance >= 0) here.receiver = occlusion.receiver(view, x, y, double(depth[pixel]), own);
  return here;
}

FrameShadows read_frame_shadows(TechniqueRun& run) {
  FrameShadows frame{run.view().view, read_depth(run), shown_triangles(run), {}};
  if (run.frame().shadows) frame.shaded = run.frame().shadows();
  return frame;
}

}  // namespace lightgrid
