// Lower bounds of each kernel's memory traffic and arithmetic, for its limit.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace lightgrid {

struct KernelWork {
  size_t pixels = 0, tiles = 0, cells = 0, bins = 0, lights = 0;  // a tile has one cell a slice
  size_t indices = 0, index_bytes = 0;                            // entries of the grid's lists, and their
                                                                  // total size
  size_t mask_bytes = 0, z_bins = 0;
  bool exact = false, cones = false;
  // The rasteriser has these (its tiles are 64 x 64 pixels): vertices and triangles of all instances, drawn
  // or not, and RasterCounts.
  size_t vertices = 0, triangles = 0, clusters = 0, records = 0, tile_entries = 0;
};

struct KernelCost {
  double bytes = 0, flops = 0;
};

// By the label of a launch; empty if the table does not contain it.
std::optional<KernelCost> kernel_cost(const std::string& label, const KernelWork& work);

}  // namespace lightgrid
