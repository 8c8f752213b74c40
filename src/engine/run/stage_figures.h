// The figures of a frame's stages (passes/frame_stages.h), for results.json.
#pragma once

#include "passes/common/frame.h"
#include "run/frame_figures.h"

namespace lightgrid {

void add_stage_figures(const FramePlan& plan, const Frame& frame, FrameFigures& figures);

}  // namespace lightgrid
