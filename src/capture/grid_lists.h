// Lists as shading goes through them: out of masks, and without what z-bins pass over.
#pragma once

#include <span>

#include "reference/lit_set.h"

namespace lightgrid {

// Those of `cells` cells, in which light i is bit i % 32 of word i / 32, as lists.first, count and indices.
void add_masks(std::span<const uint32_t> masks, size_t cells, ListedLights& lists);

// Gives each pair of a cell and a z-bin that some pixel has a list of its own: the lights of the cell's that the bin holds.
// `bin_of_pixel` goes with lists.cell_of_pixel; z_bins: a word a light (shared/slices.h). Entries that are no light stay.
ListedLights in_z_bins(const ListedLights& lists, std::span<const uint32_t> bin_of_pixel, std::span<const uint32_t> z_bins);

}  // namespace lightgrid
