// A losing view of the hunt, reduced to the fewest lights that still lose one, as a captured frame
// (docs/frames.md).
#pragma once

#include <filesystem>

#include "verify/hunt_losses.h"

namespace lightgrid::verify {

// The remaining lights, with the lost one among them: usually it alone, else with the others that the loss
// requires.
struct ShrunkLoss {
  std::vector<Light> lights;
  HuntLoss lost;
  HostGrid grid;  // of these lights
};
ShrunkLoss shrink_loss(CullEngine& engine, const CullerOptions& options, const HuntView& view,
                       const std::vector<Light>& lights, const HuntLoss& lost);

// The frame with its grid (slices and z-bins included), and hunt.txt: the setting, the class, the seed and
// the lost contact as text. Returns the folder. A frame cannot store samples other than the contact's, cells
// of whole pixels, blended surfaces and the width of indices; one with an oblique near plane is refused when
// read.
std::filesystem::path save_loss(const std::filesystem::path& folder, const HuntSetting& setting,
                                const HuntView& view, const ShrunkLoss& loss, uint64_t seed);

}  // namespace lightgrid::verify
