// lightgrid golden: what is recorded is checked, and a planted fault is found in the stage that it is in.
#include <gmock/gmock.h>

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "support/gltf_builder.h"
#include "support/png_pixels.h"
#include "support/read_files.h"
#include "support/run_program.h"

namespace lightgrid::app {
namespace {

using nlohmann::json;
using testing::HasSubstr;

const std::vector<std::string> quick = {"LIGHTGRID_CL_QUICK_BUILD=all"};

struct Golden : testing::Test {
  static void SetUpTestSuite() {
    folder = new TempFolder;
    std::ofstream(folder->path / "lights.json") << lights(40).dump();
    const ProgramRun run =
        run_program({"golden", "record", folder->path, "spheres", "--pictures", "--size", "150x90",
                     "--camera", "eye:0,3,9,target:0,1,0", "--lights-file", folder->path / "lights.json"},
                    quick);
    ASSERT_EQ(run.status, 0) << run.err;
  }
  static void TearDownTestSuite() { delete folder; }

  static json lights(int count) {
    json list = json::array();
    for (int i = 0; i < count; ++i)
      list.push_back({{"type", "point"},
                      {"position", {i % 8 - 4, 1.5, i / 8 - 2}},
                      {"color", {1, 1, 1}},
                      {"intensity", 2},
                      {"radius", 25}});
    return {{"lights", list}};
  }

  static json recorded() { return json::parse(file_bytes(folder->path / "golden.json")); }

  static ProgramRun check(const json& golden, std::vector<std::string> more = {},
                          std::vector<std::string> environment = quick) {
    const TempFolder changed;
    std::ofstream(changed.path / "golden.json") << golden.dump();
    more.insert(more.begin(), {"golden", "check", changed.path});
    return run_program(more, environment);
  }

  // Checks the recorded view as each of these describes it, in one process; lines by the texts of what
  // changed.
  static void find(const std::map<std::string, json>& scenes,
                   const std::map<std::string, std::string>& stages) {
    json golden = recorded();
    golden["scenes"] = json::array();
    for (const auto& [fault, scene] : scenes) golden["scenes"].push_back(scene);
    const ProgramRun run = check(golden);
    EXPECT_EQ(run.status, 1) << run.err;
    std::istringstream lines(run.out);
    for (const auto& [fault, scene] : scenes) {
      std::string line;
      std::getline(lines, line);
      EXPECT_THAT(line, HasSubstr("differs first in " + stages.at(fault) + ":")) << fault;
    }
  }

  static inline TempFolder* folder = nullptr;
};

TEST_F(Golden, WhatIsRecordedIsDrawnAgain) {
  const json golden = recorded();
  EXPECT_LT(golden.dump().size(), 4096u);
  for (int i = 0; i < 3; ++i) {
    const ProgramRun run = check(golden);
    EXPECT_EQ(run.status, 0) << run.out << run.err;
    EXPECT_THAT(run.out, HasSubstr(": same\n"));
  }
}

TEST_F(Golden, FormsOfKernelsDrawTheSame) {
  for (const auto& [form, cpu] : {std::pair{"avx2", "pthread-haswell"}, {"sse2", "pthread-athlon64"}}) {
    const TempFolder cache;
    std::vector<std::string> environment = quick;
    environment.insert(environment.end(), {std::string("POCL_KERNELLIB_NAME=") + form, "LIGHTGRID_TUNED=off",
                                           "XDG_CACHE_HOME=" + cache.path.string()});
    if (run_program({"devices"}, environment).out.find(cpu) == std::string::npos)
      GTEST_SKIP() << "no PoCL here that compiles for " << cpu;
    EXPECT_EQ(check(recorded(), {}, environment).status, 0) << form;
  }
}

TEST_F(Golden, AnEditedHashIsFoundInItsStageAndTile) {
  for (const char* stage : {"triangles", "depth", "lists", "radiance"}) {
    json golden = recorded();
    std::string row = golden["scenes"][0]["views"][0][stage][1];
    row[17] = row[17] == '0' ? '1' : '0';
    golden["scenes"][0]["views"][0][stage][1] = row;
    const ProgramRun run = check(golden);
    EXPECT_EQ(run.status, 1);
    EXPECT_THAT(run.out, HasSubstr(std::string("differs first in ") + stage +
                                   ": 1 of 6 tiles, the first at pixels 64,0 to 127,25"));
  }
}

TEST_F(Golden, PlantedFaultsNameTheirStage) {
  std::map<std::string, json> scenes;
  std::map<std::string, std::string> stages;
  const auto plant = [&](const std::string& fault, const std::string& stage) -> json& {
    stages[fault] = stage;
    return scenes[fault] = recorded()["scenes"][0];
  };
  const auto plant_lights = [&](const std::string& fault, const std::string& stage, auto&& change) {
    json changed = lights(40);
    change(changed["lights"]);
    const std::filesystem::path path = folder->path / (fault + ".json");
    std::ofstream(path) << changed.dump();
    plant(fault, stage)["options"]["lights-file"] = path;
  };
  plant("no window", "radiance")["set"] = {"window=none"};
  plant("smaller tiles", "lists")["set"] = {"tile=8"};
  plant("a bias", "radiance")["options"]["ambient"] = "0.125";
  plant("a light lost", "lists")["options"]["lights"] = "39";
  plant("a shifted camera", "triangles")["options"]["camera"] = "eye:0.02,3,9,target:0,1,0";
  plant("a near plane", "depth")["options"]["camera"] = "eye:0,3,9,target:0,1,0,near:0.02";
  plant_lights("a colour", "radiance", [](json& l) { l[20]["color"] = {1, 1, 0.999}; });
  plant_lights("a range", "lists", [](json& l) { l[20]["radius"] = 29; });
  plant_lights("a shifted light", "radiance", [](json& l) { l[20]["position"][1] = 1.501; });
  plant_lights("two lights exchanged", "lists", [](json& l) { std::swap(l[0], l[39]); });
  find(scenes, stages);
}

// A square before a camera without perspective, with two triangles, texels and a light.
struct GoldenModel : Golden {
  static GltfBuilder model(const std::vector<float>& positions = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0},
                           uint8_t texel = 90) {
    GltfBuilder made = GltfBuilder::triangle();
    made.root["nodes"] = {
        {{"mesh", 0}}, {{"camera", 0}, {"translation", {0, 0, 5}}}, {{"translation", {0, 0, 1}}}};
    made.root["scenes"] = {{{"nodes", {0, 1, 2}}}};
    made.root["nodes"][2]["extensions"]["KHR_lights_punctual"]["light"] = 0;
    made.root["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "point"}, {"intensity", 3}, {"range", 4}}};
    made.root["extensionsUsed"] = {"KHR_lights_punctual"};
    made.root["cameras"] = {
        {{"type", "orthographic"}, {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"znear", 1}, {"zfar", 9}}}}};
    made.attribute("POSITION", positions, "VEC3", f32, 4);
    made.attribute("NORMAL", std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", f32, 4);
    made.attribute("TEXCOORD_0", std::vector<float>{0, 1, 1, 1, 1, 0, 0, 0}, "VEC2", f32, 4);
    made.indices(std::vector<uint16_t>{0, 1, 2, 0, 2, 3}, u16);
    const Bytes texels = {200, 60, 30, 40, 180, 60, 30, texel, 220, 250, 250, 240};
    made.root["images"] = {{{"uri", "data:image/png;base64," + base64(encode_png(2, 2, 3, texels))}}};
    made.root["samplers"] = {{{"magFilter", 9728}, {"minFilter", 9728}}};
    made.root["textures"] = {{{"source", 0}, {"sampler", 0}}};
    made.root["materials"] = {
        {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}, {"roughnessFactor", 0.5}}}}};
    made.primitive()["material"] = 0;
    return made;
  }
};

TEST_F(GoldenModel, PlantedFaultsNameTheirStage) {
  const ModelFolder models;
  const std::filesystem::path right = models.write("right.gltf", model().text());
  const ProgramRun run = run_program({"golden", "record", models.path, right, "--size", "70x66"}, quick);
  ASSERT_EQ(run.status, 0) << run.err;
  const json scene = json::parse(file_bytes(models.path / "golden.json"))["scenes"][0];
  std::map<std::string, json> scenes;
  std::map<std::string, std::string> stages;
  const auto plant = [&](const std::string& fault, const std::string& stage, const GltfBuilder& faulty) {
    stages[fault] = stage;
    (scenes[fault] = scene)["scene"] = models.write(fault + ".gltf", faulty.text());
  };
  plant("a shifted vertex", "triangles", model({-1, -1, 0, 1, -1, 0, 0.97, 1, 0, -1, 1, 0}));
  plant("a shift in depth", "depth", model({-1, -1, 1e-4, 1, -1, 1e-4, 1, 1, 1e-4, -1, 1, 1e-4}));
  plant("a texel", "radiance", model({-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0}, 91));
  GltfBuilder faulty = model();
  faulty.root["samplers"][0] = {{"magFilter", 9729}, {"minFilter", 9729}};
  plant("another filter", "radiance", faulty);
  faulty = model();
  faulty.root["materials"][0]["pbrMetallicRoughness"]["roughnessFactor"] = 0.501;
  plant("a roughness", "radiance", faulty);
  find(scenes, stages);
}

// A light's colour changes some pixels: what is said of them.
TEST_F(Golden, PicturesTellThePixelAndFlip) {
  const TempFolder changed;
  json other = lights(40);
  other["lights"][20]["color"] = {1, 0.2, 0.2};
  std::ofstream(changed.path / "lights.json") << other.dump();
  json golden = recorded();
  golden["scenes"][0]["options"]["lights-file"] = changed.path / "lights.json";
  std::ofstream(changed.path / "golden.json") << golden.dump();
  std::filesystem::copy(folder->path / "00_0000.exr", changed.path);
  const std::filesystem::path out = changed.path / "out";
  const ProgramRun run = run_program({"golden", "check", changed.path, "-o", out, "--json", "-"}, quick);
  EXPECT_EQ(run.status, 1) << run.err;
  const json view = json::parse(run.out)["views"][0];
  EXPECT_EQ(view["stage"], "radiance");
  EXPECT_THAT(view["message"].get<std::string>(), HasSubstr("; the first pixel "));
  const std::string stem = out / "00_0000";
  const PngPixels expected = read_png(stem + ".expected.png"), drawn = read_png(stem + ".drawn.png"),
                  mask = read_png(stem + ".radiance.png"), flip = read_png(stem + ".flip.png"),
                  difference = read_png(stem + ".difference.png");
  const int x = view["pixel_from_top"][0], y = view["pixel_from_top"][1], tile = 64;
  EXPECT_EQ(x / tile, view["tile"][0]);
  const auto row = [&](int from_top) { return (expected.height - 1 - from_top) / tile; };
  EXPECT_EQ(row(y), view["tile"][1]);
  const auto colour = [](const PngPixels& png, int at_x, int at_y) {
    return std::array{png.at(at_x, at_y, 0), png.at(at_x, at_y, 1), png.at(at_x, at_y, 2)};
  };
  const std::array<uint8_t, 3> black{};
  size_t white = 0, before = 0, displayed = 0;
  for (int py = 0; py < mask.height; ++py) {
    for (int px = 0; px < mask.width; ++px) {
      const bool differs = colour(mask, px, py)[0] == 255;
      white += differs;
      before += differs && px / tile == x / tile && row(py) == row(y) && (py < y || (py == y && px < x));
      EXPECT_EQ(differs, colour(difference, px, py) != black) << px << "," << py;
      const bool shown = colour(expected, px, py) != colour(drawn, px, py);
      displayed += shown;
      EXPECT_TRUE(differs || !shown);
    }
  }
  EXPECT_EQ(colour(mask, x, y)[0], 255);
  EXPECT_EQ(before, 0u);
  EXPECT_GT(displayed, 0u);
  EXPECT_LT(white, size_t(mask.width) * size_t(mask.height));
  EXPECT_GT(view["displayed_flip"]["mean"], 0.001);
  EXPECT_EQ(flip.width, 150);
  // The drawn pixels are those that the next recording would store.
  const ProgramRun again =
      run_program({"golden", "record", changed.path, "spheres", "--pictures", "--size", "150x90", "--camera",
                   "eye:0,3,9,target:0,1,0", "--lights-file", changed.path / "lights.json"},
                  quick);
  EXPECT_EQ(again.status, 0);
  EXPECT_TRUE(file_bytes(changed.path / "00_0000.exr") == file_bytes(stem + ".drawn.exr"));
}

TEST_F(Golden, BrokenAndForeignPicturesAreLeftOut) {
  const std::string right = file_bytes(folder->path / "00_0000.exr");
  json golden = recorded();
  golden["scenes"][0]["set"] = {"window=none"};
  std::string other = file_bytes(folder->path / "00_0000.exr");
  other[other.size() / 2] = char(other[other.size() / 2] ^ 1);
  for (const std::string& broken : {right.substr(0, right.size() / 2), other}) {
    const TempFolder changed;
    std::ofstream(changed.path / "golden.json") << golden.dump();
    std::ofstream(changed.path / "00_0000.exr", std::ios::binary) << broken;
    const ProgramRun run = run_program({"golden", "check", changed.path}, quick);
    EXPECT_EQ(run.status, 1);
    EXPECT_THAT(run.out, HasSubstr("differs first in radiance: "));
    EXPECT_THAT(run.out, testing::Not(HasSubstr("pixel ")));
    EXPECT_THAT(run.err, HasSubstr("going on without"));
  }
}

TEST_F(Golden, ResultsAreFiles) {
  json golden = recorded();
  golden["scenes"][0]["set"] = {"window=none"};
  const TempFolder out;
  const ProgramRun run = check(golden, {"--json", out.path / "a.json", "--junit", out.path / "a.xml",
                                        "--sarif", out.path / "a.sarif", "-o", out.path / "pictures"});
  EXPECT_EQ(run.status, 1);
  EXPECT_EQ(json::parse(file_bytes(out.path / "a.json"))["views"][0]["stage"], "radiance");
  EXPECT_THAT(file_bytes(out.path / "a.xml"), HasSubstr("tests=\"1\" failures=\"1\""));
  EXPECT_EQ(json::parse(file_bytes(out.path / "a.sarif"))["runs"][0]["results"][0]["ruleId"], "radiance");
  for (const char* name : {"00_0000.drawn.exr", "00_0000.drawn.png", "00_0000.radiance.png"})
    EXPECT_TRUE(std::filesystem::exists(out.path / "pictures" / name)) << name;
}

TEST_F(Golden, SarifNamesItsFileByAUri) {
  json golden = recorded();
  golden["scenes"][0]["set"] = {"window=none"};
  const TempFolder parent;
  const std::filesystem::path path = parent.path / "a b\xff";
  std::filesystem::create_directory(path);
  std::ofstream(path / "golden.json") << golden.dump();
  const json sarif = json::parse(run_program({"golden", "check", path, "--sarif", "-"}, quick).out);
  const json& location = sarif["runs"][0]["results"][0]["locations"][0]["physicalLocation"];
  EXPECT_THAT(location["artifactLocation"]["uri"].get<std::string>(),
              testing::EndsWith("/a%20b%FF/golden.json"));
}

TEST_F(Golden, BrokenFilesAreErrorsOfTheirField) {
  const auto fails = [](const json& golden, const std::string& message) {
    const ProgramRun run = check(golden);
    EXPECT_EQ(run.status, 2) << run.out;
    EXPECT_THAT(run.err, HasSubstr(message));
  };
  json golden = recorded();
  golden["lightgrid_golden"] = 1;
  fails(golden, "golden.json: lightgrid_golden");
  golden = recorded();
  golden["scenes"] = json::array();
  fails(golden, "golden.json: scenes");
  golden = recorded();
  golden["scenes"][0]["options"]["sise"] = "1x1";
  fails(golden, "sise");
  golden = recorded();
  golden["scene"] = golden["scenes"];
  fails(golden, "golden.json: scene: unknown field; did you mean scenes?");
  golden = recorded();
  golden["scenes"][0]["sets"] = json::array({"tile=8"});
  fails(golden, "golden.json: scenes[0].sets: unknown field; did you mean set?");
  golden = recorded();
  golden["scenes"][0]["views"][0]["tiles"] = 8;
  fails(golden, "golden.json: scenes[0].views[0].tiles: unknown field; did you mean tile?");
  golden = recorded();
  golden["scenes"][0]["views"][0].erase("depth");
  fails(golden, "depth");
  golden = recorded();
  golden["scenes"][0]["views"][0]["lists"][0] = "12";
  fails(golden, "lists: \"12\" is not 16 hexadecimal digits");
  golden = recorded();
  golden["scenes"][0]["views"][0]["width"] = 149;
  fails(golden, "width 149");
  golden = recorded();
  golden["scenes"][0]["views"].push_back(golden["scenes"][0]["views"][0]);
  fails(golden, "scenes[0].views: 2 are recorded, and 1 were drawn");
  const TempFolder none;
  EXPECT_EQ(run_program({"golden", "check", none.path}).status, 2);
  EXPECT_EQ(run_program({"golden", "look", none.path}).status, 2);
  EXPECT_EQ(run_program({"golden", "record", none.path}).status, 2);
  EXPECT_EQ(run_program({"golden", "check", folder->path, "--pictures"}).status, 2);
}

TEST_F(Golden, OptionsOfTheOtherActionAreRefused) {
  const auto refuses = [](const std::vector<std::string>& arguments, const std::string& message) {
    const ProgramRun run = run_program(arguments);
    EXPECT_EQ(run.status, 2) << run.out;
    EXPECT_THAT(run.err, HasSubstr(message));
  };
  const std::filesystem::path path = folder->path;
  refuses({"golden", "check", path, "--size", "64x36"}, "golden check: --size: is an option of record");
  refuses({"golden", "check", path, "--set", "tile=8"}, "golden check: --set: is");
  refuses({"golden", "check", path, "-t", "forward_plus"}, "golden check: --technique: is");
  refuses({"golden", "check", path, "--json", "-", "--sarif", "-"},
          "--sarif -: --json goes to stdout already");
  refuses({"golden", "check", path / "golden.json"},
          "golden.json: is a file; DIR is the folder of golden.json");
  const TempFolder none;
  refuses({"golden", "record", none.path, "spheres", "-o", path},
          "golden record: --output: is an option of check");
  EXPECT_FALSE(std::filesystem::exists(none.path / "golden.json"));
}

TEST_F(Golden, AnErrorIsInTheJUnitFile) {
  json golden = recorded();
  golden["scenes"].push_back(golden["scenes"][0]);
  golden["scenes"][1]["scene"] = "gone.gltf";
  const TempFolder out;
  EXPECT_EQ(check(golden, {"--junit", out.path / "a.xml"}).status, 2);
  const std::string text = file_bytes(out.path / "a.xml");
  EXPECT_THAT(text, HasSubstr("tests=\"2\" failures=\"0\" errors=\"1\""));
  EXPECT_THAT(text, HasSubstr("name=\"gone.gltf\"><error message=\"gone.gltf: no such file"));
}

TEST_F(Golden, AFileOnStdoutIsAlone) {
  EXPECT_TRUE(check(recorded(), {"--junit", "-"}).out.starts_with("<?xml"));
  EXPECT_TRUE(json::accept(check(recorded(), {"--sarif", "-"}).out));
}

// Recorded once with PoCL 3.1; the bytes are promised for every processor. After a change that means to draw
// something else, record them again: docs/golden.md#our-own.
TEST(GoldenHashes, OfTheBuiltinScenesHold) {
  const std::map<std::string, std::string> folders = {
      {"assets/golden_hashes/visibility", "hall visibility 0"},
      {"assets/golden_hashes/forward_plus_compute", "hall forward_plus_compute"},
      {"packaging/pocl", "hall visibility:kernel-shape=group 0"}};
  for (const auto& [folder, line] : folders) {
    const ProgramRun run =
        run_program({"golden", "check", std::filesystem::path(source_folder) / folder}, quick);
    EXPECT_EQ(run.status, 0) << run.out << run.err;
    EXPECT_THAT(run.out, HasSubstr(line));
    EXPECT_EQ(run.err, "");
  }
}

}  // namespace
}  // namespace lightgrid::app
