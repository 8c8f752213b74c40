// Checks of CullerOptions.
#pragma once

#include "culling/light_culler.h"

namespace lightgrid {

// Throws Error(input) that names the option, its value and the allowed values.
void check_options(const CullerOptions& options);

}  // namespace lightgrid
