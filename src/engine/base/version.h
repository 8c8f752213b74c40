// Which commit the program was built from.
#pragma once

#include <string>

namespace lightgrid {

// Short hash of the commit that this program was built from, "-dirty" if with changes; "unknown" outside git.
std::string commit_of_build();

std::string version_of_build();  // "0.1.0"

}  // namespace lightgrid
