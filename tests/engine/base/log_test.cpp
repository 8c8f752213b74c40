#include "base/log.h"

#include <gmock/gmock.h>

namespace lightgrid {
namespace {

class Warnings : public testing::Test {
 protected:
  void SetUp() override {
    set_log_sink([](bool, const std::string&) {});
  }
  void TearDown() override {
    set_log_sink({});
    set_command({});
  }
};

TEST_F(Warnings, AreCollectedOnceByAllThatCollect) {
  log_warning("before");
  const WarningCollector outer;
  log_warning("first");
  {
    const WarningCollector inner;
    log_warning("second");
    log_warning("second");
    log_info("no warning");
    EXPECT_EQ(inner.warnings(), std::vector<Warning>{{"second"}});
  }
  log_warning("third");
  EXPECT_EQ(outer.warnings(), (std::vector<Warning>{{"first"}, {"second"}, {"third"}}));
}

TEST_F(Warnings, HaveTheCommandWithTheSettingsThatHelp) {
  const WarningCollector collector;
  log_warning_line("a library has no command", {"range=cutoff"});
  set_command({"lightgrid", "compare", "it's here.glb", "--size", "64x36", ""});
  log_warning_line("no range", {"range=cutoff", "cutoff=0.5"});
  log_warning("nothing to set");
  const auto& all = collector.warnings();
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(all[0].command, "");
  EXPECT_EQ(all[0].settings, std::vector<std::string>{"range=cutoff"});
  EXPECT_EQ(all[1].command,
            "lightgrid compare 'it'\\''s here.glb' --size 64x36 '' --set range=cutoff --set cutoff=0.5");
  EXPECT_EQ(all[2].command, "");
}

}  // namespace
}  // namespace lightgrid
