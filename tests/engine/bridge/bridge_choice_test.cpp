// Which bridge is chosen for which devices.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "base/error.h"
#include "bridge/shared_buffer.h"
#include "support/error_of.h"

namespace lightgrid {
namespace {

struct BridgeChoice : testing::Test {
  void TearDown() override { unsetenv("LIGHTGRID_BRIDGE"); }
  ClDevice cl;
  std::unique_ptr<GlContext> gl = GlContext::create();
};

TEST_F(BridgeChoice, IsMappedExactlyWhereBothSidesAreTheCpu) {
  EXPECT_EQ(choose_bridge(cl, *gl) == BridgeKind::mapped, may_share_memory(cl.info(), gl->software));
}

// A context in software pretends to be a graphics card: on a CPU no import is tried, on a GPU it fails.
TEST_F(BridgeChoice, IsStagedWhereNothingCanBeShared) {
  if (!gl->software) GTEST_SKIP() << gl->renderer << " is no software";
  gl->software = false;
  EXPECT_EQ(choose_bridge(cl, *gl), BridgeKind::staged);
  EXPECT_THAT(why_not_imported(cl, *gl), testing::HasSubstr(cl.info().name));
}

TEST(SharedMemory, IsForPoclsCpuBesideASoftwareGlAlone) {
  ClDeviceInfo info{.platform = "Portable Computing Language", .cpu = true};
  EXPECT_TRUE(may_share_memory(info, true));
  EXPECT_FALSE(may_share_memory(info, false));
  info.platform = "Intel(R) OpenCL";
  EXPECT_FALSE(may_share_memory(info, true));
  EXPECT_FALSE(may_share_memory({.platform = "Portable Computing Language", .cpu = false}, true));
}

TEST_F(BridgeChoice, CanBeForcedToStaged) {
  setenv("LIGHTGRID_BRIDGE", "staged", 1);
  EXPECT_EQ(choose_bridge(cl, *gl), BridgeKind::staged);
}

TEST_F(BridgeChoice, NamesTheMissingStepWhereImportedMemoryIsForced) {
  if (why_not_imported(cl, *gl).empty()) GTEST_SKIP() << "memory can be imported here";
  setenv("LIGHTGRID_BRIDGE", "imported", 1);
  EXPECT_EQ(error_of([&] { choose_bridge(cl, *gl); }, ErrorKind::machine),
            "LIGHTGRID_BRIDGE=imported: " + why_not_imported(cl, *gl));
}

// The trial's steps below the checks of devices, whose first is OpenGL's extensions.
TEST_F(BridgeChoice, ThrowsWhereMemoryCannotBeImported) {
  if (why_not_imported(cl, *gl).empty()) GTEST_SKIP() << "memory can be imported here";
  EXPECT_THROW(SharedBuffer(cl, BridgeKind::imported, 64), Error);
  EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
}

TEST_F(BridgeChoice, RefusesAnUnknownName) {
  setenv("LIGHTGRID_BRIDGE", "telepathy", 1);
  EXPECT_THROW(choose_bridge(cl, *gl), Error);
}

}  // namespace
}  // namespace lightgrid
