#include "effects/effects.h"

namespace lightgrid {

extern const Effect far_light;

static constexpr const Effect* effects[] = {&far_light};
constinit const Effects all_effects = effects;

}  // namespace lightgrid
