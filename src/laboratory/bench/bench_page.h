// The page of `lightgrid bench`: one self-contained HTML file.
#pragma once

#include "bench/bench.h"

namespace lightgrid::lab {

// A table per case, in which a bar shows each median and the part of it that the machine's limit explains.
std::string bench_page(const BenchReport& report);

}  // namespace lightgrid::lab
