// Which CullerOptions there are.
#pragma once

#include "culling/light_culler.h"

namespace lightgrid {

// Throws Error(input) that names the option, its value and those that it may have.
void check_options(const CullerOptions& options);

}  // namespace lightgrid
