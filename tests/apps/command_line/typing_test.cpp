// Text typed at the command line: an option means the same in every command. Mistakes:
// wrong_arguments_test.cpp.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include "support/read_files.h"
#include "support/run_program.h"

namespace lightgrid::app {
namespace {

using testing::HasSubstr;

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
        "bench", "verify", "view", "frontier", "which", "golden", "check"}) {
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
}  // namespace lightgrid::app
