// The worked examples of docs/details/adding.md, followed to the letter.
#include <gtest/gtest.h>

#include <iostream>

#include "support/paths.h"
#include "support/run_program.h"

namespace lightgrid::app {
namespace {

TEST(Recipes, AddACullTestAndATechniqueInAsManyPlacesAsTheySay) {
  const std::filesystem::path build = std::filesystem::path(lightgrid_program).parent_path().parent_path();
  const ProgramRun run = run_words(
      {"bash", std::string(source_folder) + "/tests/apps/command_line/recipes.sh", source_folder, build}, {},
      std::chrono::seconds(1500));
  if (run.status == 77) GTEST_SKIP() << run.out;
  EXPECT_EQ(run.status, 0) << run.out << run.err;
  std::cout << run.out << run.err;
}

}  // namespace
}  // namespace lightgrid::app
