// `lightgrid devices` as a user runs it: what it prints, where, and its exit status.
#include <gmock/gmock.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include <nlohmann/json.hpp>

#include "support/paths.h"

namespace {

using testing::HasSubstr;

struct Ran {
  int status = -1;
  std::string out, err;
};

// `environment` precedes the program, as in a shell.
Ran run_devices(const std::string& arguments, const std::string& environment = "") {
  const std::string errors = testing::TempDir() + "/devices_stderr." + std::to_string(getpid());
  const std::string command =
      environment + " '" + lightgrid::lightgrid_program + "' devices " + arguments + " 2>'" + errors + "'";
  Ran ran;
  FILE* pipe = popen(command.c_str(), "r");
  std::array<char, 4096> block;
  for (size_t got; (got = fread(block.data(), 1, block.size(), pipe)) > 0;) ran.out.append(block.data(), got);
  ran.status = WEXITSTATUS(pclose(pipe));
  std::ifstream stream(errors);
  ran.err = {std::istreambuf_iterator<char>(stream), {}};
  std::remove(errors.c_str());
  return ran;
}

TEST(DevicesCommand, ListsDevicesBackendsAndTheBridgeAndMarksOneOfEach) {
  const Ran ran = run_devices("--json -");
  ASSERT_EQ(ran.status, 0) << ran.err;
  const auto json = nlohmann::json::parse(ran.out);
  int cl_chosen = 0, gl_chosen = 0;
  for (const auto& device : json["cl"]) cl_chosen += device["chosen"].get<bool>();
  for (const auto& backend : json["gl"]) gl_chosen += backend["chosen"].get<bool>();
  EXPECT_EQ(cl_chosen, 1);
  EXPECT_EQ(gl_chosen, 1);
  EXPECT_THAT(json["bridge"], testing::AnyOf("mapped", "imported", "staged"));
  EXPECT_THAT(json["problems"], testing::IsEmpty());
  EXPECT_EQ(ran.err, "");
}

TEST(DevicesCommand, MarksTheBackendThatWasAskedFor) {
  const auto json = nlohmann::json::parse(run_devices("--gl egl --json -").out);
  for (const auto& backend : json["gl"]) EXPECT_EQ(backend["chosen"], backend["backend"] == "egl");
}

TEST(DevicesCommand, SaysWhyTheBridgeIsStagedAndFailsWhereAForcedOneIsMissing) {
  const Ran staged = run_devices("", "LIGHTGRID_BRIDGE=staged");
  EXPECT_THAT(staged.out, HasSubstr("Bridge\n  staged: LIGHTGRID_BRIDGE=staged\n"));
  const auto json = nlohmann::json::parse(run_devices("--json -", "LIGHTGRID_BRIDGE=staged").out);
  EXPECT_EQ(json["bridge"], "staged");
  EXPECT_EQ(json["why_staged"], "LIGHTGRID_BRIDGE=staged");
  const Ran imported = run_devices("--gl osmesa", "LIGHTGRID_BRIDGE=imported");
  EXPECT_EQ(imported.status, 3);
  EXPECT_THAT(imported.err, HasSubstr("LIGHTGRID_BRIDGE=imported: OpenGL draws in software"));
}

TEST(DevicesCommand, StillListsTheRestWithoutAnyOpenClDeviceAndNamesThePackage) {
  const Ran ran = run_devices("", "OCL_ICD_VENDORS=/nonexistent");
  EXPECT_EQ(ran.status, 0);
  EXPECT_THAT(ran.out, HasSubstr("OpenCL devices\n  none\n"));
  EXPECT_THAT(ran.out, HasSubstr("egl"));
  EXPECT_THAT(ran.err, HasSubstr("pocl-opencl-icd"));
}

TEST(DevicesCommand, ListsAllAndFailsWhereTheNamedDeviceIsNotThere) {
  const Ran ran = run_devices("--device nosuchdevice");
  EXPECT_EQ(ran.status, 3);
  EXPECT_THAT(ran.out, HasSubstr("OpenGL backends"));
  EXPECT_THAT(ran.err, HasSubstr("\"nosuchdevice\""));
}

// PoCL offers as many devices of one name as configured.
TEST(DevicesCommand, TellsDevicesOfOneNameApartByTheirNumber) {
  const char* two = "POCL_DEVICES='pthread pthread'";
  for (const int chosen : {0, 1}) {
    const Ran ran = run_devices("--json - --device '#" + std::to_string(chosen) + "'", two);
    ASSERT_EQ(ran.status, 0) << ran.err;
    const auto json = nlohmann::json::parse(ran.out);
    if (json["cl"].size() != 2) GTEST_SKIP() << "this machine's OpenCL does not heed POCL_DEVICES";
    EXPECT_EQ(json["cl"][0]["name"], json["cl"][1]["name"]);
    for (int i = 0; i < 2; ++i) EXPECT_EQ(json["cl"][i]["chosen"], i == chosen);
  }
  EXPECT_THAT(run_devices("", two).out, HasSubstr("  #1 "));
}

TEST(DevicesCommand, RefusesAnUnknownBackend) {
  const Ran ran = run_devices("--gl glx");
  EXPECT_EQ(ran.status, 2);
  EXPECT_EQ(ran.out, "");
  EXPECT_THAT(ran.err, HasSubstr("\"glx\""));
}

TEST(DevicesCommand, RefusesAFileThatCannotBeWritten) {
  const Ran ran = run_devices("--json /dev/null/devices.json");
  EXPECT_EQ(ran.status, 2);
  EXPECT_THAT(ran.err, HasSubstr("/dev/null/devices.json"));
}

}  // namespace
