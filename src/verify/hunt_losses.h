// Contacts of the hunt that a grid has lost.
#pragma once

#include "verify/hunt_contacts.h"

namespace lightgrid::verify {

// The place where the light is missing: its cell's list, the cell's mask, or the light's z-bins.
enum class LostFrom { list, mask, z_bins };
const char* name_of(LostFrom from);

struct HuntLoss {
  HuntContact contact;
  LostFrom from = LostFrom::list;
};

// Contacts whose light is missing from the list (or the mask, or the z-bin) that shading finds for the pixel.
std::vector<HuntLoss> lost_contacts(const HuntView& view, std::span<const HuntContact> contacts, int tile,
                                    const HostGrid& grid);

}  // namespace lightgrid::verify
