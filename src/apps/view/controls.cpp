#include "view/controls.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include "base/error.h"
#include "techniques/technique.h"

namespace lightgrid::app {

const std::array<const char*, 9>& map_names() {
  static const std::array<const char*, 9> names = {"picture", "listed", "lit",        "lost", "hidden",
                                                   "leaked",  "acned",  "difference", "edges"};
  return names;
}

SideMap parse_map(const std::string& name) {
  std::string known;
  for (size_t i = 0; i < map_names().size(); ++i) {
    if (name == map_names()[i]) return SideMap(i);
    known += (i ? ", " : "") + std::string(map_names()[i]);
  }
  throw input_error("\"{}\" is not a map; maps are {}", name, known);
}

namespace {

constexpr double line_reach_px = 6;   // distance within which the line can be dragged
constexpr double click_reach_px = 3;  // largest movement during a click

}  // namespace

PointerResult Pointer::follow(const Input& input, int width, int height, double line, bool free) {
  PointerResult result;
  if (input.pressed) {
    x_ = (*input.pressed)[0];
    y_ = (*input.pressed)[1];
  }
  // Without `pressed` it is the position of the last frame: a script may press and move in one frame.
  if (input.button && gesture_ == Gesture::none) {
    const bool over = free && x_ >= 0 && y_ >= 0 && x_ < width && y_ < height;
    const bool near_line = std::abs(x_ - line * width) <= line_reach_px;
    gesture_ = !over ? Gesture::elsewhere : near_line ? Gesture::line : Gesture::look;
    moved_px_ = 0;
  }
  // The release has a position too: a whole drag may lie between two frames.
  const double dx = input.x - x_, dy = input.y - y_;
  moved_px_ += std::hypot(dx, dy);
  const bool drags = moved_px_ > click_reach_px;
  if (gesture_ == Gesture::line && drags) result.line = std::clamp(input.x / width, 0.0, 1.0);
  if (gesture_ == Gesture::look && drags) {
    result.turn_x = dx;
    result.turn_y = dy;
  }
  if (!input.button) {
    const bool on_picture = gesture_ == Gesture::look || gesture_ == Gesture::line;
    if (on_picture && !drags) {
      result.click = lab::PicturePixel{std::clamp(int(x_), 0, width - 1), std::clamp(int(y_), 0, height - 1)};
    }
    gesture_ = Gesture::none;
  }
  x_ = input.x;
  y_ = input.y;
  return result;
}

const std::vector<KeyHelp>& key_help() {
  static const std::vector<KeyHelp> keys = {
      {"", "drag", "turns the camera; the line: moves it"},
      {"", "W S, A D, E Q", "flies forward and back, aside, up and down; shift: faster"},
      {"", "wheel", "changes the speed"},
      {"", "click", "shows the lights at a pixel"},
      {"r", "R", "the camera of the start"},
      {"1", "1, 2, 3", "a bookmark; with shift: keeps this camera as one"},
      {"2", "", ""},
      {"3", "", ""},
      {"g", "G", "signs at the lights; pointed at: name, strength, range"},
      {"space", "space, period", "plays or pauses; one step"},
      {"period", "", ""},
      {"h", "H", "this list"},
      {"f11", "F11", "fills the screen"},
      {"f12", "F12", "saves a screenshot into the working folder"},
      {"escape", "escape", "closes lists, and this one"},
      {"", "drop a file", "opens it"},
  };
  return keys;
}

std::string screenshot_name(const std::string& scene, const std::array<SideControls, 2>& sides) {
  std::string name = std::filesystem::path(scene).stem().string() + "_" + sides[0].technique;
  if (sides[1].technique != sides[0].technique) name += "_" + sides[1].technique;
  for (char& c : name) {
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-' && c != '_') c = '_';
  }
  return name;
}

std::string shell_word(const std::string& word) {
  const auto plain = [](unsigned char c) {
    return std::isalnum(c) || std::string_view("-_./:,=+@%").find(char(c)) != std::string_view::npos;
  };
  if (!word.empty() && std::ranges::all_of(word, plain)) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

std::string render_command(const std::string& scene_words, int width, int height, const std::string& camera,
                           const std::string& time_words, const SideControls& side) {
  std::string line = fmt::format("lightgrid render {} --size {}x{}", scene_words, width, height);
  if (!camera.empty()) line += " --camera " + shell_word(camera);
  line += time_words + " -t " + side.technique;
  const auto values = to_strings(side.settings);
  const Technique& technique = find_technique(side.technique);
  for (const std::string& key : given_keys(side.settings)) {
    if (!reads_setting(technique, key)) continue;
    line += fmt::format(" --set {}={}", key, values.at(json_key(key)));
  }
  return line + " -o view.png";
}

}  // namespace lightgrid::app
