// The least that each kernel must move and compute, for its limit.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace lightgrid {

struct KernelWork {
  size_t pixels = 0, tiles = 0, cells = 0, bins = 0, lights = 0;  // a tile has a cell for each slice
  size_t indices = 0, index_bytes = 0;                            // entries of the grid's lists, and their size in all
  size_t mask_bytes = 0, z_bins = 0;
  bool exact = false, cones = false;
};

struct KernelCost {
  double bytes = 0, flops = 0;
};

// By the label of a launch; nothing for a label that the table does not hold.
std::optional<KernelCost> kernel_cost(const std::string& label, const KernelWork& work);

}  // namespace lightgrid
