#include "view/script.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>

#include "base/error.h"
#include "base/text.h"
#include "run/scene_choice.h"
#include "techniques/technique.h"

namespace lightgrid::app {
namespace {

using Words = std::vector<std::string>;
using Run = std::function<void(Controls&, Input&)>;

constexpr int max_frames = 1'000'000;

// The fault of a word; the parser adds the line.
Error wrong(const std::string& word, const std::string& why) { return input_error("\"{}\" {}", word, why); }

template <typename T>
T number(const std::string& word, T least, T most) {
  const auto value = parse_number<T>(word);
  if (!value || !(*value >= least && *value <= most))
    throw wrong(word, fmt::format("is not a number from {} to {}", least, most));
  return *value;
}

std::string lower_case(std::string word) {
  std::ranges::transform(word, word.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return word;
}

FlightKey flight_key(const std::string& word) {
  static const std::map<std::string, FlightKey> keys = {
      {"w", FlightKey::forward}, {"a", FlightKey::left}, {"s", FlightKey::back},    {"d", FlightKey::right},
      {"q", FlightKey::down},    {"e", FlightKey::up},   {"shift", FlightKey::fast}};
  const auto found = keys.find(lower_case(word));
  if (found == keys.end()) throw wrong(word, "is not a key; keys are w, a, s, d, q, e, shift");
  return found->second;
}

// The sides that an action applies to. Removes "left" or "right" from the words; without one, both.
std::vector<int> take_sides(Words& words) {
  const std::string side = words.empty() ? "" : lower_case(words.front());
  if (side != "left" && side != "right") return {0, 1};
  words.erase(words.begin());
  return {side == "left" ? 0 : 1};
}

void expect_words(const Words& words, size_t count, const std::string& form) {
  if (words.size() < count)
    throw wrong(words.empty() ? "" : words.back(), "is followed by too little: " + form);
  if (words.size() > count) throw wrong(words[count], "is one word too many: " + form);
}

Run key(Words words) {
  expect_words(words, 2, "key down|up NAME");
  if (words[0] != "down" && words[0] != "up") throw wrong(words[0], "is not down or up");
  return [key = flight_key(words[1]), down = words[0] == "down"](Controls&, Input& input) {
    input.held[int(key)] = down;
  };
}

Run mouse(Words words) {
  expect_words(words, 3, "mouse move|drag X Y");
  if (words[0] != "move" && words[0] != "drag") throw wrong(words[0], "is not move or drag");
  const double x = number(words[1], 0.0, 1e5), y = number(words[2], 0.0, 1e5);
  return [x, y, drag = words[0] == "drag"](Controls&, Input& input) {
    input.x = x;
    input.y = y;
    input.button = drag;
  };
}

Run press(Words words) {
  expect_words(words, 1, "press NAME");
  std::string names;
  for (const KeyHelp& key : key_help()) {
    if (key.press == lower_case(words[0]) && *key.press)
      return [name = key.press](Controls&, Input& input) { input.presses.emplace_back(name); };
    if (*key.press) names += std::string(" ") + key.press;
  }
  throw wrong(words[0], "is not a key to press; keys are" + names);
}

Run wheel(Words words) {
  expect_words(words, 1, "wheel NOTCHES");
  return [turn = number(words[0], -100.0, 100.0)](Controls&, Input& input) { input.wheel = turn; };
}

Run scene(Words words) {
  expect_words(words, 1, "scene NAME|FILE");
  return [name = words[0]](Controls& controls, Input&) { controls.scene = name; };
}

Run technique(Words words) {
  const std::vector<int> sides = take_sides(words);
  expect_words(words, 1, "technique [left|right] NAME");
  const std::string name = find_technique(words[0]).name;
  return [sides, name](Controls& controls, Input&) {
    for (const int side : sides) controls.sides[side].technique = name;
  };
}

Run set(Words words) {
  const std::vector<int> sides = take_sides(words);
  expect_words(words, 1, "set [left|right] KEY=VALUE");
  Settings probe;
  apply_setting(probe, words[0]);
  return [sides, assignment = words[0]](Controls& controls, Input&) {
    for (const int side : sides) apply_setting(controls.sides[side].settings, assignment);
  };
}

Run map(Words words) {
  const std::vector<int> sides = take_sides(words);
  expect_words(words, 1, "map [left|right] NAME");
  return [sides, map = parse_map(words[0])](Controls& controls, Input&) {
    for (const int side : sides) controls.sides[side].map = map;
  };
}

Run click(Words words) {
  expect_words(words, 2, "click X Y");
  const lab::PicturePixel pixel{number(words[0], 0, 1 << 20), number(words[1], 0, 1 << 20)};
  return [pixel](Controls& controls, Input&) { controls.pixel = pixel; };
}

Run pixel(Words words) {
  expect_words(words, 1, "pixel FILE");
  return [file = words[0]](Controls& controls, Input&) { controls.pixel_file = file; };
}

Run times(Words words) {
  expect_words(words, 1, "times FILE");
  return [file = words[0]](Controls& controls, Input&) { controls.times_file = file; };
}

Run shadows(Words words) {
  expect_words(words, 1, "shadows N|all|none|scene");
  const std::string casters = words[0] == "scene" ? "" : words[0];
  chosen_casters(casters);
  return [casters](Controls& controls, Input&) { controls.casters = casters; };
}

Run light(Words words) {
  expect_words(words, 1, "light N|none");
  std::optional<int> light;
  if (words[0] != "none") light = number(words[0], 0, max_lights);
  return [light](Controls& controls, Input&) { controls.light = light; };
}

Run casting(Words words) {
  expect_words(words, 1, "casting FILE");
  return [file = words[0]](Controls& controls, Input&) { controls.casting_file = file; };
}

Run line(Words words) {
  expect_words(words, 1, "line FRACTION");
  return [at = number(words[0], 0.0, 1.0)](Controls& controls, Input&) { controls.line = at; };
}

Run camera(Words words) {
  expect_words(words, 1, "camera NAME|INDEX|eye:x,y,z,target:x,y,z,fov:degrees,near:metres");
  return [wish = words[0]](Controls& controls, Input&) { controls.camera = wish; };
}

Run lights(Words words) {
  expect_words(words, 1, "lights none|orbit|drift");
  return [motion = light_motion(words[0])](Controls& controls, Input&) { controls.lights = motion; };
}

Run time(Words words) {
  expect_words(words, 1, "time SECONDS");
  return [seconds = number(words[0], 0.0, 1e9)](Controls& controls, Input&) { controls.seconds = seconds; };
}

Run rate(Words words) {
  expect_words(words, 1, "rate FRAMES");
  return [rate = number(words[0], 0.0, 1e6)](Controls& controls, Input&) { controls.rate = rate; };
}

Run under(Words words) {
  expect_words(words, 1, "under on|off");
  if (words[0] != "on" && words[0] != "off") throw wrong(words[0], "is not on or off");
  return [on = words[0] == "on"](Controls& controls, Input&) { controls.picture_under = on; };
}

Run switch_on(Words words, bool Controls::*member, bool value) {
  expect_words(words, 0, "it takes no words");
  return [member, value](Controls& controls, Input&) { controls.*member = value; };
}

const std::map<std::string, std::function<Run(Words)>>& actions() {
  static const std::map<std::string, std::function<Run(Words)>> table = {
      {"key", key},
      {"mouse", mouse},
      {"press", press},
      {"wheel", wheel},
      {"scene", scene},
      {"technique", technique},
      {"set", set},
      {"map", map},
      {"under", under},
      {"click", click},
      {"pixel", pixel},
      {"times", times},
      {"line", line},
      {"camera", camera},
      {"lights", lights},
      {"shadows", shadows},
      {"light", light},
      {"casting", casting},
      {"time", time},
      {"rate", rate},
      {"play", [](Words words) { return switch_on(std::move(words), &Controls::playing, true); }},
      {"pause", [](Words words) { return switch_on(std::move(words), &Controls::playing, false); }},
      {"step", [](Words words) { return switch_on(std::move(words), &Controls::step, true); }},
      {"quit", [](Words words) { return switch_on(std::move(words), &Controls::quit, true); }},
  };
  return table;
}

Words words_of(std::string_view line) {
  Words words;
  line = line.substr(0, line.find('#'));
  constexpr std::string_view blanks = " \t\r";
  for (size_t at = line.find_first_not_of(blanks); at != std::string_view::npos;
       at = line.find_first_not_of(blanks, at)) {
    const size_t end = std::min(line.find_first_of(blanks, at), line.size());
    words.emplace_back(line.substr(at, end - at));
    at = end;
  }
  return words;
}

ScriptAction parse_action(Words words, int line) {
  ScriptAction action{.frame = number(words[0], 0, max_frames), .line = line, .run = nullptr};
  if (words.size() < 2) throw wrong(words[0], "is a frame without an action");
  const auto found = actions().find(words[1]);
  if (found == actions().end()) {
    std::string names;
    for (const auto& [name, parse] : actions()) names += (names.empty() ? "" : ", ") + name;
    throw wrong(words[1], "is not an action; actions are " + names);
  }
  action.run = found->second(Words(words.begin() + 2, words.end()));
  return action;
}

}  // namespace

Script::Script(std::string_view text, const std::string& name) {
  for (int line = 1; !text.empty(); ++line) {
    const std::string_view one = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), one.size() + 1));
    Words words = words_of(one);
    if (words.empty()) continue;
    try {
      actions_.push_back(parse_action(std::move(words), line));
    } catch (const Error& error) {
      throw input_error("{}:{}: {}", name, line, error.what());
    }
  }
}

Script Script::read(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::error_code unreadable;
  if (!file || std::filesystem::is_directory(path, unreadable))
    throw input_error("--script {}: cannot be read", path.string());
  const std::string text(std::istreambuf_iterator<char>(file), {});
  return Script(text, path.string());
}

void Script::play(int frame, Controls& controls, Input& input) const {
  input.button = false;
  input.wheel = 0;
  input.presses.clear();
  for (const ScriptAction& action : actions_) {
    if (action.frame == frame) action.run(controls, input);
  }
}

}  // namespace lightgrid::app
