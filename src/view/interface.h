// Dear ImGui in the window: its lifetime and its frames.
#pragma once

#include "view/controls.h"
#include "view/window.h"

namespace lightgrid {

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

  // Shows a line of text in the window's middle, at once: over what framebuffer 0 holds. Also after begin(), as
  // long as there is no widget yet.
  void announce(const std::string& text);

  // Whether a panel is under the pointer, or a text box has keyboard focus.
  bool takes_pointer() const;
  bool takes_keys() const;

 private:
  Window& window_;
  bool scripted_, begun_ = false;
  Input input_;
};

}  // namespace lightgrid
