// Errors of users: exit status 2, and one line that names the option and the value.
#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>
#include <regex>

#include "support/run_program.h"

namespace lightgrid {
namespace {

using testing::HasSubstr;

struct Wrong {
  const char* name;
  std::vector<std::string> arguments;  // FOLDER stands for the test's folder
  std::vector<std::string> told;       // required content of the line
};

std::string replace_folder(std::string text, const std::string& folder) {
  const size_t at = text.find("FOLDER");
  return at == std::string::npos ? text : text.replace(at, 6, folder);
}

class WrongArguments : public testing::TestWithParam<Wrong> {};

// A shell's <(...) gives a pipe, which several views read.
TEST(LightsFile, MayBeAPipe) {
  const ProgramRun run = run_words(
      {"bash", "-c",
       std::string(lightgrid_program) +
           R"( check spheres --engine godot-mobile --lights-file <(echo '{"lights": [{"position": [0, 1, 0], "radius": 2}]}'))"});
  EXPECT_THAT(run.err, testing::Not(HasSubstr("no such file")));
  EXPECT_EQ(run.status, 0) << run.err;
}

TEST(LightsFile, FoldersAndDevicesAreNamedAsSuch) {
  const auto said = [](const std::string& path) {
    const ProgramRun run = run_program({"plan", "spheres", "--lights-file", path});
    EXPECT_EQ(run.status, 2);
    return run.err;
  };
  EXPECT_THAT(said("/"), HasSubstr("/: is a folder, not a file"));
  EXPECT_THAT(said("/dev/null"), HasSubstr("/dev/null: is a device, not a file"));
  EXPECT_THAT(said("/none"), HasSubstr("/none: no such file"));
}

TEST(Messages, DoNotRepeatLongValues) {
  const std::string value(100'000, 'x');
  for (const std::vector<std::string>& words : {std::vector<std::string>{"plan", value},
                                                {"plan", "spheres", "--camera", value},
                                                {"plan", "spheres", "--size", value},
                                                {"plan", "spheres", "--set", value},
                                                {value},
                                                {"render", "spheres", "--frames", value},
                                                {"golden", value}}) {
    const ProgramRun run = run_program(words);
    EXPECT_EQ(run.status, 2);
    EXPECT_LT(run.err.size(), 2500u) << words.front().substr(0, 10);
    EXPECT_GT(run.err.size(), 20u);
  }
}

// A picture of this side in 1.6 GB of address space. Returns the side that a refusal says to fit; 0: it is
// drawn.
int side_that_fits(const char* technique, const char* file, int side) {
  const TempFolder folder;
  const ProgramRun run =
      run_words({"prlimit", "--as=1600000000", std::string(lightgrid_program), "render", "rooms", "--size",
                 fmt::format("{0}x{0}", side), "-t", technique, "-o", folder.path / file},
                {"POCL_MAX_PTHREAD_COUNT=2", "MALLOC_ARENA_MAX=1", "LP_NUM_THREADS=2"});
  if (run.status == 0) return 0;
  EXPECT_EQ(run.status, 3) << run.signal << run.err;
  std::smatch match;
  const bool named = std::regex_search(run.err, match, std::regex("; --size ([0-9]+)x\\1 fits"));
  EXPECT_TRUE(named) << run.err;
  return named ? std::stoi(match[1]) : -1;
}

void expect_refused_with_the_size_that_fits(const char* technique, const char* file) {
  const int fits = side_that_fits(technique, file, 16384);
  EXPECT_GT(fits, 1000);
  EXPECT_NEAR(side_that_fits(technique, file, fits * 105 / 100), fits, 0.03 * fits);
  EXPECT_EQ(side_that_fits(technique, file, fits), 0);
}

// PoCL would end the program with an assertion.
TEST(TooLarge, AnImageForTheMemoryIsRefusedWithTheSizeThatFits) {
  expect_refused_with_the_size_that_fits("visibility", "x.exr");
}

TEST(TooLargeOthers, AreRefusedWithTheSizeThatFits) {
  expect_refused_with_the_size_that_fits("visibility", "x.png");
  expect_refused_with_the_size_that_fits("deferred", "x.png");
}

TEST_P(WrongArguments, ExitWithTwoAndOneLineThatNamesThem) {
  const TempFolder folder;
  std::ofstream(folder.path / "one.json")
      << R"({"lights": [{"name": "lamp", "position": [0, 1, 0], "radius": 2}]})";
  std::ofstream(folder.path / "file") << "not a folder";
  std::filesystem::create_directory(folder.path / "is_a_folder.png");
  std::filesystem::create_symlink("loop", folder.path / "loop");
  std::vector<std::string> arguments;
  for (const std::string& a : GetParam().arguments) arguments.push_back(replace_folder(a, folder.path));
  // A wrong argument must be reported first, even if no device could be opened.
  const ProgramRun run = run_program(arguments, {"OCL_ICD_VENDORS=/nonexistent"});
  EXPECT_EQ(run.status, 2) << "signal " << run.signal << "\n" << run.err;
  EXPECT_EQ(run.out, "");
  EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
  for (const std::string& told : GetParam().told)
    EXPECT_THAT(run.err, HasSubstr(replace_folder(told, folder.path)));
  const auto files = std::distance(std::filesystem::directory_iterator(folder.path), {});
  EXPECT_EQ(files, 4) << "something was written";
}

const char scene[] = "spheres";

INSTANTIATE_TEST_SUITE_P(
    OfRender, WrongArguments,
    testing::Values(
        Wrong{"SizeNotANumber",
              {"render", scene, "--size", "bigxbig", "-o", "FOLDER/x.png"},
              {"--size", "bigxbig"}},
        Wrong{"SizeZero", {"render", scene, "--size", "0x4", "-o", "FOLDER/x.png"}, {"--size", "0x4"}},
        Wrong{"SizeNegative", {"render", scene, "--size", "-4x4", "-o", "FOLDER/x.png"}, {"--size", "-4x4"}},
        Wrong{"SizeTooLarge",
              {"render", scene, "--size", "99999x4", "-o", "FOLDER/x.png"},
              {"--size", "99999x4"}},
        Wrong{"SizeWithMoreBehind",
              {"render", scene, "--size", "4x4x4", "-o", "FOLDER/x.png"},
              {"--size", "4x4x4"}},
        Wrong{"UnknownScene", {"render", "nosuchscene", "-o", "FOLDER/x.png"}, {"nosuchscene", "hall"}},
        Wrong{"SceneIsAFolder", {"render", "FOLDER", "-o", "FOLDER/x.png"}, {"FOLDER"}},
        Wrong{"SceneNameTooLong", {"render", std::string(5000, 'a'), "-o", "FOLDER/x.png"}, {"aaaa"}},
        Wrong{"SceneOfWrongKind", {"render", "FOLDER/file", "-o", "FOLDER/x.png"}, {"FOLDER/file"}},
        Wrong{"UnknownTechnique",
              {"render", scene, "-t", "magic", "-o", "FOLDER/x.png"},
              {"magic", "forward_plus"}},
        Wrong{"UnknownKey",
              {"render", scene, "--set", "tiles=16", "-o", "FOLDER/x.png"},
              {"--set", "tiles=16"}},
        Wrong{"UnknownValue",
              {"render", scene, "--set", "tile=17", "-o", "FOLDER/x.png"},
              {"--set", "tile", "17"}},
        Wrong{"SettingWithoutValue",
              {"render", scene, "--set", "tile", "-o", "FOLDER/x.png"},
              {"--set", "tile"}},
        Wrong{"UnknownCamera",
              {"render", scene, "--camera", "roof", "-o", "FOLDER/x.png"},
              {"--camera", "roof"}},
        Wrong{"CameraIndexTooHigh",
              {"render", scene, "--camera", "99", "-o", "FOLDER/x.png"},
              {"--camera", "99"}},
        Wrong{"CameraWithoutTarget",
              {"render", scene, "--camera", "eye:1,2,3", "-o", "FOLDER/x.png"},
              {"--camera", "target"}},
        Wrong{"CameraNotANumber",
              {"render", scene, "--camera", "eye:1,2,nan,target:0,0,0", "-o", "FOLDER/x.png"},
              {"--camera", "nan"}},
        Wrong{"CameraField",
              {"render", scene, "--camera", "eye:1,2,3,target:0,0,0,fov:180", "-o", "FOLDER/x.png"},
              {"--camera", "fov", "180"}},
        Wrong{"UnknownGl", {"render", scene, "--gl", "glx", "-o", "FOLDER/x.png"}, {"--gl", "glx"}},
        Wrong{"MoreLightsThanTheFileHas",
              {"render", scene, "--lights-file", "FOLDER/one.json", "--lights", "2", "-o", "FOLDER/x.png"},
              {"--lights", "2", "FOLDER/one.json"}},
        Wrong{"LightsNotANumber",
              {"render", scene, "--lights", "many", "-o", "FOLDER/x.png"},
              {"--lights", "many"}},
        Wrong{
            "LightsNegative", {"render", scene, "--lights", "-3", "-o", "FOLDER/x.png"}, {"--lights", "-3"}},
        Wrong{"LightsBeyondAnyBound",
              {"render", scene, "--lights", "99999999999", "-o", "FOLDER/x.png"},
              {"--lights", "99999999999"}},
        Wrong{"LightRadius",
              {"render", scene, "--lights", "4", "--light-radius", "3,1", "-o", "FOLDER/x.png"},
              {"--light-radius", "3,1"}},
        Wrong{"AmbientNotANumber",
              {"render", scene, "--ambient", "dim", "-o", "FOLDER/x.png"},
              {"--ambient", "dim"}},
        Wrong{"AmbientNegative",
              {"render", scene, "--ambient", "-1", "-o", "FOLDER/x.png"},
              {"--ambient", "-1"}},
        Wrong{"AmbientInfinite",
              {"render", scene, "--ambient", "inf", "-o", "FOLDER/x.png"},
              {"--ambient", "inf"}},
        Wrong{"AmbientWithMoreBehind",
              {"render", scene, "--ambient", "0.1,0.1", "-o", "FOLDER/x.png"},
              {"--ambient", "0.1,0.1"}},
        Wrong{"ShadowsNotANumber",
              {"render", scene, "--shadows", "some", "-o", "FOLDER/x.png"},
              {"--shadows", "some", "all"}},
        Wrong{"ShadowsNegative",
              {"render", scene, "--shadows", "-1", "-o", "FOLDER/x.png"},
              {"--shadows", "-1"}},
        Wrong{"NoSuchLightsFile",
              {"render", scene, "--lights-file", "FOLDER/no.json", "-o", "FOLDER/x.png"},
              {"FOLDER/no.json"}},
        Wrong{"LightsFileOfWrongKind",
              {"render", scene, "--lights-file", "FOLDER/file", "-o", "FOLDER/x.png"},
              {"FOLDER/file"}},
        Wrong{"FramesZero", {"render", scene, "--frames", "0", "-o", "FOLDER/x.png"}, {"--frames", "0"}},
        Wrong{"Extension", {"render", scene, "-o", "FOLDER/x.jpg"}, {"FOLDER/x.jpg", ".png", ".exr"}},
        Wrong{"NoExtension", {"render", scene, "-o", "FOLDER/x"}, {"FOLDER/x", ".png"}},
        Wrong{
            "OutputFolderMissing", {"render", scene, "-o", "FOLDER/none/x.png"}, {"-o", "FOLDER/none/x.png"}},
        Wrong{"OutputInAFile", {"render", scene, "-o", "FOLDER/file/x.png"}, {"-o", "FOLDER/file/x.png"}},
        Wrong{"OutputIsAFolder",
              {"render", scene, "-o", "FOLDER/is_a_folder.png"},
              {"-o", "FOLDER/is_a_folder.png"}},
        Wrong{"JsonFolderMissing",
              {"render", scene, "-o", "FOLDER/x.png", "--json", "FOLDER/none/x.json"},
              {"--json", "FOLDER/none/x.json"}},
        Wrong{"UnknownOption", {"render", scene, "--sise", "4x4"}, {"--sise"}}),
    [](const auto& info) { return info.param.name; });

INSTANTIATE_TEST_SUITE_P(
    OfOthers, WrongArguments,
    testing::Values(
        Wrong{"UnknownCommand", {"rendre"}, {"rendre"}},
        Wrong{"CompareUnknownTechnique",
              {"compare", scene, "-t", "forward,magic", "-o", "FOLDER/r"},
              {"magic"}},
        Wrong{"CompareUnknownValue",
              {"compare", scene, "-t", "forward_plus:tile=17", "-o", "FOLDER/r"},
              {"tile", "17"}},
        Wrong{"CompareUnknownGl", {"compare", scene, "--gl", "glx", "-o", "FOLDER/r"}, {"--gl", "glx"}},
        Wrong{"CompareASettingItDoesNotRead",
              {"compare", scene, "-t", "forward:slices=4", "-o", "FOLDER/r"},
              {"forward", "slices", "tile"}},
        Wrong{"CompareTheSecondSceneUnknown",
              {"compare", scene, "nosuchscene", "-o", "FOLDER/r"},
              {"nosuchscene"}},
        Wrong{"CompareTheSecondSizeWrong",
              {"compare", scene, "--size", "16x9,16", "-o", "FOLDER/r"},
              {"--size", "16"}},
        Wrong{"CompareTheSecondLightsWrong",
              {"compare", scene, "--lights", "16,many", "-o", "FOLDER/r"},
              {"--lights", "many"}},
        Wrong{"CompareNegativeLights",
              {"compare", scene, "--lights", "-3", "-o", "FOLDER/r"},
              {"--lights", "-3"}},
        Wrong{"CompareMoreLightsThanTheFileHas",
              {"compare", scene, "--lights-file", "FOLDER/one.json", "--lights", "1,2", "-o", "FOLDER/r"},
              {"--lights", "2", "FOLDER/one.json"}},
        Wrong{"CompareSweepsAnUnknownValue",
              {"compare", scene, "--compare", "tile=16,17", "-o", "FOLDER/r"},
              {"tile", "17"}},
        Wrong{"CompareSweepsAnUnknownSetting",
              {"compare", scene, "--compare", "tiles=16", "-o", "FOLDER/r"},
              {"tiles"}},
        Wrong{"CompareSweepsWhatNoTechniqueReads",
              {"compare", scene, "-t", "forward", "--compare", "slices=4,8", "-o", "FOLDER/r"},
              {"--compare slices=4,8", "no technique", "reads slices"}},
        Wrong{"CompareTwoBrdfs",
              {"compare", scene, "-t", "forward,forward_plus:brdf=blinn", "-o", "FOLDER/r"},
              {"forward with brdf=ggx and forward_plus with brdf=blinn", "--brdf"}},
        Wrong{"CompareSweepsTheBrdf",
              {"compare", scene, "-t", "forward_plus", "--compare", "brdf=ggx,blinn", "-o", "FOLDER/r"},
              {"brdf=ggx", "brdf=blinn", "--brdf"}},
        Wrong{"CompareIntoAFile", {"compare", scene, "-o", "FOLDER/file"}, {"FOLDER/file"}},
        Wrong{"CompareIntoAFolderThatCannotBeSeen",
              {"compare", scene, "-o", "FOLDER/loop/r"},
              {"FOLDER/loop/r: cannot be made a folder: "}},
        Wrong{"CaptureIntoAFolderThatCannotBeSeen",
              {"capture", scene, "-o", "FOLDER/loop/r"},
              {"FOLDER/loop/r: cannot be made a folder: "}},
        Wrong{"CaptureUnknownScene", {"capture", "nosuchscene", "-o", "FOLDER/r"}, {"nosuchscene"}},
        Wrong{"CaptureIntoAFile", {"capture", scene, "-o", "FOLDER/file"}, {"FOLDER/file"}},
        Wrong{"CullNothing", {"cull", "-o", "FOLDER/r"}, {"FRAME"}},
        Wrong{"CullNoSuchFolder", {"cull", "FOLDER/none", "-o", "FOLDER/r"}, {"FOLDER/none"}},
        Wrong{"CullAFile", {"cull", "FOLDER/file", "-o", "FOLDER/r"}, {"FOLDER/file"}},
        Wrong{"CullAFolderWithoutAFrame", {"cull", "FOLDER", "-o", "FOLDER/r"}, {"FOLDER/view.json"}},
        Wrong{"CullUnknownValue", {"cull", "FOLDER", "--set", "tile=17"}, {"tile", "17"}},
        Wrong{"CullOfATechniqueWithoutAGrid", {"cull", "FOLDER", "-t", "forward"}, {"forward", "grid"}},
        Wrong{"CaptureOfNoTechnique", {"capture", scene, "-t", "magic", "-o", "FOLDER/r"}, {"magic"}},
        Wrong{"VerifyOfAFolderWithoutAFrame", {"verify", "--replay", "FOLDER"}, {"FOLDER/view.json"}},
        Wrong{"VerifyOfAFrameAndOfCases",
              {"verify", "--replay", "FOLDER", "--filter", "depth"},
              {"--replay", "--filter"}},
        Wrong{"InspectNothing", {"inspect", scene}, {"--pixel", "-o"}},
        Wrong{"InspectCompareAtAPlace",
              {"inspect", scene, "--pixel", "1,1", "--compare", "tile=8,16"},
              {"--compare", "--pixel"}},
        Wrong{"InspectNoPlace", {"inspect", scene, "--pixel", "3"}, {"--pixel 3"}},
        Wrong{"InspectOutsideTheImage",
              {"inspect", scene, "--size", "16x9", "--pixel", "3,9", "-o", "FOLDER/r"},
              {"--pixel 3,9", "15,8"}},
        Wrong{
            "InspectNegative", {"inspect", scene, "--size", "16x9", "--pixel", "-1,0"}, {"--pixel", "-1,0"}},
        Wrong{"InspectAFrameOfAnotherSize",
              {"inspect", "FOLDER", "--size", "16x9", "--pixel", "0,0"},
              {"--size", "FOLDER"}},
        Wrong{"PlanUnknownScene", {"plan", "nosuchscene"}, {"nosuchscene"}},
        Wrong{"PlanUnknownSize", {"plan", scene, "--size", "wide"}, {"--size", "wide"}}),
    [](const auto& info) { return info.param.name; });

INSTANTIATE_TEST_SUITE_P(
    OfBench, WrongArguments,
    testing::Values(
        Wrong{"NoRegularExpression", {"bench", "--filter", "floor["}, {"--filter", "floor["}},
        Wrong{"FilterTooLong", {"bench", "--filter", std::string(5000, '(')}, {"--filter"}},
        Wrong{"ReplayNoFrame", {"bench", "--replay", "FOLDER"}, {"--replay", "FOLDER", "view.json"}},
        Wrong{"BenchUnknownValue", {"bench", "--set", "tile=17"}, {"tile", "17"}},
        Wrong{"CompareWithoutAKey", {"bench", "--compare", "tile"}, {"--compare", "tile"}},
        Wrong{"BenchCompareUnknownValue", {"bench", "--compare", "tile=16,17"}, {"tile", "17"}},
        Wrong{"BenchNoFrames", {"bench", "--frames", "0"}, {"--frames"}},
        Wrong{
            "BenchJsonNowhere", {"bench", "--json", "FOLDER/none/x.json"}, {"--json", "FOLDER/none/x.json"}}),
    [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace lightgrid
