// Times of several machines as times of one.
#pragma once

#include <vector>

#include "frontier/record.h"

namespace lightgrid {

// Records whose times may be compared: those of another kind of machine (devices, drivers, processor,
// threads) are multiplied by how much longer or shorter the same baseline took on the first kind of machine
// that measured the scene, over the views that both have. Ratios stay as they are. Where no view is on both,
// pass_ms is emptied. Records of one kind of machine are returned unchanged. `machines`: one a part, by its
// shard.
std::vector<FrontierRecord> on_one_machine(std::vector<FrontierRecord> records,
                                           const std::vector<FrontierMachine>& machines);

}  // namespace lightgrid
