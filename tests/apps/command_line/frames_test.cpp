// `capture`, `cull` and `inspect` as a user runs them.
#include <gmock/gmock.h>

#include <algorithm>
#include <cstring>
#include <fstream>

#include <nlohmann/json.hpp>

#include "base/image.h"
#include "measures/metrics.h"
#include "support/read_files.h"
#include "support/run_program.h"

namespace lightgrid::app {
using namespace lab;
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsSupersetOf;
using testing::StartsWith;

std::vector<std::string> names_in(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) names.push_back(std::filesystem::relative(entry.path(), folder));
  }
  std::sort(names.begin(), names.end());
  return names;
}

class Frames : public testing::Test {
 protected:
  // A frame of 93 x 61 pixels, captured once for each test.
  std::filesystem::path capture() {
    const auto frame = folder_.path / "frame";
    const ProgramRun run = run_program({"capture", "street", "--size", "93x61", "-o", frame});
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_EQ(run.err, "");
    EXPECT_THAT(run.out, StartsWith(frame.string() + ": 93x61, 791 lights, 6x4 cells of 16 pixels, "));
    return frame;
  }

  // The shared libraries that the program loads, as reported by the dynamic linker.
  std::string libraries_of(std::vector<std::string> arguments) {
    const auto log = folder_.path / "loaded";
    std::filesystem::create_directory(log);
    const ProgramRun run =
        run_program(std::move(arguments), {"LD_DEBUG=files", "LD_DEBUG_OUTPUT=" + (log / "of").string()});
    EXPECT_EQ(run.status, 0) << run.err;
    std::string libraries;
    for (const std::string& name : names_in(log)) {
      std::ifstream lines(log / name);
      for (std::string line; std::getline(lines, line);) {
        const size_t at = line.find("calling init: ");
        if (at != std::string::npos) libraries += line.substr(at + 14) + "\n";
      }
    }
    std::filesystem::remove_all(log);
    return libraries;
  }

  TempFolder folder_;
};

bool holds_opengl(const std::string& libraries) {
  for (const char* name : {"libGL", "libEGL", "libOSMesa", "libOpenGL", "libgallium", "swrast_dri"}) {
    if (libraries.find(name) != std::string::npos) return true;
  }
  return false;
}

TEST_F(Frames, CaptureWritesAFrameAndCullMakesItsGridAgain) {
  const auto frame = capture(), culled = folder_.path / "deep" / "culled";
  EXPECT_THAT(names_in(frame),
              ElementsAre("depth.f32", "grid.json", "grid.u32", "indices.u32", "lights.json", "view.json"));
  EXPECT_EQ(std::filesystem::file_size(frame / "depth.f32"), 93u * 61 * 4);
  const ProgramRun run = run_program({"cull", frame, "-o", culled});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.err, "");
  EXPECT_EQ(std::count(run.out.begin(), run.out.end(), '\n'), 1);
  EXPECT_THAT(names_in(culled), ElementsAre("grid.json", "grid.u32", "indices.u32"));
  for (const char* name : {"grid.json", "grid.u32", "indices.u32"}) {
    EXPECT_TRUE(file_bytes(culled / name) == file_bytes(frame / name)) << name;
  }
  EXPECT_GT(std::filesystem::file_size(culled / "indices.u32"), 0u);
}

TEST_F(Frames, CaptureAlongAPathGivesAFolderAFrame) {
  const auto path = folder_.path / "path", still = folder_.path / "still";
  const ProgramRun moving = run_program(
      {"capture", "spheres", "--size", "64x48", "--camera-path", "turn:3", "-o", path, "--json", "-"});
  ASSERT_EQ(moving.status, 0) << moving.err;
  ASSERT_EQ(run_program({"capture", "spheres", "--size", "64x48", "-o", still}).status, 0);
  for (const char* frame : {"0000", "0001", "0002"})
    EXPECT_TRUE(std::filesystem::is_directory(path / frame)) << frame;
  EXPECT_FALSE(std::filesystem::exists(path / "0003"));
  EXPECT_EQ(nlohmann::json::parse(moving.out).size(), 3u);
  EXPECT_TRUE(file_bytes(path / "0000" / "depth.f32") == file_bytes(still / "depth.f32"))
      << "a path starts at the camera";
  EXPECT_FALSE(file_bytes(path / "0001" / "depth.f32") == file_bytes(still / "depth.f32"));
  EXPECT_EQ(run_program({"bench", "--replay", path / "0001", "--frames", "1", "--warmup", "0"}).status, 0);
}

TEST_F(Frames, OfClusteredHaveItsSlicesAndItsMasks) {
  const auto frame = folder_.path / "sliced", culled = folder_.path / "culled";
  const std::vector<std::string> options = {"-t",    "clustered", "--set", "slices=8",
                                            "--set", "z-bins=16", "--set", "grid-lists=masks"};
  const auto run = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), options.begin(), options.end());
    const ProgramRun program = run_program(arguments);
    EXPECT_EQ(program.status, 0) << program.err;
    return program.out;
  };
  EXPECT_THAT(run({"capture", "street", "--size", "93x61", "-o", frame}), HasSubstr("6x4x8 cells"));
  run({"cull", frame, "-o", culled});
  EXPECT_THAT(names_in(culled),
              ElementsAre("grid.json", "grid.u32", "indices.u32", "masks.u32", "z_bins.u32"));
  for (const std::string& name : names_in(culled))
    EXPECT_TRUE(file_bytes(culled / name) == file_bytes(frame / name)) << name;
  const auto grid = nlohmann::json::parse(file_bytes(culled / "grid.json"));
  EXPECT_EQ(grid["cells"], nlohmann::json({6, 4, 8}));
  EXPECT_EQ(grid["slice_edges"].size(), 7u);
  EXPECT_EQ(grid["z_bin_edges"].size(), 15u);
  EXPECT_EQ(grid["settings"]["slices"], 8);
  EXPECT_THAT(run({"inspect", frame, "-o", folder_.path / "maps"}),
              HasSubstr("0 (pixel, light) pairs lost, 0 wrong"));
}

TEST_F(Frames, HaveSlicesWhereTheSettingSaysSoAndNoneFromATechniqueWithoutAGrid) {
  const auto frame = capture();
  const ProgramRun run = run_program({"cull", frame, "-o", folder_.path / "culled", "--set", "slices=4"});
  EXPECT_THAT(run.out, HasSubstr("6x4x4 cells")) << run.err;
  const ProgramRun none = run_program({"cull", frame, "-t", "forward", "-o", folder_.path / "none"});
  EXPECT_EQ(none.status, 2);
  EXPECT_THAT(none.err, HasSubstr("forward"));
}

// Tuned values override the default but not --set, and change no byte.
TEST_F(Frames, AreCulledAsTuned) {
  const auto frame = capture(), culled = folder_.path / "culled", file = folder_.path / "tuned.json";
  const ProgramRun devices = run_program({"devices", "--json", "-"});
  const auto listed = nlohmann::json::parse(devices.out);
  nlohmann::json tuned;
  for (const auto& d : listed["cl"]) {
    const auto text = [&](const char* key) { return d[key].get<std::string>(); };
    tuned[text("platform") + " | " + text("name") + " | " + text("version") + " | " + text("driver")] = {
        {"kernel-shape", "group"}, {"portable", "on"}};
  }
  std::ofstream(file) << tuned.dump();
  const std::vector<std::string> environment = {"LIGHTGRID_TUNED=" + file.string()};
  EXPECT_THAT(run_program({"devices"}, environment).out, HasSubstr("tuned: kernel-shape=group"));
  const auto settings_of = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments = {"cull", frame, "-o", culled, "--frames", "1", "--json", "-"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramRun run = run_program(arguments, environment);
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_TRUE(file_bytes(culled / "indices.u32") == file_bytes(frame / "indices.u32"));
    return nlohmann::json::parse(run.out)["settings"];
  };
  EXPECT_EQ(settings_of({})["kernel_shape"], "group");
  EXPECT_EQ(settings_of({})["portable"], "on");
  EXPECT_EQ(settings_of({"--set", "kernel-shape=lanes"})["kernel_shape"], "lanes");
  EXPECT_EQ(settings_of({"--set", "kernel-shape=auto"})["kernel_shape"], "auto");
}

TEST_F(Frames, CullSaysAsJsonWhatItMade) {
  const auto frame = capture(), culled = folder_.path / "culled";
  const ProgramRun run =
      run_program({"cull", frame, "-o", culled, "--set", "tile=32", "--frames", "2", "--json", "-"});
  ASSERT_EQ(run.status, 0) << run.err;
  const auto json = nlohmann::json::parse(run.out);
  EXPECT_EQ(json["frame"], "frame");
  EXPECT_EQ(json["size"], nlohmann::json({93, 61}));
  EXPECT_EQ(json["settings"]["tile"], 32);
  EXPECT_EQ(json["lights"], nlohmann::json({{"total", 791}, {"listable", 790}}));
  EXPECT_EQ(json["grid"]["cells"], nlohmann::json({3, 2, 1}));
  EXPECT_EQ(json["grid"]["indices"], std::filesystem::file_size(culled / "indices.u32") / 4);
  EXPECT_EQ(json["cull_ms"]["runs"], 2);
}

TEST_F(Frames, CullOpensNoOpenGl) {
  const auto frame = capture();
  const std::string libraries = libraries_of({"cull", frame, "-o", folder_.path / "culled"});
  EXPECT_THAT(libraries, HasSubstr("libOpenCL"));
  EXPECT_FALSE(holds_opengl(libraries)) << libraries;
  // The check would detect it:
  EXPECT_TRUE(holds_opengl(libraries_of({"capture", "spheres", "--size", "8x8", "-o", folder_.path / "f"})));
}

TEST_F(Frames, InspectOfAFrameOpensNoOpenGl) {
  const auto frame = capture();
  EXPECT_FALSE(holds_opengl(libraries_of({"inspect", frame, "--pixel", "1,2"})));
}

TEST_F(Frames, CullEndsWithTwoAndWritesNothingWhereTheFrameIsWrong) {
  const auto frame = capture(), culled = folder_.path / "culled";
  std::ofstream(frame / "depth.f32") << "short";
  const ProgramRun run = run_program({"cull", frame, "-o", culled});
  EXPECT_EQ(run.status, 2);
  EXPECT_THAT(run.err, HasSubstr((frame / "depth.f32").string() + ": 5 bytes"));
  EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1);
  EXPECT_FALSE(std::filesystem::exists(culled));
}

// The lists of one cell are emptied.
TEST_F(Frames, JudgeTellsWhatTheListsOfAFrameLack) {
  const auto frame = capture(), judged = folder_.path / "judged";
  const std::vector<std::string> words = {"cull", frame, "--judge", "-o", judged};
  const ProgramRun right = run_program(words, {"OCL_ICD_VENDORS=/nonexistent"});
  EXPECT_EQ(right.status, 0) << right.err;
  EXPECT_THAT(right.out, HasSubstr(" 0 (pixel, light) pairs lost, 0 wrong; 0 of "));
  EXPECT_THAT(names_in(judged), ElementsAre("false_positives.png", "listed.png", "lost.png"));

  std::string cells = file_bytes(frame / "grid.u32");
  cells.replace(8 * 2 + 4, 4, 4, '\0');  // cell 2,0
  std::ofstream(frame / "grid.u32", std::ios::binary) << cells;
  std::vector<std::string> more = words;
  more.insert(more.end(), {"--json", "-", "--junit", folder_.path / "j.xml"});
  const ProgramRun wrong = run_program(more);
  EXPECT_EQ(wrong.status, 1) << wrong.err;
  const auto json = nlohmann::json::parse(wrong.out);
  EXPECT_GT(json["pairs"]["lost"], 0);
  ASSERT_GT(json["lost_lights"].size(), 0u);
  for (const auto& light : json["lost_lights"]) {
    const auto at = light["first_pixel_from_top"];
    EXPECT_EQ(at[0].get<int>() / 16, 2);
    EXPECT_EQ((60 - at[1].get<int>()) / 16, 0);
    EXPECT_THAT(file_bytes(folder_.path / "j.xml"), HasSubstr(" pixels, the first "));
  }
  std::filesystem::remove(frame / "grid.json");
  const ProgramRun none = run_program(words);
  EXPECT_EQ(none.status, 2);
  EXPECT_THAT(none.err, HasSubstr("grid.json: there is none"));
}

TEST_F(Frames, CullEndsWithThreeWhereNoDeviceHasTheName) {
  const ProgramRun run =
      run_program({"cull", capture(), "-o", folder_.path / "culled", "--device", "nosuchdevice"});
  EXPECT_EQ(run.status, 3);
  EXPECT_THAT(run.err, HasSubstr("\"nosuchdevice\""));
}

TEST_F(Frames, InspectTellsOfEachLightAtAPixel) {
  const auto frame = capture();
  const ProgramRun table = run_program({"inspect", frame, "--pixel", "40,50"});
  ASSERT_EQ(table.status, 0) << table.err;
  EXPECT_THAT(table.out, StartsWith("pixel 40,50: depth "));
  EXPECT_THAT(table.out, HasSubstr("kept"));
  EXPECT_THAT(table.out, HasSubstr("10 of "));

  const auto json_file = folder_.path / "i.json";
  const ProgramRun all =
      run_program({"inspect", frame, "--pixel", "40,50", "--all", "--json", json_file, "--quiet"});
  ASSERT_EQ(all.status, 0) << all.err;
  const auto json = nlohmann::json::parse(file_bytes(json_file));
  EXPECT_EQ(json["pixel_from_top"], nlohmann::json({40, 50}));
  EXPECT_EQ(json["lights"].size(), 790u);
  EXPECT_EQ(json["dropped_not_shown"], 0);
  EXPECT_EQ(json["directional"], 1);
  EXPECT_EQ(json["lost"], 0);
  int listed = 0, lit = 0;
  for (const auto& light : json["lights"]) {
    listed += light["listed"].get<bool>();
    lit += light["lit"].get<bool>();
    for (const char* key : {"light", "index", "name", "type", "distance", "radius", "test", "margin",
                            "margins", "touches_cell", "lit_pixels"}) {
      EXPECT_TRUE(light.contains(key)) << key;
    }
  }
  EXPECT_EQ(json["listed"], listed);
  EXPECT_EQ(json["lit"], lit);
  EXPECT_GT(lit, 0);

  // The list is the grid's.
  const std::string cells = file_bytes(frame / "grid.u32");
  uint32_t count = 0;
  std::memcpy(&count, cells.data() + 8 * 2 + 4, 4);  // cell 2,0
  EXPECT_EQ(count, uint32_t(listed));
}

TEST_F(Frames, InspectOfASceneTellsWhatInspectOfItsFrameTells) {
  const auto frame = capture();
  const ProgramRun of_frame = run_program({"inspect", frame, "--pixel", "40,50"});
  const ProgramRun of_scene = run_program({"inspect", "street", "--size", "93x61", "--pixel", "40,50"});
  ASSERT_EQ(of_scene.status, 0) << of_scene.err;
  EXPECT_EQ(of_scene.out, of_frame.out);
}

TEST_F(Frames, InspectDrawsMapsAndNoLightIsLost) {
  const auto maps = folder_.path / "maps";
  const ProgramRun run = run_program({"inspect", "spheres", "--size", "64x36", "-o", maps});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_THAT(names_in(maps), ElementsAre("false_positives.png", "listed.png", "lost.png"));
  EXPECT_THAT(run.out, HasSubstr("0 (pixel, light) pairs lost, 0 wrong"));
  const Image black = heat_map(64, 36, std::vector<uint32_t>(64 * 36, 0), 1);
  const auto bytes = encode_png(64, 36, 3, srgb_bytes_as_is(black));
  const std::string expected(bytes.begin(), bytes.end());
  EXPECT_TRUE(file_bytes(maps / "lost.png") == expected);
  EXPECT_FALSE(file_bytes(maps / "listed.png") == expected);
  EXPECT_FALSE(file_bytes(maps / "false_positives.png") == expected);
}

}  // namespace
}  // namespace lightgrid::app
