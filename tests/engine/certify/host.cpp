#include "certify/host.h"

#include <cmath>

#include "culling/cull_view.h"

namespace lightgrid::certify {

double host_side_slack(bool orthographic) {
  CullView view{1280, 720, glm::dmat4(0), glm::dmat4(1)};
  glm::dmat4& clip = view.clip_from_view;
  clip[0][0] = 0.7, clip[1][1] = 1.3;
  clip[orthographic ? 3 : 2][0] = 0.4;
  if (orthographic)
    clip[2][2] = 0.01, clip[3][3] = 1;
  else
    clip[2][3] = -1, clip[3][2] = 0.1;
  check_view(view, 16);
  const CullParams p = cull_params(view, 16);
  return double(orthographic ? p.side_slack_m : p.side_slack) /
         (std::abs(double(p.slope_x_offset)) + std::abs(double(p.slope_y_offset)));
}

}  // namespace lightgrid::certify
