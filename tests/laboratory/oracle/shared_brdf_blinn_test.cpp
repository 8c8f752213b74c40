#define BLINN
#include "oracle/shared_brdf.h"

namespace lightgrid::lab {
namespace {

TEST(SharedBrdf, BlinnIsTheReferencesInFloat) {
  EXPECT_LT(largest_error(Brdf::blinn, 0.3), 2e-5);
  EXPECT_LT(largest_error(Brdf::blinn, 0), 2e-3);  // an exponent of 488,000 does
}

}  // namespace
}  // namespace lightgrid::lab
