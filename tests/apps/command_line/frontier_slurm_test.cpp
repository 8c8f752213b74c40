// The program itself on a Slurm cluster: a task is killed, and the sweep submitted again ends with what one
// process measures.
#include <gmock/gmock.h>
#include <sys/wait.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "support/paths.h"
#include "support/read_files.h"
#include "support/run_command.h"
#include "support/run_program.h"

namespace lightgrid::app {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// The figures that do not depend on the machine's speed, by label.
json figures_of_answer(const fs::path& folder) {
  const json answer = json::parse(file_bytes(folder / "frontier.json"), nullptr, false);
  json figures = json::object();
  if (!answer.is_object()) return figures;
  for (const json& p : answer["points"]) {
    figures[p["label"].get<std::string>()] = {p["settings"], p["views"], p["error"], p["pairs"],
                                              p["memory_bytes"]};
  }
  return figures;
}

TEST(FrontierOnSlurm, EndsWithTheSameFiguresAfterAKill) {
  if (!std::getenv("LIGHTGRID_LONG_TESTS"))
    GTEST_SKIP() << "LIGHTGRID_LONG_TESTS=1 runs it; it takes a minute";
  const TempFolder folder;
  const std::string sweep =
      "spheres --size 48x27 --lights 32 --views 2 --budget 1 --rounds 6 --no-growth -t "
      "forward_plus,visibility "
      "--vary range=infinite";
  const std::string submit =
      std::string(source_folder) + "/docs/examples/slurm/submit.sh 2 parts " + sweep + "\n";
  const std::string wait = "for i in {1..1200}; do squeue -h | grep -q . || break; sleep 0.1; done\n";
  // Shard 1 runs when it has written the first line of its part.
  const std::string kill =
      "for i in {1..1200}; do [[ -s parts/records-1-of-2.jsonl ]] && break; sleep 0.1; done\n"
      "scancel --signal=KILL --full \"$(squeue -h -r -t R -o %A)\"; ";
  std::ofstream(folder.path / "run.sh")
      << submit << kill << wait << "grep -c finished parts/records-*; ls parts/frontier.json\n"
      << submit << wait;
  const CommandOutcome run =
      run_command("cd " + folder.path.string() + " && LIGHTGRID=" + lightgrid_program + " " + source_folder +
                  "/tests/laboratory/frontier/slurm_cluster.sh $PWD/cluster bash run.sh 2>&1");
  if (WIFEXITED(run.status) && WEXITSTATUS(run.status) == 77) GTEST_SKIP() << run.output;
  EXPECT_THAT(run.output, testing::HasSubstr("records-0-of-2.jsonl:1\nparts/records-1-of-2.jsonl:0"))
      << "shard 1 was not killed";
  EXPECT_THAT(run.output, testing::HasSubstr("cannot access 'parts/frontier.json'"))
      << "joined without shard 1";

  std::istringstream words("frontier " + sweep + " -o " + (folder.path / "one").string());
  const ProgramRun one = run_program({std::istream_iterator<std::string>(words), {}});
  ASSERT_EQ(one.status, 0) << one.err;
  const json figures = figures_of_answer(folder.path / "one");
  EXPECT_EQ(figures.size(), 4u);
  EXPECT_EQ(figures_of_answer(folder.path / "parts"), figures) << run.output;
}

}  // namespace
}  // namespace lightgrid::app
