// Which commit the program was built from.
#pragma once

#include <string>

namespace lightgrid {

// Short hash of the commit that this program was built from, "-dirty" if with changes; "unknown" outside git.
std::string commit_of_build();

}  // namespace lightgrid
