#include "oracle/shared_brdf.h"

namespace lightgrid::lab {
namespace {

TEST(SharedBrdf, GgxIsTheReferencesInFloat) {
  EXPECT_LT(largest_error(Brdf::ggx, 0.3), 2e-5);
  EXPECT_LT(largest_error(Brdf::ggx, 0), 2e-3);  // a peak of 1 / alpha^2 = 244,000 multiplies roundings
}

}  // namespace
}  // namespace lightgrid::lab
