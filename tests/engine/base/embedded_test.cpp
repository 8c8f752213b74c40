// Texts of kernels and shaders: each #include is replaced by its file, whatever the #if around it says.
#include "base/embedded.h"

#include <gmock/gmock.h>

#include <set>
#include <sstream>

namespace lightgrid {
namespace {

// The lines that a preprocessor leaves of `text`, joined by spaces: #ifdef, #ifndef, #else, #endif, #define.
std::string preprocessed(const std::string& text, std::set<std::string> defined) {
  std::string kept;
  std::vector<bool> taken;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string directive, name;
    words >> directive >> name;
    const bool read = std::ranges::count(taken, false) == 0;
    if (directive == "#ifdef" || directive == "#ifndef") {
      taken.push_back(defined.contains(name) == (directive == "#ifdef"));
    } else if (directive == "#else") {
      taken.back() = !taken.back();
    } else if (directive == "#endif") {
      taken.pop_back();
    } else if (read && directive == "#define") {
      defined.insert(name);
    } else if (read) {
      kept += (kept.empty() ? "" : " ") + line;
    }
  }
  return kept;
}

TEST(WithIncludes, EachFileStandsOnce) {
  const EmbeddedFiles files = {{"main", "#include \"a\"\n#include \"b\"\nmain\n"},
                               {"a", "#pragma once\n#include \"b\"\na\n"},
                               {"b", "#pragma once\n#include \"a\"\nb\n"}};
  EXPECT_EQ(with_includes("main", files), "b\na\nmain\n");
}

TEST(WithIncludes, AFileOfABranchThatIsNotTakenIsReadLater) {
  const EmbeddedFiles files = {{"main", "#ifdef X\n#include \"a\"\n#endif\n#include \"b\"\nmain\n"},
                               {"a", "#include \"b\"\na\n"},
                               {"b", "b\n"}};
  const std::string text = with_includes("main", files);
  EXPECT_EQ(preprocessed(text, {}), "b main");
  EXPECT_EQ(preprocessed(text, {"X"}), "b a main");
}

TEST(WithIncludes, BothBranchesOfAConditionMayReadTheSameFile) {
  const EmbeddedFiles files = {
      {"main", "#ifdef X\n#include \"a\"\n# else\nno x\n#include \"a\"\n#endif\n#include \"a\"\n"},
      {"a", "a\n"}};
  std::string text = with_includes("main", files);
  text.replace(text.find("# else"), 6, "#else");
  EXPECT_EQ(preprocessed(text, {}), "no x a");
  EXPECT_EQ(preprocessed(text, {"X"}), "a");
}

TEST(WithIncludes, AFileInsideAFileThatIsReadTwiceIsReadOnce) {
  const EmbeddedFiles files = {{"main",
                                "#ifdef X\n#include \"a\"\n#endif\n#ifdef Y\n#include \"a\"\n#include "
                                "\"b\"\n#endif\n#include \"b\"\n"},
                               {"a", "#ifdef Z\n#include \"b\"\n#endif\na\n"},
                               {"b", "b\n"}};
  const std::string text = with_includes("main", files);
  EXPECT_EQ(preprocessed(text, {}), "b");
  EXPECT_EQ(preprocessed(text, {"X"}), "a b");
  EXPECT_EQ(preprocessed(text, {"X", "Y"}), "a b");
  EXPECT_EQ(preprocessed(text, {"Y", "Z"}), "b a");
}

TEST(WithIncludes, AFileReadBeforeTheConditionIsNotRepeated) {
  const EmbeddedFiles files = {{"main", "#include \"a\"\n#ifdef X\n#include \"a\"\n#endif\n"}, {"a", "a\n"}};
  EXPECT_EQ(with_includes("main", files), "a\n#ifdef X\n#endif\n");
}

TEST(WithIncludes, EffectsAreTheFilesOfTheirFolder) {
  const EmbeddedFiles files = {{"main", "#include \"shared/effects.h\"\nBASE_EFFECTS(X)\n"},
                               {"shared/effects/fog.h", "fog\n"},
                               {"shared/effects/sky_light.h", "sky\n"},
                               {"shared/effects_of_another.h", "no\n"},
                               {"shared/inputs.h", "inputs\n"}};
  const std::string text = with_includes("main", files);
  EXPECT_EQ(preprocessed(text, {}), "inputs BASE_EFFECTS(X)");
  EXPECT_EQ(preprocessed(text, {"EFFECT_SKY_LIGHT"}), "inputs sky BASE_EFFECTS(X)");
  EXPECT_EQ(preprocessed(text, {"EFFECT_FOG", "EFFECT_SKY_LIGHT"}), "inputs fog sky BASE_EFFECTS(X)");
  EXPECT_THAT(text,
              testing::HasSubstr(
                  "#define BASE_EFFECTS(X) IF_FOG_BASE(X) IF_SKY_LIGHT_BASE(X)\n"
                  "#define BACKGROUND_EFFECTS(X) IF_FOG_BACKGROUND(X) IF_SKY_LIGHT_BACKGROUND(X)\n"
                  "#define REACH_EFFECTS(X) IF_FOG_REACH(X) IF_SKY_LIGHT_REACH(X)\n"
                  "#define TINT_EFFECTS(X) IF_FOG_TINT(X) IF_SKY_LIGHT_TINT(X)\n"
                  "#define MEETS_EFFECTS(X) IF_FOG_MEETS(X) IF_SKY_LIGHT_MEETS(X)\n"
                  "#define LIT_EFFECTS(X) IF_FOG_LIT(X) IF_SKY_LIGHT_LIT(X)\n"
                  "#define RADIANCE_EFFECTS(X) IF_FOG_RADIANCE(X) IF_SKY_LIGHT_RADIANCE(X)\n"
                  "#define TERMS_EFFECTS(X) IF_FOG_TERMS(X) IF_SKY_LIGHT_TERMS(X)\n"
                  "#define LIGHT_EFFECTS(X) IF_FOG_LIT(X) IF_FOG_REACH(X) IF_FOG_TINT(X) IF_FOG_MEETS(X) "
                  "IF_FOG_SURFACE(X) "
                  "IF_SKY_LIGHT_LIT(X) IF_SKY_LIGHT_REACH(X) IF_SKY_LIGHT_TINT(X) IF_SKY_LIGHT_MEETS(X) "
                  "IF_SKY_LIGHT_SURFACE(X)\n"));
  EXPECT_THAT(text,
              testing::HasSubstr("#define SURFACE_EFFECTS(X) IF_FOG_SURFACE(X) IF_SKY_LIGHT_SURFACE(X)\n"));
}

// An effect answers the hooks whose inputs its text lists.
TEST(WithIncludes, AnEffectsHooksAreThoseOfItsInputs) {
  const std::string text = with_includes("main", {{"main", "#include \"shared/effects.h\"\n"},
                                                  {"shared/effects/sky_light.h", "sky\n"},
                                                  {"shared/inputs.h", "inputs\n"}});
  EXPECT_THAT(text,
              testing::HasSubstr("\n#ifdef SKY_LIGHT_BASE_INPUTS\n"
                                 "#define IF_SKY_LIGHT_BASE(X) X(SKY_LIGHT_BASE_INPUTS, sky_light_base, "
                                 "OWN_SKY_LIGHT)\n"
                                 "#else\n#define IF_SKY_LIGHT_BASE(X)\n#endif\n"
                                 "#ifdef SKY_LIGHT_BACKGROUND_INPUTS\n#define BACKGROUND_OF_EFFECTS\n"
                                 "#define IF_SKY_LIGHT_BACKGROUND(X) X(SKY_LIGHT_BACKGROUND_INPUTS, "
                                 "sky_light_background, OWN_SKY_LIGHT)\n"
                                 "#else\n#define IF_SKY_LIGHT_BACKGROUND(X)\n#endif\n"
                                 "#ifdef SKY_LIGHT_REACH_INPUTS\n#define REACHED_BY_EFFECTS\n"
                                 "#define IF_SKY_LIGHT_REACH(X) X(SKY_LIGHT_REACH_INPUTS, sky_light_reach, "
                                 "OWN_SKY_LIGHT)\n"
                                 "#else\n#define IF_SKY_LIGHT_REACH(X)\n#endif\n"));
  // Three functions of one list.
  EXPECT_THAT(text,
              testing::HasSubstr("\n#ifdef SKY_LIGHT_LIT_INPUTS\n#define LIT_BY_EFFECTS\n"
                                 "#define IF_SKY_LIGHT_LIT(X) X(SKY_LIGHT_LIT_INPUTS, sky_light_lit, "));
  EXPECT_THAT(text, testing::HasSubstr("\n#ifdef SKY_LIGHT_LIT_INPUTS\n#define IF_SKY_LIGHT_TERMS(X) "
                                       "X(SKY_LIGHT_LIT_INPUTS, sky_light_terms, "));
}

// The values that an effect reads of surfaces stand before all texts of effects, as a point that is shaded has it.
TEST(WithIncludes, AnEffectsSurfaceInputsStandBeforeTheTexts) {
  const EmbeddedFiles files = {
      {"main", "#include \"shared/effects.h\"\nSURFACE_EFFECTS(X)\n"},
      {"shared/effects/fog.h", "fog\n"},
      {"shared/effects/paint.h", "#define PAINT_SURFACE_INPUTS(ROW) ROW(a) \\\n  ROW(b)\npaint\n"},
      {"shared/inputs.h", "inputs\n"}};
  const std::string text = with_includes("main", files);
  EXPECT_LT(text.find("#define PAINT_SURFACE_INPUTS(ROW) ROW(a) \\\n  ROW(b)\n#endif\n"), text.find("fog\n"));
  EXPECT_THAT(text, testing::HasSubstr("#ifdef PAINT_SURFACE_INPUTS\n#define HAS_SURFACE_VALUES\n"
                                       "#define IF_PAINT_SURFACE(X) X(PAINT_SURFACE_INPUTS, paint_surface, "
                                       "OWN_PAINT)\n"));
  EXPECT_THAT(text, testing::HasSubstr("#ifdef FOG_SURFACE_INPUTS\n#define OWN_FOG(ROW) "));
}

}  // namespace
}  // namespace lightgrid
