// docs/results/frontier.md, docs/results/families.md, their pictures and their tables are what their samples
// make.
#include <gmock/gmock.h>

#include <set>
#include <sstream>

#include "support/read_files.h"
#include "support/run_program.h"

namespace lightgrid::app {
namespace {

namespace fs = std::filesystem;

ProgramRun checked_pages(const fs::path& root) {
  return run_words({"python3", root / "tools/frontier_pages.py", "--check", "--program", lightgrid_program});
}

TEST(FrontierPages, AreMadeFromTheirSamples) {
  if (run_words({"python3", "--version"}).status != 0) GTEST_SKIP() << "no Python here";
  const ProgramRun run = checked_pages(source_folder);
  EXPECT_EQ(run.status, 0) << run.out << run.err;
}

// The first figure of a page's last made block, the last one of a table or picture.
void change_a_figure(const fs::path& file) {
  std::string text = file_bytes(file);
  const size_t made = text.rfind("<!-- made: ");
  const size_t figure = made == std::string::npos ? text.rfind("0.") : text.find("0.", made);
  ASSERT_NE(figure, std::string::npos) << file;
  text[figure] = '7';
  std::ofstream(file) << text;
}

// The check can fail: it names the files in which one figure is changed, and no other.
TEST(FrontierPages, OfOtherFiguresAreFound) {
  if (run_words({"python3", "--version"}).status != 0) GTEST_SKIP() << "no Python here";
  const TempFolder folder;
  for (const char* path : {"tools", "docs/results/frontier", "docs/images"})
    fs::create_directories(folder.path / path);
  const fs::path from = source_folder, scripts = "tools";
  std::vector<fs::path> files = {"docs/results/frontier.md", "docs/images/frontier_planes.svg",
                                 "docs/results/families.md", "docs/images/families.svg",
                                 "docs/images/families_passes.svg"};
  for (const char* script : {"frontier_pages.py", "frontier_table.py", "family_pages.py"})
    fs::copy(from / scripts / script, folder.path / scripts / script);
  for (const fs::path& file : files) fs::copy(from / file, folder.path / file);
  fs::copy(from / "docs/results/frontier", folder.path / "docs/results/frontier",
           fs::copy_options::recursive);
  files.push_back("docs/results/frontier/h100.csv");
  std::set<std::string> expected;
  for (const fs::path& file : files) {
    change_a_figure(folder.path / file);
    expected.insert(file.string() + ": is not what its samples make");
  }
  const ProgramRun run = checked_pages(folder.path);
  EXPECT_EQ(run.status, 1);
  std::istringstream lines(run.err);
  std::set<std::string> named;
  for (std::string line; std::getline(lines, line);) named.insert(line);
  EXPECT_EQ(named, expected);
}

}  // namespace
}  // namespace lightgrid::app
