// docs/results/frontier.md, docs/results/families.md, their pictures and their tables are what their samples
// make.
#include <gmock/gmock.h>

#include "support/read_files.h"
#include "support/run_program.h"

namespace lightgrid {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

ProgramRun checked_pages(const fs::path& root) {
  return run_words({"python3", root / "tools/frontier_pages.py", "--check", "--program", lightgrid_program});
}

TEST(FrontierPages, AreMadeFromTheirSamples) {
  if (run_words({"python3", "--version"}).status != 0) GTEST_SKIP() << "no Python here";
  const ProgramRun run = checked_pages(source_folder);
  EXPECT_EQ(run.status, 0) << run.out << run.err;
}

// The check can fail: for each file, with one figure changed.
TEST(FrontierPages, OfOtherFiguresAreFound) {
  if (run_words({"python3", "--version"}).status != 0) GTEST_SKIP() << "no Python here";
  const TempFolder folder;
  for (const char* path : {"tools", "docs/results/frontier", "docs/images"})
    fs::create_directories(folder.path / path);
  const fs::path from = source_folder, page = "docs/results/frontier.md",
                 table = "docs/results/frontier/h100.csv", picture = "docs/images/frontier_planes.svg",
                 families = "docs/results/families.md", curves = "docs/images/families.svg",
                 passes = "docs/images/families_passes.svg", scripts = "tools";
  for (const fs::path& file : {scripts / "frontier_pages.py", scripts / "frontier_table.py",
                               scripts / "family_pages.py", page, picture, families, curves, passes})
    fs::copy(from / file, folder.path / file);
  fs::copy(from / table.parent_path(), folder.path / table.parent_path(), fs::copy_options::recursive);
  const ProgramRun copy = checked_pages(folder.path);
  ASSERT_EQ(copy.status, 0) << copy.err;
  for (const fs::path& file : {page, table, picture, families, curves, passes}) {
    const std::string right = file_bytes(folder.path / file);
    std::string wrong = right;
    // The first one that is made in the page, the last one of the others.
    const size_t figure = file == page       ? wrong.find("0.", wrong.find("<!-- made: h100 front"))
                          : file == families ? wrong.find("0.", wrong.find("<!-- made: families steps"))
                                             : wrong.rfind("0.");
    ASSERT_NE(figure, std::string::npos) << file;
    wrong[figure] = '7';
    std::ofstream(folder.path / file) << wrong;
    const ProgramRun run = checked_pages(folder.path);
    EXPECT_EQ(run.status, 1) << file;
    EXPECT_THAT(run.err, HasSubstr(file.string() + ": is not what its samples make"));
    std::ofstream(folder.path / file) << right;
  }
}

}  // namespace
}  // namespace lightgrid
