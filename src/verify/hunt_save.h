// A losing view of the hunt, with the fewest lights that still lose, as a captured frame (docs/frames.md).
#pragma once

#include <filesystem>

#include "verify/hunt_losses.h"

namespace lightgrid::verify {

// The lights that remain, the lost one among them. Mostly it alone, or with as many others as the loss takes.
struct ShrunkLoss {
  std::vector<Light> lights;
  HuntLoss lost;
  HostGrid grid;  // of these lights
};
ShrunkLoss shrink_loss(CullEngine& engine, const CullerOptions& options, const HuntView& view, const std::vector<Light>& lights,
                       const HuntLoss& lost);

// The frame with its grid (slices and z-bins included), and hunt.txt: the setting, the class, the seed and the lost contact
// in words. Returns the folder. What a frame cannot hold: samples but the contact's own, cells of whole pixels, the width of
// indices.
std::filesystem::path save_loss(const std::filesystem::path& folder, const HuntSetting& setting, const HuntView& view,
                                const ShrunkLoss& loss, uint64_t seed);

}  // namespace lightgrid::verify
