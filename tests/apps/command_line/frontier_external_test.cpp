// Another renderer on the frontier, as its author adds it: docs/put_your_renderer_on_the_plane.md.
#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/exr_picture.h"
#include "support/paths.h"
#include "support/read_files.h"
#include "support/run_command.h"
#include "support/run_program.h"

namespace lightgrid::app {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

const std::string examples = std::string(source_folder) + "/docs/examples/another_renderer/";

bool has_python() { return run_words({"python3", "--version"}).status == 0; }

// A sweep of `spheres` in which the renderers of files take part.
struct Sweep {
  TempFolder folder;
  std::vector<std::string> sweep = {"--size", "48x27", "--lights", "24"};

  std::string write(const std::string& name, const json& file) const {
    std::ofstream(folder.path / name) << file.dump();
    return folder.path / name;
  }
  ProgramRun run(const std::vector<std::string>& files, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"frontier",         "spheres", "--rounds",     "2",
                                          "--no-growth",      "-t",      "forward_plus", "-o",
                                          folder.path / "out"};
    arguments.insert(arguments.end(), sweep.begin(), sweep.end());
    for (const std::string& file : files) arguments.insert(arguments.end(), {"--external", file});
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program(arguments);
  }
  void export_views(const char* count) const {
    std::vector<std::string> arguments = {
        "frontier", "export", "spheres", "--views", count, "-o", folder.path / "exported"};
    arguments.insert(arguments.end(), sweep.begin(), sweep.end());
    const ProgramRun run = run_program(arguments);
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_EQ(run.out, (folder.path / "exported/spheres/views.json").string() + "\n");
  }
  json answer() const { return json::parse(file_bytes(folder.path / "out/frontier.json")); }
  json point(const std::string& label) const {
    const json all = answer();
    for (const json& point : all["points"]) {
      if (point["label"] == label) return point;
    }
    ADD_FAILURE() << "no point " << label;
    return {};
  }
  void expect_recomputed() const {
    if (!has_python()) return;
    const ProgramRun run =
        run_words({"python3", std::string(source_folder) + "/tests/laboratory/frontier/recompute.py",
                   folder.path / "out"});
    EXPECT_EQ(run.status, 0) << run.out << run.err;
  }
};

// One written from the page alone shows whether the page suffices.
TEST(FrontierExternal, AnIndependentRendererDrawsTheSamePicture) {
  if (!has_python()) GTEST_SKIP() << "no Python here";
  const Sweep sweep;
  const ProgramRun run = sweep.run({examples + "renderer.json"}, {"--views", "1"});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("plain_python is another renderer"));
  const json point = sweep.point("plain_python"), own = sweep.point("forward_plus");
  EXPECT_TRUE(point["external"]["paired"].get<bool>());
  const json& error = point["error"]["authored"]["total"];
  // But for pixels at silhouettes, where OpenGL snaps corners to a grid.
  EXPECT_LT(error["p99_rel"].get<double>(), 2e-6);
  EXPECT_LT(error["displayed_flip"]["mean"].get<double>(), 0.005);
  EXPECT_GT(point["error"]["total"]["displayed_flip"]["mean"].get<double>(), 0.02) << "ranges hide no light";
  EXPECT_EQ(point["relative_time"]["runs"], own["relative_time"]["runs"]);
  EXPECT_GT(point["relative_time"]["estimate"].get<double>(), own["relative_time"]["estimate"].get<double>());
  for (const char* unknown : {"pairs", "memory_bytes", "bytes_moved", "listed_per_lit"})
    EXPECT_TRUE(point[unknown].is_null()) << unknown;
  for (const char* unknown : {"model", "precision", "technique"})
    EXPECT_TRUE(point["error"][unknown]["rmse_rel"].is_null()) << unknown;
  EXPECT_GT(point["error"]["temporal_rmse_rel"].get<double>(), 0);
  sweep.expect_recomputed();
}

TEST(FrontierOfOwnRender, HasTheErrorOfItsPoint) {
  if (!has_python()) GTEST_SKIP() << "no Python here";
  const Sweep sweep;
  const std::string file = sweep.write(
      "own.json",
      {{"name", "own_render"},
       {"command", {"python3", examples + "lightgrid_render.py", lightgrid_program, "forward_plus"}}});
  const ProgramRun run = sweep.run({file}, {"--views", "1"});
  ASSERT_EQ(run.status, 0) << run.err;
  const json point = sweep.point("own_render"), own = sweep.point("forward_plus");
  for (const char* measure : {"rmse_rel", "max_rel", "energy_rel", "rel_mse", "smape"}) {
    const double of_own = own["error"]["total"][measure].get<double>();
    EXPECT_NEAR(point["error"]["total"][measure].get<double>(), of_own, 1e-4 * std::abs(of_own)) << measure;
  }
  EXPECT_LT(point["error"]["authored"]["total"]["max_rel"].get<double>(), 1e-6);
  EXPECT_NEAR(point["error"]["temporal_rmse_rel"].get<double>(),
              own["error"]["temporal_rmse_rel"].get<double>(), 1e-6);
}

TEST(FrontierExternal, PicturesAndTimesOfFilesAreAPointOfTheirOwnRounds) {
  const Sweep sweep;
  sweep.export_views("2");
  json frames = json::array();
  for (const char* picture : {"exported/spheres/authored_0.exr", "exported/spheres/authored_1.exr"})
    frames.push_back({{"picture", picture}, {"frame_ms", {2, 2.2, 2, 1.8}}, {"baseline_ms", {8, 8, 8, 8}}});
  json file = {{"name", "elsewhere"},
               {"scenes", {{"spheres", {{"views", "exported/spheres/views.json"}, {"frames", frames}}}}}};
  const ProgramRun run = sweep.run({sweep.write("engine.json", file)}, {"--views", "2"});
  ASSERT_EQ(run.status, 0) << run.err;
  const json point = sweep.point("elsewhere");
  EXPECT_FALSE(point["external"]["paired"].get<bool>());
  EXPECT_EQ(point["error"]["authored"]["total"]["max_rel"], 0);
  EXPECT_EQ(point["relative_time"]["runs"], 4);
  EXPECT_NEAR(point["relative_time"]["estimate"].get<double>(), 0.25, 0.005);
  EXPECT_LT(point["relative_time"]["ci95"][0].get<double>(), 0.24);
  EXPECT_GT(point["relative_time"]["ci95"][1].get<double>(), 0.26);
  sweep.expect_recomputed();

  const auto fault = [&](const json& wrong, const char* views = "2") {
    const ProgramRun refused = sweep.run({sweep.write("wrong.json", wrong)}, {"--views", views});
    EXPECT_EQ(refused.status, 2) << refused.err;
    return refused.err;
  };
  EXPECT_THAT(fault(file, "3"), HasSubstr("scenes.spheres.frames: has 2, the sweep 3 views"));
  json wrong = file;
  wrong["scenes"]["spheres"]["frames"][1]["picture"] = "wrong.json";
  EXPECT_THAT(fault(wrong), HasSubstr("wrong.json: is not an EXR file"));
  save_exr(sweep.folder.path / "small.exr", Image(47, 27));
  wrong["scenes"]["spheres"]["frames"][1]["picture"] = "small.exr";
  EXPECT_THAT(fault(wrong), HasSubstr("small.exr: has another size"));
  wrong = {{"name", "elsewhere"}, {"scenes", {{"hall", file["scenes"]["spheres"]}}}};
  EXPECT_THAT(fault(wrong), HasSubstr("scenes: has none of this sweep"));
}

TEST(FrontierExternal, NanPixelsAreAFailure) {
  const Sweep sweep;
  sweep.export_views("1");
  Image image = load_exr_picture(sweep.folder.path / "exported/spheres/authored_0.exr", 48, 27);
  image.at(3, 4).g = std::numeric_limits<float>::quiet_NaN();
  save_exr(sweep.folder.path / "nan.exr", image);
  const json frame = {{"picture", "nan.exr"}, {"frame_ms", {2}}, {"baseline_ms", {8}}};
  const ProgramRun run = sweep.run(
      {sweep.write(
          "engine.json",
          {{"name", "elsewhere"},
           {"scenes", {{"spheres", {{"views", "exported/spheres/views.json"}, {"frames", {frame}}}}}}})},
      {"--views", "1"});
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.err, HasSubstr("elsewhere in spheres: 1 NaN pixels"));
  EXPECT_FALSE(sweep.point("elsewhere")["fronts"]["total"]["on"].get<bool>());
  EXPECT_EQ(sweep.answer()["failures"][0]["cause"], "NaN");
}

// Each is refused with a reason; the sweep goes on without it.
TEST(FrontierExternal, FaultyCommandsAreRefusedPoints) {
  const Sweep sweep;
  const std::pair<const char*, const char*> faults[] = {
      {"exit 3", "ended with status 3"},
      {"read line; echo '{\"error\": \"no such light\"}'", "no such light"},
      {"read line; echo '{'", "is not JSON"},
      {"read line; echo '{\"ms\": 1}'", "frame_ms is missing"},
      {"read line; echo '{\"frame_ms\": 0.001, \"devise_ms\": 1}'", "did you mean device_ms?"},
      {"read line; echo '{\"frame_ms\": -1}'", "frame_ms: -1 is not above 0"},
      {"read line; echo '{\"frame_ms\": 1e9}'", "is more than the"},
      {"read line; echo '{\"frame_ms\": 0.001, \"cpu_ms\": 0}'", "cpu_ms: 0 is not above 0"},
      {"read line; echo '{\"frame_ms\": 0.001}'", ".exr"},  // it wrote no picture
      {"sleep 100", "no answer within 1 s"}};
  std::vector<std::string> files;
  for (const auto& [script, why] : faults) {
    const std::string name = "fault_" + std::to_string(files.size());
    files.push_back(
        sweep.write(name + ".json", {{"name", name}, {"command", {"sh", "-c", script}}, {"timeout_s", 1}}));
  }
  const ProgramRun run = sweep.run(files, {"--views", "1"});
  ASSERT_EQ(run.status, 0) << run.err;
  const json answer = sweep.answer();
  ASSERT_EQ(answer["points"].size(), 1u);
  ASSERT_EQ(answer["failures"].size(), std::size(faults));
  for (size_t i = 0; i < std::size(faults); ++i) {
    EXPECT_EQ(answer["failures"][i]["cause"], "refused");
    EXPECT_THAT(answer["failures"][i]["why"].get<std::string>(), HasSubstr(faults[i].second));
  }
}

// The hall has textures, spots and ambient light of its own.
TEST(FrontierExternal, AnExportedSceneHasTheSamePictures) {
  const TempFolder folder;
  const ProgramRun exported =
      run_program({"frontier", "export", "hall", "--views", "2", "--size", "64x36", "-o", folder.path});
  ASSERT_EQ(exported.status, 0) << exported.err;
  const fs::path hall = folder.path / "hall";
  for (const int view : {0, 1}) {
    const fs::path drawn = folder.path / "drawn.exr";
    const ProgramRun run =
        run_program({"render", hall / "scene.glb", "--camera", "view " + std::to_string(view), "--size",
                     "64x36", "-t", "forward", "--set", "range=infinite", "-o", drawn});
    ASSERT_EQ(run.status, 0) << run.err;
    const Image a = load_exr_picture(drawn, 64, 36);
    const Image b = load_exr_picture(hall / ("truth_" + std::to_string(view) + ".exr"), 64, 36);
    float brightest = 0, largest = 0;
    for (size_t i = 0; i < a.pixels.size(); ++i) {
      for (int c = 0; c < 3; ++c) {
        brightest = std::max(brightest, b.pixels[i][c]);
        largest = std::max(largest, std::abs(a.pixels[i][c] - b.pixels[i][c]));
      }
    }
    EXPECT_GT(brightest, 0.1f);
    EXPECT_LT(largest, 1e-6f * brightest) << view;
  }
}

}  // namespace
}  // namespace lightgrid::app
