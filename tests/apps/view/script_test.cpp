// The words of a script, and their effect on controls and input.
#include "view/script.h"

#include <gmock/gmock.h>

#include "base/error.h"
#include "plan/settings/grid.h"
#include "plan/settings/model.h"

namespace lightgrid::app {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string failure_of(const std::string& text) {
  try {
    Script script(text, "fly.txt");
  } catch (const Error& error) {
    EXPECT_EQ(error.exit_code(), 2);
    return error.what();
  }
  return "";
}

TEST(Script, HoldsKeysUntilTheyAreLetGo) {
  const Script script("1 key down W\n3 key up w\n", "fly.txt");
  Controls controls;
  Input input;
  const bool expected[] = {false, true, true, false, false};
  for (int frame = 0; frame < 5; ++frame) {
    script.play(frame, controls, input);
    EXPECT_EQ(input.held[int(FlightKey::forward)], expected[frame]) << frame;
  }
}

TEST(Script, HoldsTheButtonInFramesThatDrag) {
  const Script script("0 mouse move 10 20\n1 mouse drag 30 20\n", "fly.txt");
  Controls controls;
  Input input;
  script.play(0, controls, input);
  EXPECT_FALSE(input.button);
  EXPECT_EQ(input.x, 10);
  script.play(1, controls, input);
  EXPECT_TRUE(input.button);
  EXPECT_EQ(input.x, 30);
  script.play(2, controls, input);
  EXPECT_FALSE(input.button);
}

TEST(Script, ChoosesForOneSideOrBoth) {
  const Script script(
      "0 technique left clustered\n0 technique RIGHT forward\n"
      "0 set tile=32\n0 set right brdf=blinn\n0 map right lost\n0 line 0.25\n0 under on\n0 click 3 4 # a "
      "comment\n",
      "fly.txt");
  Controls controls;
  Input input;
  script.play(0, controls, input);
  EXPECT_EQ(controls.sides[0].technique, "clustered");
  EXPECT_EQ(controls.sides[1].technique, "forward");
  EXPECT_EQ(controls.sides[0].settings[setting::tile], 32);
  EXPECT_EQ(controls.sides[1].settings[setting::tile], 32);
  EXPECT_EQ(controls.sides[0].settings[setting::brdf], Brdf::ggx);
  EXPECT_EQ(controls.sides[1].settings[setting::brdf], Brdf::blinn);
  EXPECT_EQ(controls.sides[0].map, SideMap::picture);
  EXPECT_EQ(controls.sides[1].map, SideMap::lost);
  EXPECT_EQ(controls.line, 0.25);
  EXPECT_TRUE(controls.picture_under);
  EXPECT_EQ(controls.pixel, (lab::PicturePixel{3, 4}));
}

TEST(Script, ChoosesTheLightsThatCastAndOneOfThem) {
  const Script script(
      "0 shadows all\n0 light 7\n0 map left hidden\n0 map right acned\n0 casting out.txt\n1 shadows 3\n"
      "2 shadows scene\n2 light none\n",
      "fly.txt");
  Controls controls;
  Input input;
  script.play(0, controls, input);
  EXPECT_EQ(controls.casters, "all");
  EXPECT_EQ(controls.light, 7);
  EXPECT_EQ(controls.sides[0].map, SideMap::hidden);
  EXPECT_EQ(controls.sides[1].map, SideMap::acned);
  EXPECT_EQ(controls.casting_file, "out.txt");
  script.play(1, controls, input);
  EXPECT_EQ(controls.casters, "3");
  script.play(2, controls, input);
  EXPECT_EQ(controls.casters, "");
  EXPECT_FALSE(controls.light);
}

TEST(Script, PressesAKeyAndTurnsTheWheelInOneFrame) {
  const Script script("0 press H\n0 press escape\n0 wheel -2\n1 scene hall\n", "fly.txt");
  Controls controls;
  Input input;
  script.play(0, controls, input);
  EXPECT_THAT(input.presses, testing::ElementsAre("h", "escape"));
  EXPECT_EQ(input.wheel, -2);
  script.play(1, controls, input);
  EXPECT_TRUE(input.presses.empty());
  EXPECT_EQ(input.wheel, 0);
  EXPECT_EQ(controls.scene, "hall");
}

TEST(Script, NamesTheLineAndTheWordThatIsWrong) {
  const std::pair<const char*, const char*> cases[] = {{"jump 3", "\"jump\""},
                                                       {"5 jump", "\"jump\" is not an action; actions are"},
                                                       {"5", "\"5\""},
                                                       {"-1 play", "\"-1\""},
                                                       {"5 key press w", "\"press\""},
                                                       {"5 key down x", "\"x\""},
                                                       {"5 key down", "key down|up NAME"},
                                                       {"5 mouse move 3", "mouse move|drag X Y"},
                                                       {"5 mouse move a 3", "\"a\""},
                                                       {"5 technique nosuch", "nosuch"},
                                                       {"5 technique left", "technique [left|right] NAME"},
                                                       {"5 set tile=17", "tile=17"},
                                                       {"5 map red", "\"red\""},
                                                       {"5 shadows some", "shadows some: neither all, none"},
                                                       {"5 light bright", "\"bright\""},
                                                       {"5 line 1.5", "\"1.5\""},
                                                       {"5 line nan", "\"nan\""},
                                                       {"5 under there", "\"there\""},
                                                       {"5 press x", "keys are r 1 2 3 g space"},
                                                       {"5 wheel up", "\"up\""},
                                                       {"5 scene", "scene NAME|FILE"},
                                                       {"5 lights jump", "jump"},
                                                       {"5 play on", "\"on\""},
                                                       {"99999999999 play", "\"99999999999\""}};
  for (const auto& [line, word] : cases) {
    EXPECT_THAT(failure_of("# first\n\n" + std::string(line)),
                AllOf(HasSubstr("fly.txt:3: "), HasSubstr(word)))
        << line;
  }
}

TEST(Script, MayBeEmpty) {
  EXPECT_EQ(failure_of(""), "");
  EXPECT_EQ(failure_of("\n# nothing\r\n"), "");
}

}  // namespace
}  // namespace lightgrid::app
