// Messages stay lines of a bounded length.
#include "base/message_line.h"

#include <gtest/gtest.h>

namespace lightgrid {
namespace {

TEST(MessageLine, ShortLinesStayAsTheyAre) {
  EXPECT_EQ(message_line("a.glb: light 3 \"lamp\": radius is NaN"), "a.glb: light 3 \"lamp\": radius is NaN");
  EXPECT_EQ(message_line(""), "");
}

TEST(MessageLine, ControlCharactersBecomeSpaces) {
  EXPECT_EQ(message_line("a\nb\x1b[31m\x7f\n"), "a b [31m");
}

TEST(MessageLine, AWordKeepsItsEnds) {
  const std::string line =
      message_line("set tile=" + std::string(100'000, '7') + ": not a number from 1 to 64; did you mean 7?");
  EXPECT_LT(line.size(), 320u);
  EXPECT_EQ(line.substr(0, 12), "set tile=777");
  EXPECT_NE(line.find("…7777"), std::string::npos);
  EXPECT_NE(line.find("7: not a number from 1 to 64; did you mean 7?"), std::string::npos);
}

TEST(MessageLine, AQuotedTextWithSpacesKeepsItsEnds) {
  std::string text;
  for (int i = 0; i < 10'000; ++i) text += "word ";
  const std::string line = message_line("a.glb: node 1 \"" + text + "end\": scale is NaN");
  EXPECT_LT(line.size(), 320u);
  EXPECT_EQ(line.substr(0, 20), "a.glb: node 1 \"word ");
  EXPECT_EQ(line.substr(line.size() - 20), "d end\": scale is NaN");
}

TEST(MessageLine, ALineOfManyWordsIsCut) {
  std::string text;
  for (int i = 0; i < 10'000; ++i) text += "word ";
  EXPECT_LE(message_line(text).size(), 2003u);
  std::string names;
  for (int i = 0; i < 70; ++i) names += "setting-" + std::to_string(i) + ", ";
  EXPECT_NE(message_line(names).find("setting-35, setting-36"), std::string::npos) << "lists of names stay";
}

TEST(MessageLine, CharactersStayWhole) {
  std::string hearts;
  for (int i = 0; i < 1000; ++i) hearts += "❤";
  const std::string line = message_line(hearts);
  EXPECT_EQ((line.size() - 3) % 3, 0u);
  EXPECT_EQ(line.substr(0, 3), "❤");
  EXPECT_EQ(line.substr(line.size() - 3), "❤");
}

}  // namespace
}  // namespace lightgrid
