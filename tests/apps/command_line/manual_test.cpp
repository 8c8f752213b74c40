// The man page and completions for shells, from the table that --help prints.
#include <gmock/gmock.h>

#include <regex>

#include "support/run_program.h"

namespace lightgrid::app {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

std::string manual(const char* form) {
  const ProgramRun run = run_program({"manual", form});
  EXPECT_EQ(run.status, 0) << run.err;
  return run.out;
}

// The long options of what --help prints.
std::vector<std::string> long_options(const std::string& help) {
  std::vector<std::string> options;
  const std::regex option("(?:^|\n) +(?:-[a-z],)?(--[a-z-]+)");
  for (std::sregex_iterator i(help.begin(), help.end(), option), end; i != end; ++i)
    options.push_back((*i)[1]);
  return options;
}

TEST(Manual, HasEachOptionOfEachCommandInEachForm) {
  const std::string page = manual("page"), bash = manual("bash"), zsh = manual("zsh"), fish = manual("fish");
  const auto part = [](const std::string& text, const std::string& begin, const std::string& end) {
    const size_t at = text.find(begin);
    return at == std::string::npos ? std::string() : text.substr(at, text.find(end, at + begin.size()) - at);
  };
  for (const std::string command :
       {"render", "compare", "plan", "capture", "cull", "inspect", "info", "scenes", "techniques", "devices",
        "bench", "verify", "frontier", "which", "golden", "check", "manual"}) {
    const std::vector<std::string> options = long_options(run_program({command, "--help"}).out);
    ASSERT_GT(options.size(), 0u) << command;
    for (const std::string& option : options) {
      const std::string name = option.substr(2);
      EXPECT_THAT(part(page, ".SS lightgrid " + command + "\n", ".SS"),
                  HasSubstr(std::regex_replace(option, std::regex("-"), "\\-")));
      EXPECT_THAT(part(bash, "    " + command + ") options=", ";;"), HasSubstr(option));
      EXPECT_THAT(part(zsh, "    " + command + ") _arguments", ";;"), HasSubstr("'*" + option + "["));
      EXPECT_TRUE(std::regex_search(fish, std::regex("from " + command + "'[^\n]* -l " + name + "\\b")))
          << command << ' ' << option;
    }
  }
  EXPECT_EQ(run_program({"manual", "tcsh"}).status, 2);
}

TEST(Manual, IsAPageWithoutWarnings) {
  const TempFolder folder;
  std::ofstream(folder.path / "lightgrid.1") << manual("page");
  const ProgramRun run =
      run_words({"groff", "-man", "-Tutf8", "-Kutf8", "-wall", folder.path / "lightgrid.1"});
  if (run.status != 0) GTEST_SKIP() << "no groff here";
  EXPECT_THAT(run.err, IsEmpty());
  EXPECT_THAT(run.out, HasSubstr("the machine lacks something"));
}

std::string completed(const std::filesystem::path& completion, const std::vector<std::string>& words) {
  std::string line = "source " + completion.string() + "; COMP_WORDS=(";
  for (const std::string& word : words) line += "'" + word + "' ";
  line += "); COMP_CWORD=" + std::to_string(words.size() - 1) + "; _lightgrid; echo \"${COMPREPLY[*]}\"";
  return run_words({"bash", "-c", line}).out;
}

TEST(Manual, CompletesWordsInBash) {
  const TempFolder folder;
  const std::filesystem::path completion = folder.path / "lightgrid";
  std::ofstream(completion) << manual("bash");
  EXPECT_EQ(completed(completion, {"lightgrid", "fron"}), "frontier\n");
  EXPECT_EQ(completed(completion, {"lightgrid", "render", "--siz"}), "--size\n");
  EXPECT_EQ(completed(completion, {"lightgrid", "render", "hal"}), "hall\n");
  EXPECT_EQ(completed(completion, {"lightgrid", "render", "-t", "visi"}), "visibility\n");
  EXPECT_EQ(completed(completion, {"lightgrid", "render", "--set", "far-l"}), "far-light=\n");
  EXPECT_EQ(completed(completion, {"lightgrid", "render", "-o", "no-such-fi"}), "\n") << "a file's name";
  EXPECT_EQ(completed(completion, {"lightgrid", "devices", "hal"}), "\n") << "has no scene";
}

TEST(Manual, HasNoFaultOfSyntaxForItsShell) {
  const TempFolder folder;
  for (const char* shell : {"bash", "zsh", "fish"}) {
    std::ofstream(folder.path / shell) << manual(shell);
    const ProgramRun run = run_words({shell, "-n", folder.path / shell});
    if (run.status == 127 || run.status == -1) continue;  // not installed
    EXPECT_EQ(run.status, 0) << shell << run.err;
  }
}

}  // namespace
}  // namespace lightgrid::app
