// The choices of the window's user, and the command line that draws the same. Panels, the mouse, keys and
// scripts change them; the viewer applies them in the next frame.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "measures/picture_pixel.h"
#include "plan/settings.h"
#include "scene/light_motion.h"

namespace lightgrid::app {

// The map that a side shows.
enum class SideMap { picture, listed, lit, lost, hidden, leaked, acned, difference, edges };

const std::array<const char*, 9>& map_names();  // by SideMap
// Throws Error(input) that lists the names.
SideMap parse_map(const std::string& name);

struct SideControls {
  std::string technique;
  Settings settings;
  SideMap map = SideMap::picture;
};

struct Controls {
  std::array<SideControls, 2> sides;  // left, right
  double line = 0.5;                  // position of the dividing line, as a fraction of the picture's width
  bool picture_under = false;         // maps let the picture through
  std::string casters;       // lights that cast shadows, in the form of --shadows; empty: the scene's own
  std::optional<int> light;  // the chosen light of the scene: maps count only its pairs
  double rate = 30;          // frames a second to hold while something moves; 0: always the full picture
  std::optional<std::string> camera;                    // target of a jump, in the form of --camera
  std::array<std::optional<std::string>, 3> bookmarks;  // cameras
  std::optional<std::string> scene;                     // to load: a name or a file
  LightMotion lights = LightMotion::none;
  bool playing = false;
  bool step = false;              // advance one frame, then pause
  std::optional<double> seconds;  // jump to this time
  bool draw_always = false;       // even if nothing changed
  bool measure_passes = true;
  std::optional<lab::PicturePixel> pixel;  // the inspected pixel of the full picture
  std::string pixel_file;                  // its lights are written there in this frame; empty: not
  std::string times_file;                  // likewise the figures of both sides
  std::string casting_file;                // likewise the lights that cast, with what the plan says of each
  bool show_lights = false;                // signs at their places
  bool show_keys = false;
  bool close_lists = false;  // in this frame
  bool screenshot = false;
  bool quit = false;
};

// Chooses the light, or none if it is chosen.
inline void toggle_light(Controls& controls, int light) {
  controls.light = controls.light == light ? std::nullopt : std::optional(light);
}

// Input of one frame, from the window or a script.
struct Input {
  std::array<bool, 7> held{};  // by FlightKey
  double x = -1, y = -1;       // pointer, pixels of the window from its upper left
  bool button = false;         // the left one
  // Where the button went down in this frame; without it, at the position of the frame before.
  std::optional<std::array<double, 2>> pressed;
  double wheel = 0;                  // notches, away from the user
  std::vector<std::string> presses;  // pressed keys, by KeyHelp::press
  std::string dropped;               // a file; empty: none
};

// An action by hand in the window, for its list of keys.
struct KeyHelp {
  const char *press, *shown, *does;  // press: the key's name in scripts; empty where it is not one key
};
const std::vector<KeyHelp>& key_help();

enum class FlightKey { forward, left, back, right, down, up, fast };  // W A S D Q E shift

struct PointerResult {
  double turn_x = 0, turn_y = 0;           // pixels since the last frame
  std::optional<double> line;              // new position of the line
  std::optional<lab::PicturePixel> click;  // pressed and released at one position
};

// Interprets the pointer over the picture: dragging the line, turning the camera, or clicking a pixel.
class Pointer {
 public:
  // The picture fills the window's upper left, width x height. `free`: no panel takes the pointer. A drag
  // that began over the picture continues over panels.
  PointerResult follow(const Input& input, int width, int height, double line, bool free);

 private:
  enum class Gesture { none, line, look, elsewhere };
  Gesture gesture_ = Gesture::none;
  double x_ = 0, y_ = 0;  // in the last frame
  double moved_px_ = 0;   // since it was pressed
};

// "hall_visibility_forward_plus": a name of a file for a scene, by name or path, and both sides.
std::string screenshot_name(const std::string& scene, const std::array<SideControls, 2>& sides);

// Quotes a word for a shell.
std::string shell_word(const std::string& word);

// `scene_words`: the scene and its lights, as options. `camera`: --camera's text, or empty. `time_words`:
// Motion::words.
std::string render_command(const std::string& scene_words, int width, int height, const std::string& camera,
                           const std::string& time_words, const SideControls& side);

}  // namespace lightgrid::app
