// The catalogue of hard cases on the test machine's OpenCL device, group by group, and the ten of them that
// the document shows.
#include <gmock/gmock.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <set>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "support/paths.h"
#include "support/run_program.h"
#include "verify/run.h"

namespace lightgrid::lab::verify {
namespace {

struct HardCasesOf : testing::TestWithParam<const char*> {};

// One for all groups, which share kernels; never closed, as support/devices.h says.
std::vector<std::unique_ptr<CullEngine>>& engines() {
  static auto* const all = [] {
    auto* const made = new std::vector<std::unique_ptr<CullEngine>>;
    // The shape for GPUs has one form, which the run without POCL_KERNELLIB_NAME holds; in the first tier the
    // tests of culling do (tests/suites.cmake).
    made->push_back(device_engine("", {}, std::getenv("LIGHTGRID_TEST_CPU_SHAPE") == nullptr));
    return made;
  }();
  return *all;
}

TEST_P(HardCasesOf, Hold) {
  const VerifyReport report = run_cases(engines(), {.filter = std::string("^") + GetParam() + "/"});
  const auto of_group = [](const HardCase& c) { return std::string(c.group) == GetParam(); };
  ASSERT_EQ(report.cases.size(), size_t(std::ranges::count_if(hard_cases(), of_group)));
  for (const CaseResult& result : report.cases) {
    EXPECT_EQ(result.outcome.verdict, Verdict::pass) << result.hard_case->name << ": " << result.outcome.why;
    EXPECT_EQ(result.outcome.lost, 0u) << result.hard_case->name;
  }
}

INSTANTIATE_TEST_SUITE_P(Verify, HardCasesOf,
                         testing::Values("depth", "camera", "lights", "lists", "agreement", "raster",
                                         "samples"),
                         [](const auto& info) { return std::string(info.param); });

// Cases that draw pictures with techniques, whose own tests are in the first tier.
INSTANTIATE_TEST_SUITE_P(Drawn, HardCasesOf,
                         testing::Values("shadows", "lidr", "groups", "caps", "light_profiles",
                                         "light_cookies", "light_hulls", "environment_light", "area_lights",
                                         "far_light"),
                         [](const auto& info) { return std::string(info.param); });

// Not a fault of the library, and no claim about it.
TEST(Verify, SkipsACaseWhoseKernelTheDriverCannotBuild) {
  std::vector<std::unique_ptr<CullEngine>> cannot_build;
  cannot_build.push_back(
      device_engine("", [](std::string text) { return "#error no such builtin\n" + text; }));
  const VerifyReport report = run_cases(cannot_build, {.filter = "^shadows/edges_of_cones$"});
  ASSERT_EQ(report.cases.size(), 1u);
  EXPECT_EQ(report.failed, 0);
  EXPECT_EQ(report.unbuilt, 1);
  EXPECT_EQ(report.cases[0].outcome.verdict, Verdict::skip);
  EXPECT_THAT(report.cases[0].outcome.why, testing::HasSubstr("choose another device with --device"));
}

TEST(Verify, ReportsEachCaseBeforeTheNextBegins) {
  std::vector<std::unique_ptr<CullEngine>> cannot_build;
  cannot_build.push_back(
      device_engine("", [](std::string text) { return "#error no such builtin\n" + text; }));
  std::vector<std::string> events;
  run_cases(cannot_build,
            {.filter = "^depth/(all_sky|flat_wall)$",
             .found = [&](const CaseResult& result) { events.push_back("end of " + result.hard_case->name); },
             .progress = [&](double, const std::string& step) { events.push_back(step); }});
  EXPECT_THAT(events, testing::ElementsAre("depth/all_sky", "end of all_sky", "depth/flat_wall",
                                           "end of flat_wall", "done"));
}

// Each has a unique name and is in one of the groups that HardCasesOf.Hold runs.
TEST(HardCases, HaveNamesOfTheirOwnAndAGroupThatIsRun) {
  const std::set<std::string> groups = {
      "depth",       "camera",         "lights",        "lists",       "agreement",
      "raster",      "shadows",        "lidr",          "groups",      "samples",
      "caps",        "light_profiles", "light_cookies", "light_hulls", "environment_light",
      "area_lights", "far_light"};
  std::set<std::string> names, used;
  for (const HardCase& c : hard_cases()) {
    EXPECT_TRUE(names.insert(c.name).second) << c.name;
    used.insert(c.group);
  }
  EXPECT_EQ(used, groups);
}

// docs/hard_cases.md shows ten of the rows that `lightgrid verify --list` prints.
TEST(HardCases, OfTheDocumentAreInTheCatalogue) {
  std::ifstream file(std::string(source_folder) + "/docs/hard_cases.md");
  const std::vector<std::string> catalogue = catalogue_rows(chosen_cases(""));
  int rows = 0;
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with("| ") || !std::isdigit(line[2]) || line.find(" | `") == std::string::npos) continue;
    EXPECT_THAT(catalogue, testing::Contains(line));
    ++rows;
  }
  EXPECT_EQ(rows, 10);
}

TEST(VerifyCommand, TellsEachCaseAsJson) {
  const ProgramRun run = run_program({"verify", "--filter", "depth/(all_sky|flat_wall)$", "--json", "-"});
  ASSERT_EQ(run.status, 0) << run.err;
  const auto json = nlohmann::json::parse(run.out);
  EXPECT_EQ(json["failed"], 0);
  ASSERT_GE(json["devices"].size(), 1u);
  ASSERT_EQ(json["cases"].size(), 2 * json["devices"].size());
  for (const auto& row : json["cases"]) {
    EXPECT_EQ(row["group"], "depth");
    EXPECT_EQ(row["result"], "pass");
    EXPECT_EQ(row["lost"], 0);
    EXPECT_GT(row["trials"], 0);
    EXPECT_TRUE(row["contacts"].is_number_unsigned());
    for (const char* key : {"name", "device", "excess_ratio", "why"}) EXPECT_TRUE(row.contains(key)) << key;
  }
}

TEST(VerifyCommand, RefusesAFilterThatNamesNothing) {
  EXPECT_EQ(run_program({"verify", "--filter", "("}).status, 2);
  EXPECT_EQ(run_program({"verify", "--filter", "no such case"}).status, 2);
  EXPECT_EQ(run_program({"verify", "--device", "no such device"}).status, 3);
}

}  // namespace
}  // namespace lightgrid::lab::verify
