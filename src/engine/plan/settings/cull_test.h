// The test of light culling.
#pragma once

#include "plan/settings.h"
#include "shared/cull_tests.h"

namespace lightgrid::setting {

inline const Setting<CullTest> cull_test{80, "cull-test",
                                         "the test that decides whether a light may touch a cell",
                                         choices_of(cull_tests, &CullTestRow::test, default_cull_test)};

}  // namespace lightgrid::setting
