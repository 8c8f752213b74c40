#include "certify/host.h"

#include <cmath>

#include "base/error.h"
#include "culling/cull_view.h"

namespace lightgrid::certify {

namespace {

CullView view_of(bool orthographic) {
  CullView view{1280, 720, glm::dmat4(0), glm::dmat4(1)};
  glm::dmat4& clip = view.clip_from_view;
  clip[0][0] = 0.7, clip[1][1] = 1.3;
  clip[orthographic ? 3 : 2][0] = 0.4;
  if (orthographic)
    clip[2][2] = 0.01, clip[3][3] = 1;
  else
    clip[2][3] = -1, clip[3][2] = 0.1;
  return view;
}

bool is_accepted(const CullView& view) {
  try {
    check_view(view, 16);
    return true;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace

double host_side_slack(bool orthographic) {
  const CullView view = view_of(orthographic);
  check_view(view, 16);
  const CullParams p = cull_params(view, 16);
  return double(orthographic ? p.side_slack_m : p.side_slack) /
         (std::abs(double(p.slope_x_offset)) + std::abs(double(p.slope_y_offset)));
}

// The largest eigenvalue of M M^T - 1 is at most three times its largest entry, and is that where all entries are equal:
// M = 1 + a J with 2 a + 3 a^2 in each entry, J of ones.
double accepted_stretch() {
  double accepted = 0, refused = 1;
  for (int step = 0; step < 200; ++step) {
    const double entry = (accepted + refused) / 2, a = (std::sqrt(1 + 3 * entry) - 1) / 3;
    CullView view = view_of(false);
    for (int column = 0; column < 3; ++column)
      for (int row = 0; row < 3; ++row) view.view_from_world[column][row] += a;
    (is_accepted(view) ? accepted : refused) = entry;
  }
  return std::sqrt(1 + 3 * refused) - 1;
}

}  // namespace lightgrid::certify
