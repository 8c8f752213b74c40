// The same bytes from any number of threads, and from Oclgrind, which watches each access to memory.
#include <gmock/gmock.h>

#include "support/paths.h"
#include "support/run_command.h"

namespace lightgrid::lab {
namespace {

CommandOutcome digest(const std::string& before, const std::string& size = "") {
  return run_command(before + " " + grid_digest_program + " " + size + " 2>&1");
}

TEST(WholeGridDigest, IsTheSameWithAnyNumberOfThreads) {
  const CommandOutcome first = digest("");
  ASSERT_EQ(first.status, 0) << first.output;
  for (const char* threads : {"1", "2"})
    EXPECT_EQ(digest(std::string("POCL_MAX_PTHREAD_COUNT=") + threads).output, first.output)
        << threads << " threads";
}

TEST(GridDigest, IsTheSameInEachFormOfTheKernelsAndFromOneThread) {
  const auto of_form = [](const std::string& form) { return "POCL_KERNELLIB_NAME=" + form; };
  const CommandOutcome best = digest(of_form("avx512"), "lanes");  // forms of PoCL: kernel_forms_test.cpp
  ASSERT_EQ(best.status, 0) << best.output;
  for (const char* form : {"avx2", "sse2"})
    EXPECT_EQ(digest(of_form(form), "lanes").output, best.output) << form;
  EXPECT_EQ(digest("POCL_MAX_PTHREAD_COUNT=1", "lanes").output, best.output) << "the own form, one thread";
}

// Without --uninitialized: Oclgrind 21.10 treats vectors of compared lanes as uninitialized, and stops at
// `freeze`.
struct ShapeDigest : testing::TestWithParam<const char*> {};

TEST_P(ShapeDigest, IsThatOfOclgrindWhichFindsNoFault) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "AddressSanitizer and Oclgrind each have to be loaded first";
#endif
  if (run_command("command -v oclgrind").status != 0)
    GTEST_SKIP() << "no oclgrind here (Debian package oclgrind)";
  const CommandOutcome watched =
      digest("LIGHTGRID_CL_CACHE=off oclgrind --build-options -cl-opt-disable --data-races", GetParam());
  EXPECT_EQ(watched.status, 0);
  EXPECT_EQ(watched.output, digest("", GetParam()).output);  // its findings would precede the program's line
}

INSTANTIATE_TEST_SUITE_P(Oclgrind, ShapeDigest, testing::Values("lanes", "group"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace lightgrid::lab
