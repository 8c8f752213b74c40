// Numbers that the host gives to the kernels.
#pragma once

namespace lightgrid::certify {

// The part of the slopes' offsets by which radii grow: side_slack, or in orthographic views side_slack_m.
double host_side_slack(bool orthographic = false);

}  // namespace lightgrid::certify
