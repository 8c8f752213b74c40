// The program without a writable cache folder, as in a container without a home.
#include <gmock/gmock.h>

#include "support/run_program.h"

namespace lightgrid::app {
namespace {

using testing::HasSubstr;

// No folder can be made below a device file, not even by root.
const std::vector<std::string> no_cache = {"HOME=/dev/null", "XDG_CACHE_HOME=/dev/null",
                                           "LIGHTGRID_TUNED=off"};

std::vector<std::string> with(std::vector<std::string> environment, const std::string& variable) {
  environment.push_back(variable);
  return environment;
}

TEST(CacheFolder, WithoutOneThereIsStillADeviceAndItWorks) {
  const TempFolder temporary, output;
  const std::string image = output.path / "image.png";
  const ProgramRun run =
      run_program({"render", "spheres", "--size", "32x18", "--lights", "3", "-t", "forward", "-o", image},
                  with(no_cache, "TMPDIR=" + temporary.path.string()));
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_TRUE(std::filesystem::exists(image));
  EXPECT_THAT(run.err, HasSubstr("/dev/null/pocl/kcache: cannot be written"));
  EXPECT_TRUE(std::filesystem::is_empty(temporary.path)) << "its temporary folder is left behind";
}

TEST(CacheFolder, TheOneThatTheUserNamesStays) {
  const TempFolder named, temporary;
  const auto environment =
      with(with(no_cache, "TMPDIR=" + temporary.path.string()), "POCL_CACHE_DIR=" + named.path.string());
  const ProgramRun run = run_program({"devices"}, environment);
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_THAT(run.out, testing::Not(HasSubstr("OpenCL devices\n  none")));
  EXPECT_THAT(run.err, testing::Not(HasSubstr("cannot be written")))
      << "Mesa says that it has no cache; we have nothing to say";
  EXPECT_FALSE(std::filesystem::is_empty(named.path));
  EXPECT_TRUE(std::filesystem::is_empty(temporary.path));
}

TEST(CacheFolder, WithoutATemporaryFolderEitherTheMessageNamesTheFolder) {
  const TempFolder output;
  const std::string image = output.path / "image.png";
  const ProgramRun run =
      run_program({"render", "spheres", "--size", "32x18", "-t", "forward_plus", "-o", image},
                  with(no_cache, "TMPDIR=/dev/null"));
  if (run.err.find("there is no OpenCL device") == std::string::npos)
    GTEST_SKIP() << "another device than PoCL's: " << run.err;
  EXPECT_EQ(run.status, 3);
  EXPECT_THAT(run.err, HasSubstr("/dev/null/pocl/kcache"));
  EXPECT_THAT(run.err, HasSubstr("POCL_CACHE_DIR"));
}

}  // namespace
}  // namespace lightgrid::app
