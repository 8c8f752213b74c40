#include "session/frame_shadows.h"

#include "session/oracle.h"
#include "session/surfaces_in_double.h"

namespace lightgrid {

FrameShadows::FrameShadows(Renderer& renderer, const Scene& scene, const View& view, const Settings& settings,
                           const Technique& technique)
    : run_(renderer, scene, view, settings, technique), truth_(scene, most_pairs) {
  run_.draw_frame();
  depth_ = read_depth(run_), shown_ = shown_triangles(run_);
  if (run_.frame().shadows) shaded_ = run_.frame().shadows();
}

std::optional<SightAnswer> FrameShadows::sight(int x, int y, size_t light) {
  const Seen& v = run_.view();
  const size_t pixel = v.view.grid().index(x, y);
  const CastingTriangle own = casting_triangles(v.scene, {shown_[pixel]}).front();
  if (own.instance < 0) return {};
  const Occlusion& occlusion = truth_.occlusion(v.plan.settings.shadow_blended);
  return occlusion.sight(v.scene.lights[light],
                         occlusion.receiver(v.view, x, y, double(depth_[pixel]), own));
}

bool FrameShadows::shaded_as_hidden(int x, int y, uint32_t local) const {
  return shaded_ && hidden_at(*shaded_, x, y, local);
}

PairShadows FrameShadows::pairs() {
  return {*truth_.pairs(run_.view(), depth_, shown_), shaded_ ? &*shaded_ : nullptr};
}

}  // namespace lightgrid
