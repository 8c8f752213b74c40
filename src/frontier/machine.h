// The machine that a part was measured on.
#pragma once

#include "frontier/record.h"
#include "renderer/renderer.h"

namespace lightgrid {

FrontierMachine machine_of(const Renderer& renderer);
double load_average();  // of the last minute; 0: unknown

}  // namespace lightgrid
