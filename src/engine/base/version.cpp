#include "base/version.h"

namespace lightgrid {

std::string commit_of_build() { return LIGHTGRID_COMMIT; }

std::string version_of_build() { return LIGHTGRID_VERSION; }

}  // namespace lightgrid
