// The program on a machine without OpenGL: what it draws, what it leaves out, and what it says.
#include <gmock/gmock.h>
#include <stdlib.h>

#include <algorithm>

#include <nlohmann/json.hpp>

#include "support/paths.h"
#include "support/read_files.h"
#include "support/run_program.h"

namespace lightgrid::app {
namespace {

using testing::HasSubstr;

ProgramRun run_without_opengl(const std::vector<std::string>& arguments) {
  const char* sanitizer = std::getenv("ASAN_OPTIONS");  // its library would have to come first
  return run_program(arguments,
                     {std::string("LD_PRELOAD=") + no_opengl_library,
                      std::string("ASAN_OPTIONS=verify_asan_link_order=0:") + (sanitizer ? sanitizer : "")});
}

TEST(WithoutOpenGl, CompareShowsVisibilityAndSaysWhatItLeavesOut) {
  const TempFolder folder;
  const ProgramRun run =
      run_without_opengl({"compare", "spheres", "--size", "64x36", "--frames", "1", "-o", folder.path});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
  EXPECT_THAT(run.err, HasSubstr("libOSMesa.so.8 is not installed"));
  EXPECT_THAT(run.err, HasSubstr("libosmesa6"));
  EXPECT_THAT(run.err, HasSubstr("left out, since they draw with it: forward, forward_plus"));
  EXPECT_THAT(run.out, HasSubstr("visibility:lights="));
  const auto results = nlohmann::json::parse(file_bytes(folder.path / "results.json"));
  EXPECT_EQ(results["reference"]["technique"], "visibility:lights=all");
  EXPECT_EQ(results["reference"]["pixels"], 64 * 36);
  EXPECT_LT(results["reference"]["surfaces"]["rmse_rel"], 1e-4);
  EXPECT_EQ(results["devices"]["gl"], "none");
  ASSERT_EQ(results["rows"].size(), 2u);
  const auto& row = results["rows"][1];
  EXPECT_EQ(row["technique"], "visibility");
  EXPECT_EQ(row["settings"]["lights"], "grid");
  EXPECT_EQ(row["error"]["bit_identical"], true);
  EXPECT_TRUE(row["error"]["oracle"].is_null());
  EXPECT_EQ(row["error"]["surfaces"], results["reference"]["surfaces"]) << "the same bits";
  EXPECT_GT(row["pairs"]["lit"], 0);
  EXPECT_EQ(row["pairs"]["lost"], 0);
  for (const auto& pass : row["passes"]) EXPECT_EQ(pass["on"], "cl") << pass;
}

TEST(WithoutOpenGl, OtherTechniquesByNameEndWithThreeAndNameThePackage) {
  const TempFolder folder;
  const std::string out = folder.path / "x.png";
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"render", "spheres", "--size", "16x9", "-t", "forward_plus", "-o", out},
        {"compare", "spheres", "--size", "16x9", "-t", "forward,visibility", "-o", folder.path},
        {"capture", "spheres", "--size", "16x9", "-t", "clustered", "-o", folder.path}}) {
    const ProgramRun run = run_without_opengl(arguments);
    EXPECT_EQ(run.status, 3) << run.err;
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    EXPECT_THAT(run.err, HasSubstr("libosmesa6"));
    EXPECT_THAT(run.err, HasSubstr("visibility"));
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path));
}

TEST(WithoutOpenGl, RenderDrawsTheBytesThatItDrawsWithIt) {
  const TempFolder folder;
  const auto render = [&](const std::string& name, std::vector<std::string> more) {
    more.insert(more.begin(), {"render", "spheres", "--size", "64x36", "-o", folder.path / name});
    return run_program(more);
  };
  ASSERT_EQ(render("with.exr", {"-t", "visibility", "--gl", "auto"}).status, 0);
  const ProgramRun without = render("without.exr", {"--gl", "none"});
  ASSERT_EQ(without.status, 0) << without.err;
  EXPECT_THAT(without.err, HasSubstr("visibility takes the place of forward_plus"));
  EXPECT_TRUE(file_bytes(folder.path / "with.exr") == file_bytes(folder.path / "without.exr"));
  EXPECT_EQ(render("not.exr", {"--gl", "none", "-t", "lidr"}).status, 3);
  EXPECT_EQ(render("not.exr", {"--gl", "none", "-t", "deferred_tiled"}).status, 3);
  const ProgramRun chosen = render(
      "chosen.exr", {"--gl", "none", "-t", "deferred_tiled", "--set", "raster=opencl", "--lights", "0"});
  EXPECT_EQ(chosen.status, 0) << chosen.err;
}

TEST(WithoutOpenGl, CaptureAndInspectFindTheSameGrid) {
  const TempFolder folder;
  const std::vector<std::string> where = {"spheres", "--size", "64x36", "--gl", "none"};
  std::vector<std::string> capture = {"capture", "-t", "visibility", "-o", folder.path};
  capture.insert(capture.end(), where.begin(), where.end());
  ASSERT_EQ(run_program(capture).status, 0);
  std::vector<std::string> inspect = {"inspect", "-t", "visibility", "--pixel", "20,12", "--json", "-"};
  const ProgramRun frame =
      run_program({"inspect", folder.path, "-t", "visibility", "--pixel", "20,12", "--json", "-"});
  inspect.insert(inspect.end(), where.begin(), where.end());
  const ProgramRun scene = run_program(inspect);
  ASSERT_EQ(scene.status, 0) << scene.err;
  ASSERT_EQ(frame.status, 0) << frame.err;
  const auto of_scene = nlohmann::json::parse(scene.out), of_frame = nlohmann::json::parse(frame.out);
  EXPECT_GT(of_scene["listed"], 0);
  EXPECT_EQ(of_scene["lost"], 0);
  for (const char* key : {"cell", "listed", "lit", "lost"}) EXPECT_EQ(of_scene[key], of_frame[key]) << key;
}

}  // namespace
}  // namespace lightgrid::app
