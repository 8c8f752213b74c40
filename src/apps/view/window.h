// A window with an OpenGL 4.5 core context, its input, and Dear ImGui in it.
#pragma once

#include <array>
#include <deque>
#include <memory>
#include <string>

#include "gl/context.h"
#include "view/controls.h"

struct GLFWwindow;

namespace lightgrid::app {

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
  void limit_size(int min_width, int min_height);

  // Processes events; waits for one for up to `seconds`. Returns whether there were any.
  bool poll(double seconds);
  bool closing() const;
  void show();  // shows the contents of framebuffer 0

  int width() const;  // pixels of its framebuffer
  int height() const;

  void fill_screen();  // or back to the size before
  void set_title(const std::string& title);

  // The input of one frame. It has at most one press or release of the button, at the position where that
  // happened, and at most one press of a key: what is shorter than a frame is kept for the following frames.
  Input input();
  bool input_waits() const { return !button_changes_.empty() || !presses_.empty(); }

  GLFWwindow* handle() const { return window_; }

 private:
  struct Point {
    double x = -1, y = -1;  // GLFW's units, from the upper left
  };
  struct ButtonChange {
    bool down;
    Point at;
  };
  void receive_events();  // sets callbacks for what input() and poll() return

  GLFWwindow* window_ = nullptr;
  Point pointer_;
  std::deque<ButtonChange> button_changes_;
  bool button_ = false;  // after the changes that input() returned
  std::deque<std::string> presses_;
  double wheel_ = 0;
  std::string dropped_;
  std::array<int, 4> place_before_{};  // place of a window before it filled the screen
  bool any_event_ = false;
};

// Dear ImGui: its lifetime and its frames.
class Interface {
 public:
  // The window outlives it and its context is current. `scripted`: its size comes from begin(), and the
  // user's keys are not read.
  Interface(Window& window, bool scripted);
  ~Interface();
  Interface(const Interface&) = delete;

  // Widgets are made between the two. `width`, `height`: of the picture with its panels.
  void begin(const Input& input, int width, int height);
  void end();  // draws them into the bound framebuffer

  // Shows a line of text in the window's middle, at once: over what framebuffer 0 holds. Also after begin(),
  // as long as there is no widget yet.
  void announce(const std::string& text);

  // Returns whether a panel is under the pointer, or a text box has keyboard focus.
  bool takes_pointer() const;
  bool takes_keys() const;

 private:
  Window& window_;
  bool scripted_, begun_ = false;
  Input input_;
};

}  // namespace lightgrid::app
