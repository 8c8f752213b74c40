// Test input that is not part of the project: scenes and frames in a folder named shared beside the checkout.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "support/paths.h"

namespace lightgrid {

inline std::filesystem::path shared_folder() {
  const char* given = std::getenv("LIGHTGRID_SHARED");
  return given ? given : default_shared_folder;
}

}  // namespace lightgrid

// First line of a test that needs it: skips with a message if it is absent.
#define LIGHTGRID_NEEDS_SHARED(relative)                                 \
  if (!std::filesystem::exists(lightgrid::shared_folder() / (relative))) \
  GTEST_SKIP() << "needs " << lightgrid::shared_folder() / (relative) << ", which is absent"
