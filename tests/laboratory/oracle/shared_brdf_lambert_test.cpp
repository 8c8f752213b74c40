#define LAMBERT
#pragma GCC diagnostic ignored "-Wunused-parameter"  // for shading_point
#include "oracle/shared_brdf.h"

namespace lightgrid::lab {
namespace {

TEST(SharedBrdf, LambertIsTheReferencesInFloat) { EXPECT_LT(largest_error(Brdf::lambert, 0), 2e-6); }

}  // namespace
}  // namespace lightgrid::lab
