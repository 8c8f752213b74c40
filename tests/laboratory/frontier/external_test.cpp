#include "frontier/external.h"

#include <gmock/gmock.h>

#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "base/exr_picture.h"
#include "frontier/export.h"
#include "frontier/external_process.h"
#include "frontier/faults.h"
#include "frontier/record_file.h"
#include "frontier/some_records.h"
#include "scenes/builtin.h"
#include "support/temp_folder.h"

namespace lightgrid::lab {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

json ready_command() { return {{"name", "my_engine"}, {"command", {"engine", "--plane"}}}; }

json ready_files() {
  const json frame = {{"picture", "0.exr"}, {"frame_ms", {2.5, 2.25}}, {"baseline_ms", {5, 4.5}}};
  return {{"name", "my_engine"}, {"scenes", {{"hall", {{"views", "views.json"}, {"frames", {frame}}}}}}};
}

struct Description {
  TempFolder folder;
  std::filesystem::path write(const std::string& text) const {
    std::ofstream(folder.path / "0.exr") << "a picture";
    std::ofstream(folder.path / "engine.json") << text;
    return folder.path / "engine.json";
  }
  ExternalRenderer read(const json& file) const { return read_external_renderer(write(file.dump())); }
  std::string fault(const std::string& text) const {
    return fault_of([&] { read_external_renderer(write(text)); });
  }
  std::string fault(const json& file, const char* place, const json& value) const {
    json changed = file;
    changed[json::json_pointer(place)] = value;
    return fault(changed.dump());
  }
};

TEST(ExternalRenderer, IsACommandOrFramesOfScenes) {
  const Description description;
  json file = ready_command();
  file.update({{"note", "v1"}, {"timeout_s", 2.5}, {"settings", {{"samples", 4}, {"aa", "off"}}}});
  const ExternalRenderer command = description.read(file);
  EXPECT_THAT(command.command, ElementsAre("engine", "--plane"));
  EXPECT_EQ(command.label(), "my_engine:aa=off,samples=4");
  EXPECT_EQ(command.note, "v1");
  EXPECT_EQ(command.timeout_s, 2.5);
  EXPECT_EQ(command.folder, description.folder.path);
  EXPECT_TRUE(command.runs() && command.takes_part("hall") && !command.own_surfaces);
  const ExternalRenderer files = description.read(ready_files());
  EXPECT_TRUE(!files.runs() && files.takes_part("hall") && !files.takes_part("street"));
  ASSERT_EQ(files.scenes.at("hall").frames.size(), 1u);
  const ExternalFrame& frame = files.scenes.at("hall").frames[0];
  EXPECT_EQ(frame.picture, description.folder.path / "0.exr");
  EXPECT_THAT(frame.frame_ms, ElementsAre(2.5, 2.25));
  EXPECT_THAT(frame.baseline_ms, ElementsAre(5, 4.5));
  std::ofstream(description.folder.path / "0.exr") << "another picture";
  EXPECT_NE(read_external_renderer(description.folder.path / "engine.json").content, files.content);
}

TEST(ExternalRenderer, UnknownFieldsOfItsFileAreRefused) {
  const Description d;
  EXPECT_THAT(d.fault(ready_command(), "/timeout", 2),
              HasSubstr("engine.json: timeout: unknown field; did you mean timeout_s?; fields are name, "));
  EXPECT_THAT(d.fault(ready_files(), "/scenes/hall/view", 2),
              HasSubstr("engine.json: scenes.hall.view: unknown field; did you mean views?"));
  EXPECT_THAT(
      d.fault(ready_files(), "/scenes/hall/frames/0/frames_ms", {1}),
      HasSubstr("engine.json: scenes.hall.frames[0].frames_ms: unknown field; did you mean frame_ms?"));
}

TEST(ExternalRenderer, FaultsOfItsFileAreNamed) {
  const Description d;
  EXPECT_THAT(fault_of([&] { read_external_renderer(d.folder.path / "none.json"); }), HasSubstr("none.json"));
  EXPECT_THAT(d.fault("{"), HasSubstr("engine.json: is not JSON"));
  EXPECT_THAT(d.fault("[]"), HasSubstr("engine.json"));
  EXPECT_THAT(d.fault("{}"), HasSubstr("engine.json: name is missing"));
  const json command = ready_command(), files = ready_files();
  for (const json& name : {json(""), json("a b"), json("a:b"), json(std::string(61, 'a'))})
    EXPECT_THAT(d.fault(command, "/name", name), HasSubstr("engine.json: name")) << name;
  EXPECT_THAT(d.fault(command, "/name", "forward_plus"), HasSubstr("a technique of lightgrid"));
  EXPECT_THAT(d.fault(command, "/command", nullptr), HasSubstr("neither command and scenes"));
  EXPECT_THAT(d.fault(command, "/scenes", json::object()), HasSubstr("both command and scenes"));
  for (const json& wrong : {json("engine"), json::array(), json{""}, json{"engine", 3}})
    EXPECT_THAT(d.fault(command, "/command", wrong), HasSubstr("command: is not a list")) << wrong;
  for (const json& wrong : {json(0), json(-1), json(1e9), json("nan")})
    EXPECT_THAT(d.fault(command, "/timeout_s", wrong), HasSubstr("timeout_s")) << wrong;
  EXPECT_THAT(d.fault(command, "/settings", {{"a", {1}}}), HasSubstr("settings.a"));
  EXPECT_THAT(d.fault(command, "/settings", {{"a", "b=c"}}), HasSubstr("settings.a"));
  EXPECT_THAT(d.fault(command, "/surfaces", "mine"), HasSubstr("surfaces \"mine\""));
  EXPECT_THAT(d.fault(files, "/scenes", json::object()), HasSubstr("scenes: is empty"));
  EXPECT_THAT(d.fault(files, "/scenes/hall/views", nullptr), HasSubstr("scenes.hall.views is missing"));
  EXPECT_THAT(d.fault(files, "/scenes/hall/frames", json::array()), HasSubstr("scenes.hall.frames"));
  EXPECT_THAT(d.fault(files, "/scenes/hall/frames/0/picture", "gone.exr"), HasSubstr("gone.exr"));
  for (const json& wrong : {json{2, 0}, json{2, -1}, json{"nan", 2}, json{"inf", 2}, json::array(), json(2)})
    EXPECT_THAT(d.fault(files, "/scenes/hall/frames/0/frame_ms", wrong),
                HasSubstr("scenes.hall.frames[0].frame_ms"))
        << wrong;
  EXPECT_THAT(d.fault(files, "/scenes/hall/frames/0/baseline_ms", {1}),
              HasSubstr("frames[0].baseline_ms: has 1 times beside 2"));
  json second = files["scenes"]["hall"]["frames"][0];
  second["frame_ms"] = second["baseline_ms"] = {1};
  EXPECT_THAT(d.fault(files, "/scenes/hall/frames/1", second), HasSubstr("frames[1].frame_ms: has 1 times"));
}

TEST(ExternalRenderer, SeveralDifferInLabelsAndTakePartInTheSweep) {
  const Description d;
  const std::string path = d.write(ready_files().dump());
  EXPECT_EQ(read_external_renderers({path}, {"street", "hall"}).size(), 1u);
  EXPECT_THAT(fault_of([&] { read_external_renderers({path}, {"street"}); }),
              HasSubstr("none of this sweep"));
  EXPECT_THAT(fault_of([&] {
                read_external_renderers({path, path}, {"hall"});
              }),
              HasSubstr("name my_engine: another file has it"));
}

struct Exported {
  TempFolder folder;
  Scene scene = make_spheres();
  std::vector<View> views;
  Exported() {
    scene.lights.resize(3);
    for (const char* eye : {"eye:0,0,0,target:0,0,-1,fov:50", "eye:1,0,0,target:0,1,-1,fov:50"})
      views.push_back(make_view(choose_camera(scene, eye), 8, 4));
    export_scene(folder.path, "spheres", scene, views);
  }
  std::string fault(const Scene& of, const std::vector<View>& in) const {
    return fault_of([&] { check_exported_views(folder.path / "views.json", of, in); });
  }
};

TEST(ExportedViews, AreThoseOfTheSweepOrMore) {
  const Exported exported;
  check_exported_views(exported.folder.path / "views.json", exported.scene, exported.views);
  check_exported_views(exported.folder.path / "views.json", exported.scene, {exported.views[0]});
  std::vector<View> more = exported.views;
  more.push_back(more[0]);
  EXPECT_THAT(exported.fault(exported.scene, more), HasSubstr("has 2 views, the sweep 3"));
  EXPECT_THAT(exported.fault(exported.scene, {exported.views[1]}), HasSubstr("views[0]."));
  View larger = exported.views[0];
  larger.width = 9;
  EXPECT_THAT(exported.fault(exported.scene, {larger}), HasSubstr("views[0].size"));
  Scene other = exported.scene;
  other.lights[1].intensity *= 2;
  EXPECT_THAT(exported.fault(other, exported.views), HasSubstr("has other lights"));
  std::ofstream(exported.folder.path / "views.json") << "{";
  EXPECT_THAT(exported.fault(exported.scene, exported.views), HasSubstr("views.json: is not JSON"));
}

TEST(ExportedViews, HaveTheirAxesAndField) {
  const Exported exported;
  const auto view = view_json(exported.views[0]);
  EXPECT_EQ(view["direction"], json({0, 0, -1}));
  EXPECT_EQ(view["up"], json({0, 1, 0}));
  EXPECT_EQ(view["right"], json({1, 0, 0}));
  EXPECT_NEAR(view["fov_y_rad"].get<double>(), 50 * 3.14159265358979 / 180, 1e-12);
}

TEST(ExrPicture, HasThreeNamedChannelsOfItsSize) {
  const TempFolder folder;
  const auto path = folder.path / "picture.exr";
  const auto write = [&](const std::vector<ExrChannel>& channels) { save_exr(path, 2, 1, channels); };
  const auto fault = [&](int width = 2) { return fault_of([&] { load_exr_picture(path, width, 1); }); };
  const auto channel = [](const char* name, bool whole = false) {
    return ExrChannel{name, whole, {0x3f800000u, 0x7fc00000u}};  // 1, NaN
  };
  write({channel("A"), channel("B"), channel("G"), channel("R")});
  const Image image = load_exr_picture(path, 2, 1);
  EXPECT_EQ(image.at(0, 0), glm::vec4(1));
  EXPECT_TRUE(std::isnan(image.at(1, 0).r));
  EXPECT_THAT(fault(3), AllOf(HasSubstr("picture.exr: has another size"), HasSubstr("not 0,0 to 2,0")));
  write({channel("Beauty.B"), channel("Beauty.G"), channel("Beauty.R")});
  EXPECT_THAT(fault(), HasSubstr("has no channel R; its channels are Beauty.B, Beauty.G, Beauty.R"));
  write({channel("B"), channel("G"), channel("R", true)});
  EXPECT_THAT(fault(), HasSubstr("channel R holds whole numbers"));
  std::ofstream(path) << "no picture";
  EXPECT_THAT(fault(), HasSubstr("is not an EXR file"));
}

// One line, not compressed, of halves.
TEST(ExrPicture, MayHaveHalves) {
  std::string file;
  const auto add = [&](auto value) { file.append(reinterpret_cast<const char*>(&value), sizeof value); };
  const auto attribute = [&](const std::string& name, const std::string& type, int size) {
    file += name + '\0' + type + '\0';
    add(size);
  };
  add(20000630);
  add(2);
  attribute("channels", "chlist", 3 * 18 + 1);
  for (const char* name : {"B", "G", "R"}) {
    file += std::string(name) + '\0';
    add(1);
    add(0);
    add(1);
    add(1);  // half
  }
  file += '\0';
  attribute("compression", "compression", 1);
  file += '\0';
  for (const char* window : {"dataWindow", "displayWindow"}) {
    attribute(window, "box2i", 16);
    for (const int edge : {0, 0, 1, 0}) add(edge);
  }
  attribute("lineOrder", "lineOrder", 1);
  file += '\0';
  attribute("pixelAspectRatio", "float", 4);
  add(1.0f);
  attribute("screenWindowCenter", "v2f", 8);
  add(0.0f);
  add(0.0f);
  attribute("screenWindowWidth", "float", 4);
  add(1.0f);
  file += '\0';
  add(uint64_t(file.size()) + 8);
  add(0);
  add(12);
  for (const uint16_t half : {0x3c00, 0x3800, 0x4000, 0x7bff, 0x0000, 0x0001}) add(half);
  const TempFolder folder;
  std::ofstream(folder.path / "half.exr", std::ios::binary) << file;
  const Image image = load_exr_picture(folder.path / "half.exr", 2, 1);
  EXPECT_EQ(image.at(0, 0), glm::vec4(0, 2, 1, 1));
  EXPECT_EQ(image.at(1, 0), glm::vec4(5.9604644775390625e-08f, 65504, 0.5f, 1));
}

// A shell's script as another renderer.
struct Script {
  TempFolder folder;
  std::string ask(const std::string& script, double timeout_s = 20) const {
    return ExternalProcess({"sh", "-c", script}, folder.path, timeout_s).ask("{\"a\": 1}");
  }
  std::string fault(const std::string& script, double timeout_s = 20) const {
    return fault_of([&] { ask(script, timeout_s); }, ErrorKind::machine);
  }
};

TEST(ExternalProcess, AnswersTheFirstLineThatIsAnObject) {
  const Script script;
  EXPECT_EQ(script.ask("read line; echo warming up; echo \"$line\""), "{\"a\": 1}");
  EXPECT_EQ(script.ask("read line; printf '{}'"), "{}") << "without a newline";
  EXPECT_EQ(script.ask("read line; echo \"{$(pwd)}\""), "{" + script.folder.path.string() + "}");
}

TEST(ExternalProcess, GoesOnOrIsStartedAgain) {
  const TempFolder folder;
  ExternalProcess lasting({"sh", "-c", "while read line; do n=$((n+1)); echo \"{$n}\"; done"}, folder.path,
                          20);
  for (const char* answer : {"{1}", "{2}", "{3}"}) EXPECT_EQ(lasting.ask("{}"), answer);
  ExternalProcess single({"sh", "-c", "read line; echo \"$line\""}, folder.path, 20);
  for (const char* line : {"{1}", "{2}", "{3}"}) EXPECT_EQ(single.ask(line), line);
}

TEST(ExternalProcess, FailuresAreTold) {
  const Script script;
  EXPECT_THAT(script.fault("exit 3"), HasSubstr("sh: ended with status 3 without an answer"));
  EXPECT_THAT(script.fault("read line; echo no object"), HasSubstr("ended with status 0 without an answer"));
  EXPECT_THAT(script.fault("kill -TERM $$; sleep 9"), HasSubstr("was ended by signal 15"));
  EXPECT_THAT(script.fault("yes"), HasSubstr("says more than 1 MiB"));
  ExternalProcess none({"no_such_program_of_lightgrid"}, script.folder.path, 20);
  EXPECT_THAT(fault_of([&] { none.ask("{}"); }, ErrorKind::machine), HasSubstr("cannot be started"));
}

TEST(ExternalProcess, OneThatHangsIsEndedWithItsChildren) {
  const Script script;
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_THAT(script.fault("sleep 300 & echo $! > child; wait", 0.5), HasSubstr("no answer within 0.5 s"));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(60));
  int child = 0;
  std::ifstream(script.folder.path / "child") >> child;
  ASSERT_GT(child, 0);
  // Gone, or a zombie that nobody has waited for.
  const auto runs = [&] {
    std::ifstream status("/proc/" + std::to_string(child) + "/stat");
    std::string number, name, state;
    status >> number >> name >> state;
    return !state.empty() && state != "Z" && name == "(sleep)";
  };
  for (int i = 0; i < 200 && runs(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_FALSE(runs());
}

FrontierRecord external_record(bool paired) {
  FrontierRecord record = some_record(8, 0);
  record.external = {"v1", paired};
  return record;
}

TEST(ExternalRecords, AreReadBackAndUnpairedTimesAreOfNoRound) {
  const TempFolder folder;
  for (const bool paired : {true, false}) {
    const FrontierRecord record = external_record(paired);
    const FrontierRecord back = record_of(json::parse(to_json(record).dump()));
    EXPECT_EQ(back.external, record.external);
    const auto path = folder.path / (paired ? "paired" : "apart");
    RecordFile file(path, some_part(0, 1), nullptr);
    file.append(record);
    const FrontierRecord held = read_part(path, nullptr).records.at(0);
    EXPECT_EQ(held.shard >= unpaired_shard, !paired);
    EXPECT_EQ(held.shard, file.part().records.at(0).shard);
  }
  EXPECT_FALSE(to_json(some_record(8, 0)).contains("external"));
}

}  // namespace
}  // namespace lightgrid::lab
