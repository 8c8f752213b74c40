// All effects, ordered by name as in the text shared/effects.h: kernels take their inputs in this order.
#pragma once

#include "plan/effect.h"

namespace lightgrid {

extern const Effects all_effects;

}  // namespace lightgrid
