// The panels beside the picture, and the text over it. They read the last frame and change the controls.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "view/clock.h"
#include "view/fly_camera.h"
#include "view/side.h"
#include "view/side_map.h"

namespace lightgrid::app {

inline constexpr int panel_width = 420;

// The times of the last change of each effect in a side's plan.
class PlanHistory {
 public:
  void follow(const FramePlan& plan, double now_s);
  // Seconds since the decision changed; infinite if it never did.
  double age_s(const std::string& effect, double now_s) const;

 private:
  struct Entry {
    std::string text;
    double changed_s;
  };
  std::map<std::string, Entry> entries_;
  bool first_ = true;
};

struct Shown {
  const Scene& scene;
  FlyCamera& camera;
  const Motion& motion;
  std::array<Side*, 2> sides;
  std::array<const MapOfSide*, 2> maps;
  std::array<std::string, 2> notes;  // why the side does not show what it should yet; empty: it does
  std::array<PlanHistory, 2>& plans;
  std::array<std::optional<lab::PixelInspection>, 2> pixel;  // at Controls::pixel
  bool pixel_is_new = false;                                 // clicked since the last frame
  std::array<std::string, 2> commands;
  std::string note;  // result of the last action
  bool note_is_new = false;
  const std::string& scene_name;
  const std::vector<std::string>& scenes;
  const std::string& start_camera;
  const View& view;                          // view of the drawn picture
  std::array<double, 2> pointer = {-1, -1};  // from the window's upper left
  int picture_width = 0, picture_height = 0;
  double fraction = 1;  // drawn size as a fraction of the picture's sides
  double now_s = 0;
  double rate = 0;  // frames a second of the window, of those that drew
};

void show_panels(Controls& controls, const Shown& shown);
void show_overlay(const Controls& controls, const Shown& shown);
// The upper edge of the right side's label, so that it is never over the left one's; sizes of their texts.
inline constexpr float first_label_y = 4;
float second_label_y(float left_width, float left_height, float right_width, float picture_width);
// Shows `text`, wrapped, if the pointer is over the last item.
void tooltip(const std::string& text);
// A list to choose from, over the width that is left. Returns the choice made in this frame. `about`: a
// tooltip of each name. Escape closes it.
std::optional<size_t> combo(const char* id, const std::string& current, const std::vector<std::string>& names,
                            const std::function<std::string(const std::string&)>& about = {});

// "237 lights cast shadows: 218 by rays, 19 need none", or why a technique finds none.
std::string casting_summary(const FramePlan& plan);
// `3 "lamp": rays, reaches node 5 "wall"`, or the reason why none are traced.
std::string casting_line(const LightShadow& light, const FramePlan& plan, const Scene& scene);

// Sections of the panel.
void show_techniques(Controls& controls, const Shown& shown);
// Settings whose keys begin with "shadow", or all others.
void show_settings(Controls& controls, bool of_shadows);
void show_shadows(Controls& controls, const Shown& shown);
void show_times(Controls& controls, const Shown& shown);
void show_camera(Controls& controls, const Shown& shown);
void show_motion(Controls& controls, const Shown& shown);
void show_pixel(Controls& controls, const Shown& shown);
void show_plan(const Shown& shown);
void show_commands(Controls& controls, const Shown& shown);

}  // namespace lightgrid::app
