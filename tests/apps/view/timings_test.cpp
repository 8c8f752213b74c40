// Pass times of the last frames, and the command line that renders a view.
#include "view/clock.h"

#include <gmock/gmock.h>

#include "view/controls.h"
#include "view/panels.h"

namespace lightgrid::app {
using namespace lab;
namespace {

TEST(Timings, KeepTheLastFramesAndTheirMean) {
  Timings timings;
  for (size_t i = 0; i < Timings::kept_frames + 5; ++i) timings.add({{{"cull", double(i)}, {"shade", 2}}});
  EXPECT_EQ(timings.frames().size(), Timings::kept_frames);
  EXPECT_EQ(timings.frames().front().passes[0].ms, 5);
  const FrameTimes mean = timings.mean(2);
  ASSERT_EQ(mean.passes.size(), 2u);
  EXPECT_EQ(mean.passes[0].ms, double(Timings::kept_frames) + 3.5);
  EXPECT_EQ(mean.total_ms(), double(Timings::kept_frames) + 5.5);
  EXPECT_TRUE(Timings().mean(2).passes.empty());
}

TEST(Timings, AddsUpAPassThatRanTwice) {
  const FrameTimes frame =
      frame_times({{.name = "cull", .on = "cl", .ms = {1, 2}}, {.name = "idle", .on = "gl", .ms = {}}});
  ASSERT_EQ(frame.passes.size(), 1u);
  EXPECT_EQ(frame.passes[0].ms, 3);
}

TEST(Labels, NeverCoverEachOther) {
  EXPECT_EQ(second_label_y(100, 13, 100, 280), first_label_y) << "side by side";
  EXPECT_GE(second_label_y(200, 13, 100, 280), first_label_y + 13 + 4) << "with their margins, below";
  EXPECT_GE(second_label_y(200, 26, 100, 280), first_label_y + 26 + 4) << "of two lines";
}

TEST(Screenshots, AreNamedByTheSceneAndItsTechniques) {
  const SideControls left{.technique = "visibility"}, right{.technique = "forward_plus"};
  EXPECT_EQ(screenshot_name("hall", {left, right}), "hall_visibility_forward_plus");
  EXPECT_EQ(screenshot_name("../my models/a b.c.glb", {left, left}), "a_b_c_visibility");
}

TEST(CommandText, QuotesWhatAShellWouldRead) {
  EXPECT_EQ(shell_word("eye:1,-2.5,3"), "eye:1,-2.5,3");
  EXPECT_EQ(shell_word("a b"), "'a b'");
  EXPECT_EQ(shell_word("it's"), "'it'\\''s'");
  EXPECT_EQ(shell_word(""), "''");
}

TEST(CommandText, NamesTheSettingsThatTheTechniqueReads) {
  SideControls side{.technique = "forward_plus"};
  apply_setting(side.settings, "tile=32");
  apply_setting(side.settings, "lidr-packing=sort");  // forward_plus does not read it
  EXPECT_EQ(
      render_command("hall", 64, 36, "eye:0,1,0,target:0,1,-1,fov:60", " --time 2", side),
      "lightgrid render hall --size 64x36 --camera eye:0,1,0,target:0,1,-1,fov:60 --time 2 -t forward_plus "
      "--set tile=32 -o view.png");
}

}  // namespace
}  // namespace lightgrid::app
