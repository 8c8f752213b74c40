// --set and --compare: which settings a command runs beside each other.
#pragma once

#include <string>
#include <vector>

#include "bench/bench.h"

namespace lightgrid {

// Every combination of the values that the comparisons ("KEY=A,B") give, on top of `base`; `base` alone where there
// are none. Throws Error(input) past `most` combinations.
std::vector<BenchContestant> contestants_of(const Settings& base, const std::vector<std::string>& comparisons,
                                            size_t most);

// Of settings that culling reads. Throws Error(input) for another one: its values would all run the same.
std::vector<BenchContestant> culling_contestants(const Settings& base, const std::vector<std::string>& comparisons,
                                                 size_t most);

}  // namespace lightgrid
