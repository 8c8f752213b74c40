#include "view/window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "base/error.h"
#include "gl/gl.h"

namespace lightgrid {
namespace {

std::string glfw_error() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text ? text : "GLFW gives no reason";
}

void* window_function(const char* name) { return reinterpret_cast<void*>(glfwGetProcAddress(name)); }

class WindowGlContext final : public GlContext {
 public:
  explicit WindowGlContext(GLFWwindow* window) : window_(window) {
    backend = "window";
    make_current();
    describe();
  }
  void make_current() override {
    glfwMakeContextCurrent(window_);
    load_gl_functions(window_function);
  }

 private:
  GLFWwindow* window_;
};

}  // namespace

Window::Window(int width, int height, const std::string& title) {
  if (!glfwInit()) {
    throw machine_error(
        "view: no window: {}; it needs a display (DISPLAY), and xvfb-run gives one without a screen",
        glfw_error());
  }
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
#ifndef NDEBUG
  glfwWindowHint(GLFW_OPENGL_DEBUG_CONTEXT, GLFW_TRUE);
#endif
  window_ = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
  if (!window_) {
    const std::string why = glfw_error();
    glfwTerminate();
    throw machine_error(
        "view: this display has no OpenGL 4.5: {}; Debian's libgl1-mesa-dri brings one without a GPU", why);
  }
  glfwSetInputMode(window_, GLFW_STICKY_KEYS, GLFW_TRUE);
}

Window::~Window() {
  glfwDestroyWindow(window_);
  glfwTerminate();
}

std::unique_ptr<GlContext> Window::make_context() {
  auto context = std::make_unique<WindowGlContext>(window_);
  glfwSwapInterval(1);
  return context;
}

void Window::poll(double seconds) {
  if (seconds > 0) {
    glfwWaitEventsTimeout(seconds);
  } else {
    glfwPollEvents();
  }
}

bool Window::closing() const { return glfwWindowShouldClose(window_); }

void Window::show() { glfwSwapBuffers(window_); }

int Window::width() const {
  int width = 0, height = 0;
  glfwGetFramebufferSize(window_, &width, &height);
  return width;
}

int Window::height() const {
  int width = 0, height = 0;
  glfwGetFramebufferSize(window_, &width, &height);
  return height;
}

Input Window::input() const {
  constexpr int keys[] = {GLFW_KEY_W, GLFW_KEY_A, GLFW_KEY_S,         GLFW_KEY_D,
                          GLFW_KEY_Q, GLFW_KEY_E, GLFW_KEY_LEFT_SHIFT};
  Input input;
  for (size_t i = 0; i < input.held.size(); ++i) input.held[i] = glfwGetKey(window_, keys[i]) == GLFW_PRESS;
  glfwGetCursorPos(window_, &input.x, &input.y);
  int points_x = 1, points_y = 1;
  glfwGetWindowSize(window_, &points_x, &points_y);
  if (points_x > 0 && points_y > 0) {
    input.x *= double(width()) / points_x;
    input.y *= double(height()) / points_y;
  }
  input.button = glfwGetMouseButton(window_, GLFW_MOUSE_BUTTON_LEFT) == GLFW_PRESS;
  return input;
}

bool Window::was_pressed(int key) {
  const bool down = glfwGetKey(window_, key) == GLFW_PRESS;
  const bool pressed = down && !down_[key];
  down_[key] = down;
  return pressed;
}

}  // namespace lightgrid
