#include "certify/powers.h"

namespace lightgrid::certify {
namespace {

TEST(CertifyPowers, Log2IsWithinItsBound) { expect_bound_of_log2(); }
TEST(CertifyPowers, Log2OfOneMinusIsWithinItsBound) { expect_bound_of_one_minus(); }
TEST(CertifyPowers, Exp2IsWithinItsBound) { expect_bound_of_exp2(); }

}  // namespace
}  // namespace lightgrid::certify
