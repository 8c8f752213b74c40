// A window with an OpenGL 4.5 core context, and its input.
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <string>

#include "gl/context.h"
#include "view/controls.h"

struct GLFWwindow;

namespace lightgrid {

class Window {
 public:
  // `fits_screen`: made smaller where the screen has less room. Throws Error(machine) with advice if there is
  // no display, or none with OpenGL 4.5.
  Window(int width, int height, const std::string& title, bool fits_screen);
  ~Window();
  Window(const Window&) = delete;

  // The window's context, current on this thread. The window outlives it.
  std::unique_ptr<GlContext> make_context();

  // The least size to which a user can shrink it, in pixels.
  void limit_size(int least_width, int least_height);

  // Processes events; waits for one for up to `seconds`. Returns whether there were any.
  bool poll(double seconds);
  bool closing() const;
  void show();  // shows the contents of framebuffer 0

  int width() const;  // pixels of its framebuffer
  int height() const;

  // The input of one frame. It has at most one press or release of the button, at the position where that
  // happened: clicks that are shorter than a frame are kept for the following frames.
  Input input();
  bool input_waits() const { return !button_changes_.empty(); }
  // Whether a key was pressed, by GLFW's number; each press is returned once.
  bool was_pressed(int key);
  void forget_presses() { presses_.clear(); }

  GLFWwindow* handle() const { return window_; }

 private:
  struct Point {
    double x = -1, y = -1;  // GLFW's units, from the upper left
  };
  struct ButtonChange {
    bool down;
    Point at;
  };
  void receive_events();  // sets callbacks for what input(), poll() and was_pressed() return

  GLFWwindow* window_ = nullptr;
  Point pointer_;
  std::deque<ButtonChange> button_changes_;
  bool button_ = false;  // after the changes that input() returned
  std::map<int, int> presses_;
  bool any_event_ = false;
};

}  // namespace lightgrid
