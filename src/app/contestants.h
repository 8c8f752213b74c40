// --set and --compare: the combinations of settings that a command runs.
#pragma once

#include <string>
#include <vector>

#include "bench/bench.h"

namespace lightgrid {

// Every combination of the values in the comparisons ("KEY=A,B"), applied to `base`; `base` alone if there
// are none. Throws Error(input) past `most` combinations.
std::vector<BenchContestant> contestants_of(const Settings& base, const std::vector<std::string>& comparisons,
                                            size_t most);

// The same for settings that culling reads. Throws Error(input) for others, whose values would all run the
// same.
std::vector<BenchContestant> culling_contestants(const Settings& base, const std::vector<std::string>& comparisons,
                                                 size_t most);

}  // namespace lightgrid
