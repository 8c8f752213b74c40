// Errors of users: exit status 2, and one line that names the option and the value, or helps with a mistyped
// word.
#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>

#include "support/run_program.h"

namespace lightgrid::app {
namespace {

using testing::HasSubstr;

struct Wrong {
  std::string arguments;          // FOLDER stands for the test's folder, LONG for 5,000 parentheses
  std::vector<std::string> told;  // required content of the line
};

std::string replaced(std::string text, const std::string& folder) {
  text = std::regex_replace(text, std::regex("FOLDER"), folder);
  return std::regex_replace(text, std::regex("LONG"), std::string(5000, '('));
}

std::vector<std::string> split_words(const std::string& line) {
  std::istringstream stream(line);
  return {std::istream_iterator<std::string>(stream), {}};
}

std::string name_of(const Wrong& wrong) {
  return std::regex_replace(wrong.arguments, std::regex("[^A-Za-z0-9]+"), "_");
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
  // A wrong argument must be reported first, even if no device could be opened.
  std::string line = GetParam().arguments;
  if (line.starts_with("render") && line.find(" -o ") == line.npos) line += " -o FOLDER/x.png";
  const ProgramRun run =
      run_program(split_words(replaced(line, folder.path)), {"OCL_ICD_VENDORS=/nonexistent"});
  EXPECT_EQ(run.status, 2) << "signal " << run.signal << "\n" << run.err;
  EXPECT_EQ(run.out, "");
  EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
  for (const std::string& told : GetParam().told)
    EXPECT_THAT(run.err, HasSubstr(replaced(told, folder.path)));
  const auto files = std::distance(std::filesystem::directory_iterator(folder.path), {});
  EXPECT_EQ(files, 4) << "something was written";
}

INSTANTIATE_TEST_SUITE_P(
    OfRender, WrongArguments,
    testing::Values(
        Wrong{"render spheres --size bigxbig", {"--size", "bigxbig"}},
        Wrong{"render spheres --size 0x4", {"--size", "0x4"}},
        Wrong{"render spheres --size -4x4", {"--size", "-4x4"}},
        Wrong{"render spheres --size 99999x4", {"--size", "99999x4"}},
        Wrong{"render spheres --size 4x4x4", {"--size", "4x4x4"}},
        Wrong{"render nosuchscene", {"nosuchscene", "hall"}}, Wrong{"render FOLDER", {"FOLDER"}},
        Wrong{"render LONG", {"(((("}}, Wrong{"render FOLDER/file", {"FOLDER/file"}},
        Wrong{"render spheres -t magic", {"magic", "forward_plus"}},
        Wrong{"render spheres --set tiles=16", {"--set", "tiles=16"}},
        Wrong{"render spheres --set tile=17", {"--set", "tile", "17"}},
        Wrong{"render spheres --set tile", {"--set", "tile"}},
        Wrong{"render spheres --camera roof", {"--camera", "roof"}},
        Wrong{"render spheres --camera 99", {"--camera", "99"}},
        Wrong{"render spheres --camera eye:1,2,3", {"--camera", "target"}},
        Wrong{"render spheres --camera eye:1,2,nan,target:0,0,0", {"--camera", "nan"}},
        Wrong{"render spheres --camera eye:1,2,3,target:0,0,0,fov:180", {"--camera", "fov", "180"}},
        Wrong{"render spheres --gl glx", {"--gl", "glx"}},
        Wrong{"render spheres --lights-file FOLDER/one.json --lights 2",
              {"--lights", "2", "FOLDER/one.json"}},
        Wrong{"render spheres --lights many", {"--lights", "many"}},
        Wrong{"render spheres --lights -3", {"--lights", "-3"}},
        Wrong{"render spheres --lights 99999999999", {"--lights", "99999999999"}},
        Wrong{"render spheres --lights 4 --light-radius 3,1", {"--light-radius", "3,1"}},
        Wrong{"render spheres --ambient dim", {"--ambient", "dim"}},
        Wrong{"render spheres --ambient -1", {"--ambient", "-1"}},
        Wrong{"render spheres --ambient inf", {"--ambient", "inf"}},
        Wrong{"render spheres --ambient 0.1,0.1", {"--ambient", "0.1,0.1"}},
        Wrong{"render spheres --environment FOLDER/no.exr", {"FOLDER/no.exr"}},
        Wrong{"render spheres --environment sunny.png", {"sunny.png", ".hdr or .exr"}},
        Wrong{"render spheres --environment sky:1,2", {"--environment", "sky:1,2", "nine numbers"}},
        Wrong{"render spheres --shadows some", {"--shadows", "some", "all"}},
        Wrong{"render spheres --shadows -1", {"--shadows", "-1"}},
        Wrong{"render spheres --lights-file FOLDER/no.json", {"FOLDER/no.json"}},
        Wrong{"render spheres --lights-file FOLDER/file", {"FOLDER/file"}},
        Wrong{"render spheres --frames 0", {"--frames", "0"}},
        Wrong{"render spheres -o FOLDER/x.jpg", {"FOLDER/x.jpg", ".png", ".exr"}},
        Wrong{"render spheres -o FOLDER/x", {"FOLDER/x", ".png"}},
        Wrong{"render spheres -o FOLDER/none/x.png", {"-o", "FOLDER/none/x.png"}},
        Wrong{"render spheres -o FOLDER/file/x.png", {"-o", "FOLDER/file/x.png"}},
        Wrong{"render spheres -o FOLDER/is_a_folder.png", {"-o", "FOLDER/is_a_folder.png"}},
        Wrong{"render spheres -o FOLDER/x.png --json FOLDER/none/x.json", {"--json", "FOLDER/none/x.json"}},
        Wrong{"render spheres --sise 4x4", {"--sise"}}),
    [](const auto& info) { return name_of(info.param); });

INSTANTIATE_TEST_SUITE_P(
    OfOthers, WrongArguments,
    testing::Values(
        Wrong{"rendre", {"rendre"}}, Wrong{"compare spheres -t forward,magic -o FOLDER/r", {"magic"}},
        Wrong{"compare spheres -t forward_plus:tile=17 -o FOLDER/r", {"tile", "17"}},
        Wrong{"compare spheres --gl glx -o FOLDER/r", {"--gl", "glx"}},
        Wrong{"compare spheres -t forward:slices=4 -o FOLDER/r", {"forward", "slices", "tile"}},
        Wrong{"compare spheres nosuchscene -o FOLDER/r", {"nosuchscene"}},
        Wrong{"compare spheres --size 16x9,16 -o FOLDER/r", {"--size", "16"}},
        Wrong{"compare spheres --lights 16,many -o FOLDER/r", {"--lights", "many"}},
        Wrong{"compare spheres --lights -3 -o FOLDER/r", {"--lights", "-3"}},
        Wrong{"compare spheres --lights-file FOLDER/one.json --lights 1,2 -o FOLDER/r",
              {"--lights", "2", "FOLDER/one.json"}},
        Wrong{"compare spheres --compare tile=16,17 -o FOLDER/r", {"tile", "17"}},
        Wrong{"compare spheres --compare tiles=16 -o FOLDER/r", {"tiles"}},
        Wrong{"compare spheres -t forward --compare slices=4,8 -o FOLDER/r",
              {"--compare slices=4,8", "no technique", "reads slices"}},
        Wrong{"compare spheres -t forward,forward_plus:brdf=blinn -o FOLDER/r",
              {"forward with brdf=ggx and forward_plus with brdf=blinn", "--brdf"}},
        Wrong{"compare spheres -t forward_plus --compare brdf=ggx,blinn -o FOLDER/r",
              {"brdf=ggx", "brdf=blinn", "--brdf"}},
        Wrong{"compare spheres -o FOLDER/file", {"FOLDER/file"}},
        Wrong{"compare spheres -o FOLDER/loop/r", {"FOLDER/loop/r: cannot be made a folder: "}},
        Wrong{"capture spheres -o FOLDER/loop/r", {"FOLDER/loop/r: cannot be made a folder: "}},
        Wrong{"capture nosuchscene -o FOLDER/r", {"nosuchscene"}},
        Wrong{"capture spheres -o FOLDER/file", {"FOLDER/file"}}, Wrong{"cull -o FOLDER/r", {"FRAME"}},
        Wrong{"cull FOLDER/none -o FOLDER/r", {"FOLDER/none"}},
        Wrong{"cull FOLDER/file -o FOLDER/r", {"FOLDER/file"}},
        Wrong{"cull FOLDER -o FOLDER/r", {"FOLDER/view.json"}},
        Wrong{"cull FOLDER --set tile=17", {"tile", "17"}},
        Wrong{"cull FOLDER -t forward", {"forward", "grid"}},
        Wrong{"capture spheres -t magic -o FOLDER/r", {"magic"}},
        Wrong{"verify --replay FOLDER", {"FOLDER/view.json"}},
        Wrong{"verify --replay FOLDER --filter depth", {"--replay", "--filter"}},
        Wrong{"inspect spheres", {"--pixel", "-o"}},
        Wrong{"inspect spheres --pixel 1,1 --compare tile=8,16", {"--compare", "--pixel"}},
        Wrong{"inspect spheres --pixel 3", {"--pixel 3"}},
        Wrong{"inspect spheres --size 16x9 --pixel 3,9 -o FOLDER/r", {"--pixel 3,9", "15,8"}},
        Wrong{"inspect spheres --size 16x9 --pixel -1,0", {"--pixel", "-1,0"}},
        Wrong{"inspect FOLDER --size 16x9 --pixel 0,0", {"--size", "FOLDER"}},
        Wrong{"plan nosuchscene", {"nosuchscene"}}, Wrong{"plan spheres --size wide", {"--size", "wide"}}),
    [](const auto& info) { return name_of(info.param); });

INSTANTIATE_TEST_SUITE_P(OfBench, WrongArguments,
                         testing::Values(Wrong{"bench --filter floor[", {"--filter", "floor["}},
                                         Wrong{"bench --filter LONG", {"--filter"}},
                                         Wrong{"bench --replay FOLDER", {"--replay", "FOLDER", "view.json"}},
                                         Wrong{"bench --set tile=17", {"tile", "17"}},
                                         Wrong{"bench --compare tile", {"--compare", "tile"}},
                                         Wrong{"bench --compare tile=16,17", {"tile", "17"}},
                                         Wrong{"bench --frames 0", {"--frames"}},
                                         Wrong{"bench --json FOLDER/none/x.json",
                                               {"--json", "FOLDER/none/x.json"}}),
                         [](const auto& info) { return name_of(info.param); });

INSTANTIATE_TEST_SUITE_P(
    OfTyping, WrongArguments,
    testing::Values(
        Wrong{"rendre hall", {"there is no command rendre; did you mean render?"}},
        Wrong{"comapre", {"did you mean compare?"}}, Wrong{"tech", {"did you mean techniques?"}},
        Wrong{"render hall --sise 64x36", {"render has no option --sise; did you mean --size?"}},
        Wrong{"compare hall --technque forward", {"did you mean --technique?"}},
        Wrong{"compare hall --ouput=FOLDER/r", {"did you mean --output?"}},
        Wrong{"verify --fliter depth", {"verify has no option --fliter; did you mean --filter?"}},
        Wrong{"render hal", {"did you mean hall?"}},
        Wrong{"compare hall terrian -o FOLDER/r", {"did you mean terrain?"}},
        Wrong{"render hall -t forwardplus", {"did you mean forward_plus?"}},
        Wrong{"compare hall -t forward,visiblity -o FOLDER/r", {"did you mean visibility?"}},
        Wrong{"compare hall -t Forward-Plus,defered -o FOLDER/r", {"did you mean forward_plus?"}},
        Wrong{"render hall -t forward,forward_plus", {"compare takes several"}},
        Wrong{"render hall -t forward --set slices=8", {"--set slices: forward does not read it"}},
        Wrong{"compare hall -t forward,forward_plus --set slices=8 -o FOLDER/r",
              {"--set slices: forward, forward_plus do not read it"}},
        Wrong{"plan hall -t forward --set tile=32",
              {"--set tile: it would change nothing; forward reads it only for shadows, and no light casts "
               "one"}},
        Wrong{"render hall -t forward --set cutoff=2",
              {"--set cutoff: it would change nothing", "with range=cutoff"}},
        Wrong{"render hall -t visibility --set list-cap-order=distance",
              {"visibility reads it with list-cap="}},
        Wrong{"compare hall -t forward,visibility:tile=8 --set shadow-size=64 -o FOLDER/r",
              {"--set shadow-size: it would change nothing; forward reads it with shadows=map"}},
        Wrong{"render spheres --camera-path turn:0", {"--camera-path turn:0: not turn:N"}},
        Wrong{"render spheres --exposure bright", {"--exposure bright: neither auto nor a number"}},
        Wrong{"render spheres --exposure 100", {"from -60 to 60"}},
        Wrong{"render spheres --set tyle=8", {"did you mean tile?"}},
        Wrong{"render spheres --set range=cut-off", {"did you mean cutoff?"}},
        Wrong{"render spheres --set cutoff=0", {"--set cutoff=0: cutoff is a number from"}},
        Wrong{"verify --gl glx --list", {"\"glx\" is not one of auto, osmesa"}},
        Wrong{"scenes --gl glx", {"\"glx\" is not one of auto, osmesa"}},
        Wrong{"inspect spheres --set raster=opencl --pixel 1,1",
              {"--set raster: forward_plus does not read it"}},
        Wrong{"reference hall --places 5", {"--places 5: choose 1, 4, 16, 64 or 256"}},
        Wrong{"reference hall --set tile=8", {"--set tile: reference does not read it"}},
        Wrong{"reference spheres --size 8x4 -o FOLDER/r.exr --against FOLDER/none.exr", {"FOLDER/none.exr"}},
        Wrong{"info spheers", {"did you mean spheres?"}},
        Wrong{"render spheres --size 64", {"--size 64: not WxH"}}),
    [](const auto& info) { return name_of(info.param); });

}  // namespace
}  // namespace lightgrid::app
