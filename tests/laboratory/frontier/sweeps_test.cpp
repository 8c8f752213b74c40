// The scripts of docs/examples that measure a sweep in parts, with a stand-in for the program: which calls
// they make, and that a killed part goes on.
#include <gmock/gmock.h>

#include <filesystem>

#include "support/paths.h"
#include "support/read_files.h"
#include "support/run_command.h"
#include "support/temp_folder.h"

namespace lightgrid::lab {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;
using testing::UnorderedElementsAre;

const std::string tests_folder = std::string(source_folder) + "/tests/laboratory/frontier";
const std::string examples_folder = std::string(source_folder) + "/docs/examples";

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

// Each part with the arguments as they were given, a space in one of them; shard 1 once more; then merge,
// although shard 2 ends with status 1.
void expect_calls(const std::filesystem::path& folder) {
  const std::string at = "[-o][" + folder.string() + "]",
                    arguments = "[frontier][a scene.glb][--vary][tile=8,16]" + at + "[--shard]";
  const auto calls = lines_of(file_bytes(folder / "calls"));
  const std::set<std::string> different(calls.begin(), calls.end());
  EXPECT_THAT(different, UnorderedElementsAre(arguments + "[0/3]", arguments + "[1/3]", arguments + "[2/3]",
                                              "[frontier][merge][" + folder.string() + "]" + at));
  EXPECT_GE(std::count(calls.begin(), calls.end(), arguments + "[1/3]"), 2);
  EXPECT_THAT(calls.back(), HasSubstr("[merge]"));
  EXPECT_EQ(file_bytes(folder / "answer"), "point 0\npoint 1\npoint 2\npoint 3\npoint 4\npoint 5\npoint 6\n");
}

TEST(Sweeps, RunByGnuParallel) {
  if (run_command("parallel --version 2>&1").output.find("GNU parallel") == std::string::npos) {
    GTEST_SKIP() << "GNU parallel is not installed";
  }
  const TempFolder folder;
  const CommandOutcome run = run_command(
      "cd " + folder.path.string() + " && HOME=$PWD LIGHTGRID=" + tests_folder + "/stand_in.sh " +
      examples_folder + "/parallel/frontier.sh 3 'the answer' 'a scene.glb' --vary tile=8,16 2>&1");
  EXPECT_EQ(run.status, 0) << run.output;
  expect_calls(folder.path / "the answer");
  EXPECT_EQ(file_bytes(folder.path / "the answer/records-2-of-3.jsonl"), "point 2\npoint 5\n");
  const std::string calls = file_bytes(folder.path / "the answer/calls");
  EXPECT_EQ(calls.find("[2/3]"), calls.rfind("[2/3]")) << "status 1 is not a failure";
}

// A part that fails cancels the join; submitted again, the sweep is completed.
TEST(Sweeps, RunOnSlurm) {
  const TempFolder folder;
  const std::string wait = "; for i in {1..1200}; do squeue -h | grep -q . || break; sleep 0.1; done; ";
  const std::string submit = examples_folder + "/slurm/submit.sh 3 answer 'a scene.glb' --vary tile=8,16";
  const std::string command =
      submit + wait + "ls answer/answer; cat answer/part-1.log; " + submit + wait + "cat answer/merge.log";
  std::ofstream(folder.path / "run.sh") << command << "\n";
  const CommandOutcome run =
      run_command("cd " + folder.path.string() + " && LIGHTGRID=" + tests_folder + "/stand_in.sh " +
                  tests_folder + "/slurm_cluster.sh $PWD/cluster bash run.sh 2>&1");
  if (WIFEXITED(run.status) && WEXITSTATUS(run.status) == 77) GTEST_SKIP() << run.output;
  EXPECT_EQ(run.status, 0) << run.output;
  EXPECT_THAT(run.output, HasSubstr("ls: cannot access 'answer/answer'")) << "joined without a part";
  expect_calls(std::filesystem::canonical(folder.path / "answer"));
}

TEST(Sweeps, ExplainTheirArguments) {
  for (const char* script : {"/slurm/submit.sh", "/parallel/frontier.sh"}) {
    for (const char* arguments : {"", " 3", " x out", " 0 out", " -1 out"}) {
      const CommandOutcome run = run_command(examples_folder + script + arguments + " 2>&1");
      EXPECT_EQ(WEXITSTATUS(run.status), 2) << script << arguments;
      EXPECT_THAT(run.output, HasSubstr("PARTS FOLDER [ARGUMENT of lightgrid frontier…]"));
    }
  }
}

}  // namespace
}  // namespace lightgrid::lab
