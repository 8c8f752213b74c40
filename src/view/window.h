// A window with an OpenGL 4.5 core context, and its input.
#pragma once

#include <memory>
#include <string>

#include "gl/context.h"
#include "view/controls.h"

struct GLFWwindow;

namespace lightgrid {

class Window {
 public:
  // Throws Error(machine) with advice if there is no display, or none with OpenGL 4.5.
  Window(int width, int height, const std::string& title);
  ~Window();
  Window(const Window&) = delete;

  // The window's context, current on this thread. The window outlives it.
  std::unique_ptr<GlContext> make_context();

  // Processes events; waits for one for up to `seconds`.
  void poll(double seconds);
  bool closing() const;
  void show();  // shows the contents of framebuffer 0

  int width() const;  // pixels of its framebuffer
  int height() const;
  Input input() const;
  // Whether a key was pressed since the last call; by GLFW's number.
  bool was_pressed(int key);

  GLFWwindow* handle() const { return window_; }

 private:
  GLFWwindow* window_ = nullptr;
  bool down_[512] = {};
};

}  // namespace lightgrid
