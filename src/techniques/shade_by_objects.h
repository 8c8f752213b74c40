// The frame that forward_multipass and forward_zprepass share; they differ in the lights of a draw.
#pragma once

#include "techniques/technique.h"

namespace lightgrid {

// Each object with the lights that reach its visible part, `lights_a_draw` in each draw, added up; then
// blended surfaces. own_apart: the first draw has base lighting alone.
Frame shade_by_objects(RenderView& v, uint32_t lights_a_draw, bool own_apart);

}  // namespace lightgrid
