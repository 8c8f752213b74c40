// Text typed at the command line: mistakes get one line that helps, and an option means the same in every
// command.
#include <gmock/gmock.h>

#include <algorithm>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include "support/gltf_builder.h"
#include "support/read_files.h"
#include "support/run_program.h"

namespace lightgrid {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

struct Mistake {
  std::vector<std::string> typed;
  std::string helps;  // part of the line
};

// FOLDER stands for a folder of the test.
const Mistake mistakes[] = {
    {{"rendre", "hall"}, "there is no command rendre; did you mean render?"},
    {{"comapre"}, "did you mean compare?"},
    {{"tech"}, "did you mean techniques?"},
    {{"render", "hall", "--sise", "64x36"}, "render has no option --sise; did you mean --size?"},
    {{"compare", "hall", "--technque", "forward"}, "did you mean --technique?"},
    {{"compare", "hall", "--ouput=FOLDER/r"}, "did you mean --output?"},
    {{"verify", "--fliter", "depth"}, "verify has no option --fliter; did you mean --filter?"},
    {{"render", "hal", "-o", "FOLDER/x.png"}, "did you mean hall?"},
    {{"compare", "hall", "terrian", "-o", "FOLDER/r"}, "did you mean terrain?"},
    {{"render", "hall", "-t", "forwardplus", "-o", "FOLDER/x.png"}, "did you mean forward_plus?"},
    {{"compare", "hall", "-t", "forward,visiblity", "-o", "FOLDER/r"}, "did you mean visibility?"},
    {{"compare", "hall", "-t", "Forward-Plus,defered", "-o", "FOLDER/r"}, "did you mean forward_plus?"},
    {{"render", "hall", "-t", "forward,forward_plus", "-o", "FOLDER/x.png"}, "compare takes several"},
    {{"render", "hall", "-t", "forward", "--set", "slices=8", "-o", "FOLDER/x.png"},
     "--set slices: forward does not read it"},
    {{"compare", "hall", "-t", "forward,forward_plus", "--set", "slices=8", "-o", "FOLDER/r"},
     "--set slices: forward, forward_plus do not read it"},
    {{"render", "spheres", "--camera-path", "turn:0", "-o", "FOLDER/x.png"},
     "--camera-path turn:0: not turn:N"},
    {{"render", "spheres", "--exposure", "bright", "-o", "FOLDER/x.png"},
     "--exposure bright: neither auto nor a number"},
    {{"render", "spheres", "--exposure", "100", "-o", "FOLDER/x.png"}, "from -60 to 60"},
    {{"render", "spheres", "--set", "tyle=8", "-o", "FOLDER/x.png"}, "did you mean tile?"},
    {{"render", "spheres", "--set", "range=cut-off", "-o", "FOLDER/x.png"}, "did you mean cutoff?"},
    {{"render", "spheres", "--set", "cutoff=0", "-o", "FOLDER/x.png"},
     "--set cutoff=0: cutoff is a number from"},
    {{"verify", "--gl", "glx", "--list"}, "\"glx\" is not one of auto, osmesa"},
    {{"scenes", "--gl", "glx"}, "\"glx\" is not one of auto, osmesa"},
    {{"inspect", "spheres", "--set", "raster=opencl", "--pixel", "1,1"},
     "--set raster: forward_plus does not read it"},
    {{"info", "spheers"}, "did you mean spheres?"},
    {{"render", "spheres", "--size", "64", "-o", "FOLDER/x.png"}, "--size 64: not WxH"},
};

TEST(Typing, OfAMistakeGetsOneLineThatHelps) {
  for (const Mistake& mistake : mistakes) {
    const TempFolder folder;
    std::vector<std::string> words = mistake.typed;
    std::string all;
    for (std::string& word : words) {
      if (const size_t at = word.find("FOLDER"); at != std::string::npos) word.replace(at, 6, folder.path);
      all += word + " ";
    }
    const ProgramRun run = run_program(words, {"OCL_ICD_VENDORS=/nonexistent"});
    EXPECT_EQ(run.status, 2) << all << run.err;
    EXPECT_EQ(run.out, "") << all;
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << all << run.err;
    EXPECT_THAT(run.err, HasSubstr(mistake.helps)) << all;
    EXPECT_TRUE(std::filesystem::is_empty(folder.path)) << all;
  }
}

TEST(Typing, OfNothingListsTheCommandsAndOfVersionTheCommit) {
  const ProgramRun nothing = run_program({});
  EXPECT_EQ(nothing.status, 0);
  for (const char* command : {"render", "compare", "info", "view", "frontier"})
    EXPECT_THAT(nothing.out, HasSubstr(std::string("\n  ") + command + " "));
  EXPECT_EQ(run_program({"help"}).out, nothing.out);
  EXPECT_EQ(run_program({"help", "info"}).out, run_program({"info", "--help"}).out);
  const ProgramRun version = run_program({"--version"});
  EXPECT_EQ(version.status, 0);
  EXPECT_TRUE(std::regex_match(version.out, std::regex(R"(lightgrid \d+\.\d+\.\d+, commit \S+\n)")))
      << version.out;
}

TEST(Typing, ASpaceAfterACommaIsNoMistake) {
  const TempFolder folder;
  const std::string out = folder.path / "r";
  const ProgramRun spaced = run_program({"compare", "spheres", "--size", "16x9,", "17x9", "--lights", "1, 2",
                                         "-t", "visibility:lights=all,", "texels=8,", "visibility", "--gl",
                                         "none", "--frames", "1", "-o", out});
  EXPECT_EQ(spaced.status, 0) << spaced.err;
  const auto json = nlohmann::json::parse(file_bytes(std::filesystem::path(out) / "results.json"));
  ASSERT_EQ(json["views"].size(), 4u);
  EXPECT_EQ(json["views"][0]["rows"].size(), 2u);
  EXPECT_EQ(json["views"][0]["rows"][0]["settings"]["texels"], 8);
}

TEST(Typing, OfATechniqueIsTheSameInEveryCommand) {
  const TempFolder folder;
  const auto frame = [&](const std::vector<std::string>& words) {
    std::vector<std::string> all = {"render", "spheres", "--size", "16x9",
                                    "--gl",   "none",    "-o",     folder.path / "x.exr"};
    all.insert(all.end(), words.begin(), words.end());
    const ProgramRun run = run_program(all);
    EXPECT_EQ(run.status, 0) << run.err;
    return file_bytes(folder.path / "x.exr");
  };
  const std::string set = frame({"-t", "visibility", "--set", "brdf=lambert", "--set", "texels=8"});
  EXPECT_EQ(frame({"--techniques", "visibility:brdf=lambert,texels=8"}), set);
  EXPECT_EQ(frame({"--technique", "visibility:brdf=lambert,", "texels=8"}), set);
  EXPECT_NE(frame({"-t", "visibility"}), set);
}

TEST(Typing, OfATimeOrAMotionWithoutEffectIsTold) {
  const TempFolder folder;
  const std::vector<std::string> render = {"render", "spheres", "--size",     "16x9", "--gl",
                                           "none",   "-t",      "visibility", "-o",   folder.path / "x.png"};
  const auto told = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words = render;
    words.insert(words.end(), more.begin(), more.end());
    const ProgramRun run = run_program(words);
    EXPECT_EQ(run.status, 0) << run.err;
    return run.err;
  };
  EXPECT_THAT(told({"--time", "2"}), HasSubstr("spheres has no animation"));
  EXPECT_THAT(told({"--light-motion", "orbit"}),
              HasSubstr("light-motion orbit: lights move along a camera-path; without one"));
  EXPECT_EQ(told({"--light-motion", "orbit", "--time", "1", "--camera-path", "turn:1"}), "");
}

struct Option {
  std::string names, text;
};

// By the first long name, as --help has them.
std::map<std::string, Option> options_of(const std::string& command) {
  std::map<std::string, Option> options;
  std::istringstream help(run_program({command, "--help"}).out);
  const std::regex row(R"(^  ((?:-\w,)?--[\w-]+(?:,--[\w-]+)*)( \S.*?)?(?: {2,}(\S.*))?$)");
  std::smatch found;
  Option* last = nullptr;
  for (std::string line; std::getline(help, line);) {
    if (line.starts_with("          ") && last && last->text.empty())
      last->text = line.substr(line.find_first_not_of(' '));
    last = nullptr;
    if (!std::regex_match(line, found, row)) continue;
    const std::string names = found[1];
    const size_t begin = names.find("--");
    last = &options[names.substr(begin, names.find(',', begin) - begin)];
    *last = {names, found[3]};
  }
  return options;
}

// Options of one name have the same short names and the same words in every command, but for those whose
// value is what the command itself is about.
TEST(Options, MeanTheSameInEveryCommand) {
  const std::set<std::string> own_words = {"--size",    // compare takes several
                                           "--lights",  // likewise
                                           "--technique",   "--output",  "--compare", "--filter", "--frames",
                                           "--replay",      "--seed",    "--set",     "--device", "--json",
                                           "--camera-path", "--page-mb", "--gl",      "--sarif"};
  std::map<std::string, std::pair<std::string, Option>> first;
  size_t compared = 0;
  for (const char* command :
       {"render", "compare", "plan", "capture", "cull", "inspect", "info", "scenes", "techniques", "devices",
        "bench", "verify", "view", "frontier", "golden", "check"}) {
    const std::map<std::string, Option> options = options_of(command);
    EXPECT_TRUE(options.contains("--gl")) << command;
    EXPECT_TRUE(options.contains("--json") || std::string(command) == "view") << command;
    EXPECT_GE(options.size(), 3u) << command;
    for (const auto& [name, option] : options) {
      const auto [earlier, is_new] = first.try_emplace(name, command, option);
      if (is_new) continue;
      ++compared;
      EXPECT_EQ(option.names, earlier->second.second.names)
          << name << " of " << command << " and " << earlier->second.first;
      if (own_words.contains(name)) continue;
      EXPECT_EQ(option.text, earlier->second.second.text)
          << name << " of " << command << " and " << earlier->second.first;
    }
  }
  EXPECT_GT(compared, 60u);
}

}  // namespace
}  // namespace lightgrid
