// Lists as shading reads them: from masks, and without lights that z-bins skip.
#pragma once

#include <span>

#include "scene/listed_lights.h"

namespace lightgrid {

// Converts the masks of `cells` cells, where light i is bit i % 32 of word i / 32, to lists.first, count and
// indices.
void add_masks(std::span<const uint32_t> masks, size_t cells, ListedLights& lists);

// Gives each pair of a cell and a z-bin that occurs at a pixel its own list: the cell's lights that reach the
// bin. `bin_of_pixel` parallels lists.cell_of_pixel; z_bins: a word a light (shared/slices.h). Entries that
// are no light stay.
ListedLights in_z_bins(const ListedLights& lists, std::span<const uint32_t> bin_of_pixel,
                       std::span<const uint32_t> z_bins);

}  // namespace lightgrid
