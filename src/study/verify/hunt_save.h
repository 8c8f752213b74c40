// A losing view of the hunt, with the fewest lights that still lose, as a captured frame (docs/frames.md).
#pragma once

#include <filesystem>

#include "study/verify/hunt_contacts.h"

namespace lightgrid::verify {

// The lights that remain, the lost one among them. Mostly it alone, or with as many others as the loss takes.
struct ShrunkLoss {
  std::vector<Light> lights;
  HuntContact contact;
};
ShrunkLoss shrink_loss(CullEngine& engine, const CullerOptions& options, const HuntView& view, const HuntLights& lights,
                       const HuntContact& lost);

// The frame, and hunt.txt: the setting, the class, the seed and the lost contact in words. Returns the folder.
std::filesystem::path save_loss(const std::filesystem::path& folder, const HuntSetting& setting, const HuntView& view,
                                const ShrunkLoss& loss, uint64_t seed);

}  // namespace lightgrid::verify
