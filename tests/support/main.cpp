// The main function of every test program: 1 if a test failed; else 77 if one was skipped, which ctest shows
// as skipped.
#include <gmock/gmock.h>

int main(int argc, char** argv) {
  testing::InitGoogleMock(&argc, argv);
  const int status = RUN_ALL_TESTS();
  if (status != 0) return status;
  return testing::UnitTest::GetInstance()->skipped_test_count() > 0 ? 77 : 0;
}
