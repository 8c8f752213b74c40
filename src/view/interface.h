// Dear ImGui on the window: its life, and its frames.
#pragma once

#include "view/controls.h"
#include "view/window.h"

namespace lightgrid {

class Interface {
 public:
  // The window outlives it and its context is current. `scripted`: the pointer is what begin() is given, not
  // the user's.
  Interface(Window& window, bool scripted);
  ~Interface();
  Interface(const Interface&) = delete;

  // Between the two, widgets may be made. `width`, `height`: of the picture with its panels.
  void begin(const Input& input, int width, int height);
  void end();  // draws them into the framebuffer that is bound

  // Whether a panel is under the pointer, or a text box has the keys.
  bool takes_pointer() const;
  bool takes_keys() const;

 private:
  bool scripted_;
};

}  // namespace lightgrid
