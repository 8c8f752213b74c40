// The relative errors again, proved by Gappa (Melquiond): a script for each distinct expression of the kernels' paths.
// Signs of terms come from the paths (sign_of).
#pragma once

#include <cstddef>
#include <vector>

#include "certify/real.h"

namespace lightgrid::certify {

bool has_gappa();

struct Proved {
  size_t scripts = 0;
  double largest = 0;  // relative error; infinite where one has no proof
};

// Scripts of all results that `skip` does not leave out.
Proved prove_by_gappa(const std::vector<Path>& paths, const std::function<bool(const Path&)>& skip);

}  // namespace lightgrid::certify
