#include "shared/real.h"
#undef mad_real
#define mad_real(a, b, c) std::fma(real(a), real(b), real(c))
#include "certify/powers.h"

namespace lightgrid::certify {
namespace {

TEST(CertifyPowersFused, Log2IsWithinItsBound) { expect_bound_of_log2(); }
TEST(CertifyPowersFused, Log2OfOneMinusIsWithinItsBound) { expect_bound_of_one_minus(); }
TEST(CertifyPowersFused, Exp2IsWithinItsBound) { expect_bound_of_exp2(); }

}  // namespace
}  // namespace lightgrid::certify
