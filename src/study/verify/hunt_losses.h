// Which contacts of the hunt a grid has lost.
#pragma once

#include "study/verify/hunt_contacts.h"

namespace lightgrid::verify {

// Contacts whose light is not in the list (and the mask, and the z-bin) that shading finds for the pixel.
std::vector<HuntContact> lost_contacts(const HuntView& view, std::span<const HuntContact> contacts, int tile,
                                       const HostGrid& grid);

}  // namespace lightgrid::verify
