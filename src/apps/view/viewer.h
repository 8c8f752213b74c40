// A window on a scene: two techniques side by side, controlled by a user or a script.
#pragma once

#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "base/image.h"
#include "run/virtual_lights.h"
#include "view/clock.h"
#include "view/controls.h"
#include "view/panels.h"
#include "view/screen.h"
#include "view/script.h"
#include "view/side_map.h"
#include "view/window.h"

namespace lightgrid::app {

struct ViewJob {
  std::string name;  // name of the scene: a built-in one's or a file's
  Scene scene;
  View view;                      // view of the picture; the window adds its panel
  std::string scene_words;        // the scene and its lights as command-line options
  std::string camera;             // the value of --camera
  std::optional<double> seconds;  // time of the scene's animations; empty: at rest
  Controls controls;              // initial values
  std::function<std::unique_ptr<VirtualLights>(Scene&)> reflect;  // null ones: none were chosen
  std::function<Exposure(const Image&)> expose;  // exposure of the scene's pictures, by its first one
  bool filmic = false;                           // pictures have the filmic curve (base/display.h)
  float glow = 0;                                // share of their light that spreads (base/display.h)

  bool scripted = false;  // no user: ends after `frames`, in steps of a sixtieth of a second
  Script script{"", ""};
  int frames = 0;
  std::filesystem::path screenshot;  // file of the last frame; empty: not saved

  std::function<ViewJob(const std::string& name)> load;  // another scene, with the start's options
  std::vector<std::string> scenes;                       // to choose from
  int first_frame = 0;
};

class Viewer {
 public:
  // All outlive it. The window has room for the picture and its panel.
  Viewer(Window& window, Interface& interface, Renderer& renderer, ViewJob job);
  ~Viewer();

  // Returns when the window is closed, the script ends, or with a job when another scene was chosen.
  std::optional<ViewJob> run();

 private:
  void frame(int number);
  void press(const std::string& key, bool shift);
  std::optional<ViewJob> chosen_scene(int next_frame);
  void announce(const std::string& text);
  Side& side(int i) { return sides_[same_ ? 0 : i]; }
  const Side& side(int i) const { return sides_[same_ ? 0 : i]; }
  void take_input(int number);
  void draw_sides();
  void follow_maps();
  void follow_pixel();
  void choose_casters();
  void leave_scene();  // by the oracle's threads, before the scene changes
  MapChoice wanted_map(int i) const;
  bool shows_map(int i) const { return maps_[i].shows(wanted_map(i), side(i)); }
  void write_casting(const std::string& file);
  void write_pixel(const std::string& file) const;
  void write_times(const std::string& file) const;
  void show(const Shown& shown);
  void expose();                    // once
  GLuint displayed_picture(int i);  // texture of a side's picture, with the glow
  Shown shown();
  void tell(const std::string& note);
  void take_screenshot();
  double frames_a_second() const;  // rate of frames that drew; 0: none yet
  double wait_s() const;           // for events, before the next frame

  Window& window_;
  ViewJob job_;
  Interface& interface_;
  Renderer& renderer_;
  GpuScene gpu_;
  Screen screen_;
  bool exposed_ = false;
  struct {
    GlTexture texture;
    size_t picture = 0;  // Side::pictures() of the picture it was made from
  } glowing_[2];
  Controls& controls_;
  FlyCamera camera_;
  Motion motion_;
  std::unique_ptr<VirtualLights> reflected_;  // only for a scene that moves
  Pointer pointer_;
  Resolution resolution_;
  ReferencePicture reference_;
  Side sides_[2];
  bool same_ = false;              // both sides show the left one's picture
  std::vector<bool> own_casters_;  // lights that the scene says cast
  std::string casters_;            // Controls::casters, as the scene has it
  lab::SceneOcclusion occlusion_;
  MapOfSide maps_[2];
  bool map_announced_[2] = {};  // "computing" was shown for a frame
  std::array<PlanHistory, 2> plans_;
  std::array<std::optional<lab::PixelInspection>, 2> pixel_;
  lab::PicturePixel pixel_shown_{-1, -1};  // outside: none
  bool pixel_is_new_ = false;
  size_t pixel_picture_[2] = {};
  Input script_input_;
  int width_ = 0, height_ = 0;              // size of the picture
  int drawn_width_ = 0, drawn_height_ = 0;  // size of the drawn part
  View view_;                               // view of the drawn part
  double seconds_ = 0, now_s_ = 0;          // time of this frame, and since the start
  double fraction_ = 1;
  double sides_ms_ = 0;            // time of this frame; 0: not both are figures
  std::deque<double> between_ms_;  // the last frames that drew figures, from start to start
  Timer announced_;
  std::set<std::string> compiled_;  // files
  bool moved_ = false, drew_ = false;
  int awake_frames_ = 0;  // to draw before the next wait for events
  std::string note_;
  double told_s_ = -1e9;  // when
  Input input_;           // input of this frame
};

}  // namespace lightgrid::app
