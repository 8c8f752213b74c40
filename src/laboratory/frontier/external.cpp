#include "frontier/external.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/exr_picture.h"
#include "base/json_file.h"
#include "frontier/export.h"
#include "frontier/record_file.h"
#include "run/frames.h"

namespace lightgrid::lab {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr uintmax_t max_description_bytes = uintmax_t(64) << 20, max_picture_bytes = uintmax_t(1) << 30;
constexpr int max_description_depth = 8;
constexpr double longest_timeout_s = 86400;

// A label parts its technique and settings by these.
bool is_word(const std::string& text) {
  return !text.empty() && text.size() <= 60 && std::ranges::all_of(text, [](unsigned char c) {
    return std::isalnum(c) || c == '_' || c == '-' || c == '.' || c == '+';
  });
}

std::string name_of(const JsonFields& file, const std::string& path) {
  const std::string name = file.text("name");
  if (!is_word(name))
    throw input_error("{}: name \"{}\": is not of 1 to 60 letters, digits, _, -, . and +", path, name);
  for (const Technique* technique : techniques()) {
    if (technique->name == name)
      throw input_error("{}: name {}: is a technique of lightgrid; choose another", path, name);
  }
  return name;
}

std::map<std::string, std::string> settings_of(const JsonFields& file, const std::string& path) {
  std::map<std::string, std::string> settings;
  if (!file.has("settings")) return settings;
  const JsonFields fields = file.object("settings");
  for (const std::string& key : fields.names()) {
    const json& value = fields.at(key);
    const std::string text = value.is_string() ? value.get<std::string>() : value.dump();
    if (!is_word(key) || !is_word(text))
      throw input_error("{}: settings.{}: {} is neither a number nor a word", path, key, value.dump());
    settings[key] = text;
  }
  return settings;
}

std::vector<std::string> command_of(const JsonFields& file, const std::string& path) {
  const json& array = file.at("command");
  std::vector<std::string> command;
  const auto is_text = [](const json& word) { return word.is_string(); };
  if (!array.is_array() || array.empty() || !std::ranges::all_of(array, is_text) ||
      array.front().get<std::string>().empty())
    throw input_error("{}: command: is not a list of a program and its arguments", path);
  for (const json& word : array) command.push_back(word.get<std::string>());
  return command;
}

std::vector<double> times_of(const JsonFields& frame, const char* key, const std::string& where) {
  const std::vector<double> times = frame.numbers(key);
  if (times.empty()) throw input_error("{}{}: is empty", where, key);
  for (const double ms : times) {
    if (!(ms > 0) || !std::isfinite(ms))
      throw input_error("{}{}: {} is not a time in milliseconds above 0", where, key, ms);
  }
  return times;
}

ExternalFrames frames_of(const JsonFields& scene, const std::string& where, const fs::path& folder) {
  scene.check_fields({"views", "frames"});
  ExternalFrames frames{.views = folder / scene.text("views"), .frames = {}};
  const json& array = scene.at("frames");
  if (!array.is_array() || array.empty()) throw input_error("{}frames: is not a list of frames", where);
  for (size_t i = 0; i < array.size(); ++i) {
    const std::string at = fmt::format("{}frames[{}].", where, i);
    const JsonFields fields(array[i], at);
    fields.check_fields({"picture", "frame_ms", "baseline_ms"});
    ExternalFrame& frame = frames.frames.emplace_back();
    frame.picture = folder / fields.text("picture");
    frame.frame_ms = times_of(fields, "frame_ms", at);
    frame.baseline_ms = times_of(fields, "baseline_ms", at);
    const size_t runs = frames.frames.front().frame_ms.size();
    if (frame.frame_ms.size() != runs)
      throw input_error("{}frame_ms: has {} times, frames[0] has {}", at, frame.frame_ms.size(), runs);
    if (frame.baseline_ms.size() != runs)
      throw input_error("{}baseline_ms: has {} times beside {} of frame_ms", at, frame.baseline_ms.size(),
                        runs);
  }
  return frames;
}

}  // namespace

std::string ExternalRenderer::label() const {
  std::string differing;
  for (const auto& [key, value] : settings) differing += (differing.empty() ? ":" : ",") + key + "=" + value;
  return name + differing;
}

ExternalRenderer read_external_renderer(const fs::path& file_path) {
  const std::string path = file_path.string();
  const std::string text = read_small_file(file_path, max_description_bytes, "a renderer's description");
  const std::string where = path + ": ";
  const json parsed = parsed_json(text, max_description_depth, where);
  const JsonFields file(parsed, where);
  file.check_fields({"name", "note", "settings", "surfaces", "command", "timeout_s", "scenes"});
  ExternalRenderer renderer{.name = name_of(file, path), .settings = settings_of(file, path)};
  if (file.has("note")) renderer.note = file.text("note");
  if (file.has("surfaces")) {
    const std::string surfaces = file.text("surfaces");
    if (surfaces != "opengl" && surfaces != "opencl")
      throw input_error("{}: surfaces \"{}\": is neither opengl nor opencl", path, surfaces);
    renderer.own_surfaces = surfaces == "opencl";
  }
  std::error_code ignored;
  renderer.folder = fs::absolute(file_path, ignored).parent_path();
  if (file.has("command") == file.has("scenes"))
    throw input_error("{}: has {} command and scenes; it needs one of them", path,
                      file.has("command") ? "both" : "neither");
  std::string content = text;
  if (file.has("command")) {
    renderer.command = command_of(file, path);
    if (file.has("timeout_s")) renderer.timeout_s = file.number("timeout_s");
    if (!(renderer.timeout_s > 0 && renderer.timeout_s <= longest_timeout_s))
      throw input_error("{}: timeout_s: {} is not above 0 and at most {}", path, renderer.timeout_s,
                        longest_timeout_s);
  } else {
    const JsonFields scenes = file.object("scenes");
    for (const std::string& scene : scenes.names()) {
      renderer.scenes[scene] =
          frames_of(scenes.object(scene), fmt::format("{}scenes.{}.", where, scene), renderer.folder);
      for (const ExternalFrame& frame : renderer.scenes[scene].frames)
        content += content_hash(read_small_file(frame.picture, max_picture_bytes, "a picture"));
    }
    if (renderer.scenes.empty()) throw input_error("{}: scenes: is empty", path);
  }
  renderer.content = content_hash(content);
  return renderer;
}

std::vector<std::shared_ptr<const ExternalRenderer>> read_external_renderers(
    const std::vector<std::string>& files, const std::vector<std::string>& scenes) {
  std::vector<std::shared_ptr<const ExternalRenderer>> all;
  for (const std::string& file : files) {
    const auto renderer = std::make_shared<const ExternalRenderer>(read_external_renderer(file));
    for (const auto& other : all) {
      if (other->label() == renderer->label())
        throw input_error("{}: name {}: another file has it; they must differ in name or settings", file,
                          renderer->label());
    }
    if (std::ranges::none_of(scenes, [&](const std::string& s) { return renderer->takes_part(s); }))
      throw input_error("{}: scenes: has none of this sweep", file);
    all.push_back(renderer);
  }
  return all;
}

void check_external_frames(const ExternalRenderer& renderer, const std::string& name, const Scene& scene,
                           const std::vector<View>& views) {
  const auto found = renderer.scenes.find(name);
  if (found == renderer.scenes.end()) return;
  const ExternalFrames& frames = found->second;
  if (frames.frames.size() < views.size())
    throw input_error("{}: scenes.{}.frames: has {}, the sweep {} views; --views {} measures as many",
                      renderer.name, name, frames.frames.size(), views.size(), frames.frames.size());
  check_exported_views(frames.views, scene, views);
  for (size_t i = 0; i < views.size(); ++i) picture_of(frames.frames[i], views[i].width, views[i].height);
}

Image picture_of(const ExternalFrame& frame, int width, int height) {
  return load_exr_picture(frame.picture, width, height);
}

}  // namespace lightgrid::lab
