// Radiance under the lists of lights, or other sources of lights, of kernels/resolve/resolve_light.h.
#pragma once

#include "kernels/resolve/resolve_light.h"

#define OUTPUT_LIST(X)
DECLARE_OUTPUT;
#define SHOWS_LIGHT(output) true
#define NEEDS_EVERY_PIXEL false

STORE_RESOLVED {}
LIGHT_OF { return radiance(resolved, lights, bin_edges, view); }
