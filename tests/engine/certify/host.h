// Numbers that the host gives to the kernels.
#pragma once

namespace lightgrid::certify {

// The part of the slopes' offsets by which radii grow: side_slack, or in orthographic views side_slack_m.
double host_side_slack(bool orthographic = false);

// The most by which a view_from_world that check_view accepts lengthens a vector, as a part of it.
double accepted_stretch();

}  // namespace lightgrid::certify
