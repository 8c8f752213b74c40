// What world_grid.cpp and world_update.cpp share.
#pragma once

#include "cl/launch.h"
#include "renderer/world_grid.h"

namespace lightgrid {

uint64_t most_world_count(ClDevice& device, size_t bytes_each);
// Throws Error(machine) if the device gives no buffer that large, or if there are more than 32 bits count.
void check_world_count(ClDevice& device, const char* what, uint64_t count, size_t bytes_each);

void WorldGrid::run(const char* name, size_t items, const auto&... arguments) {
  const std::string label = std::string("world_") + name;
  std::string defines;
  if (label == "world_lists" || label == "world_update") {
    if (shape_ == WorldGridShape::columns) defines += " -DCOLUMNS";
    if (index_bits_ == 32) defines += " -DINDEX_32";
  }
  cl::Kernel kernel = renderer_.kernels->kernel("world_grid/" + label, defines);
  const size_t group = renderer_.cl->info().cpu ? 1 : 64;
  launch(*renderer_.cl, label, kernel, cl::NDRange((items + group - 1) / group * group), cl::NDRange(group),
         arguments...);
}

}  // namespace lightgrid
