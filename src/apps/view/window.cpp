#include "view/window.h"

#include <dlfcn.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <utility>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include "base/error.h"
#include "gl/gl.h"

namespace lightgrid::app {
namespace {

std::string glfw_error() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text ? text : "GLFW gives no reason";
}

Window& window_of(GLFWwindow* handle) { return *static_cast<Window*>(glfwGetWindowUserPointer(handle)); }

// The largest size at most this one whose window, with a frame, the screen has room for.
void fit_screen(int& width, int& height) {
  int x = 0, y = 0, max_width = 0, max_height = 0;
  GLFWmonitor* screen = glfwGetPrimaryMonitor();
  if (screen) glfwGetMonitorWorkarea(screen, &x, &y, &max_width, &max_height);
  if (max_width > 0) width = std::min(width, max_width);
  if (max_height > 0) height = std::min(height, max_height);
}

// GLFW answers programs that paste what was copied here. If such a program has ended before its answer,
// Xlib's own handler would end this program.
void survive_x_errors() {
  using Handler = int (*)(void* display, void* error);
  using SetHandler = Handler (*)(Handler);
  const auto set_handler = reinterpret_cast<SetHandler>(dlsym(RTLD_DEFAULT, "XSetErrorHandler"));
  if (set_handler) set_handler([](void*, void*) { return 0; });
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
  void leave() override { glfwMakeContextCurrent(nullptr); }

 private:
  GLFWwindow* window_;
};

void choose_style() {
  ImGui::StyleColorsDark();
  ImGuiStyle& style = ImGui::GetStyle();
  style.WindowRounding = 0;
  style.WindowBorderSize = 0;
  style.FrameRounding = 3;
  style.ItemSpacing = {6, 3};
  style.Colors[ImGuiCol_WindowBg] = {0.09f, 0.10f, 0.12f, 1};
}

}  // namespace

Window::Window(int width, int height, const std::string& title, bool fits_screen) {
#ifdef GLFW_PLATFORM
  // GLFW 3.4 tries Wayland first, whose library complains on stderr where there is no session.
  if (!std::getenv("XDG_RUNTIME_DIR")) glfwInitHint(GLFW_PLATFORM, GLFW_PLATFORM_X11);
#endif
  if (!glfwInit()) {
    throw machine_error(
        "view: no window: {}; it needs a display (DISPLAY), and xvfb-run gives one without a screen",
        glfw_error());
  }
  if (fits_screen) fit_screen(width, height);
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
  receive_events();
  survive_x_errors();
}

// Dear ImGui's callbacks call these after their own.
void Window::receive_events() {
  glfwSetWindowUserPointer(window_, this);
  glfwGetCursorPos(window_, &pointer_.x, &pointer_.y);
  glfwSetCursorPosCallback(window_, [](GLFWwindow* handle, double x, double y) {
    window_of(handle).pointer_ = {x, y};
    window_of(handle).any_event_ = true;
  });
  glfwSetMouseButtonCallback(window_, [](GLFWwindow* handle, int button, int action, int) {
    Window& window = window_of(handle);
    if (button == GLFW_MOUSE_BUTTON_LEFT)
      window.button_changes_.push_back({action == GLFW_PRESS, window.pointer_});
    window.any_event_ = true;
  });
  glfwSetKeyCallback(window_, [](GLFWwindow* handle, int key, int, int action, int) {
    static const std::map<int, const char*> names = {{GLFW_KEY_SPACE, "space"},
                                                     {GLFW_KEY_PERIOD, "period"},
                                                     {GLFW_KEY_ESCAPE, "escape"},
                                                     {GLFW_KEY_F11, "f11"},
                                                     {GLFW_KEY_F12, "f12"},
                                                     {GLFW_KEY_1, "1"},
                                                     {GLFW_KEY_2, "2"},
                                                     {GLFW_KEY_3, "3"},
                                                     {GLFW_KEY_G, "g"},
                                                     {GLFW_KEY_H, "h"},
                                                     {GLFW_KEY_R, "r"}};
    const auto name = names.find(key);
    if (action == GLFW_PRESS && name != names.end()) window_of(handle).presses_.push_back(name->second);
    window_of(handle).any_event_ = true;
  });
  glfwSetScrollCallback(window_, [](GLFWwindow* handle, double, double notches) {
    window_of(handle).wheel_ += notches;
    window_of(handle).any_event_ = true;
  });
  glfwSetDropCallback(window_, [](GLFWwindow* handle, int count, const char** paths) {
    if (count > 0) window_of(handle).dropped_ = paths[0];
    window_of(handle).any_event_ = true;
  });
  glfwSetCharCallback(window_, [](GLFWwindow* handle, unsigned) { window_of(handle).any_event_ = true; });
  glfwSetWindowRefreshCallback(window_, [](GLFWwindow* handle) { window_of(handle).any_event_ = true; });
  glfwSetFramebufferSizeCallback(window_,
                                 [](GLFWwindow* handle, int, int) { window_of(handle).any_event_ = true; });
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

void Window::limit_size(int min_width, int min_height) {
  glfwSetWindowSizeLimits(window_, min_width, min_height, GLFW_DONT_CARE, GLFW_DONT_CARE);
}

bool Window::poll(double seconds) {
  any_event_ = false;
  if (seconds > 0) {
    glfwWaitEventsTimeout(seconds);
  } else {
    glfwPollEvents();
  }
  return any_event_;
}

void Window::fill_screen() {
  auto& [x, y, width, height] = place_before_;
  GLFWmonitor* screen = glfwGetPrimaryMonitor();
  const GLFWvidmode* mode = screen ? glfwGetVideoMode(screen) : nullptr;
  if (glfwGetWindowMonitor(window_)) {
    glfwSetWindowMonitor(window_, nullptr, x, y, width, height, 0);
  } else if (mode) {
    glfwGetWindowPos(window_, &x, &y);
    glfwGetWindowSize(window_, &width, &height);
    glfwSetWindowMonitor(window_, screen, 0, 0, mode->width, mode->height, mode->refreshRate);
  }
}

void Window::set_title(const std::string& title) { glfwSetWindowTitle(window_, title.c_str()); }

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

Input Window::input() {
  constexpr int keys[] = {GLFW_KEY_W, GLFW_KEY_A, GLFW_KEY_S,         GLFW_KEY_D,
                          GLFW_KEY_Q, GLFW_KEY_E, GLFW_KEY_LEFT_SHIFT};
  Input input;
  for (size_t i = 0; i < input.held.size(); ++i) input.held[i] = glfwGetKey(window_, keys[i]) == GLFW_PRESS;
  if (glfwGetKey(window_, GLFW_KEY_RIGHT_SHIFT) == GLFW_PRESS) input.held[int(FlightKey::fast)] = true;

  int points_x = 1, points_y = 1;
  glfwGetWindowSize(window_, &points_x, &points_y);
  const double scale_x = points_x > 0 ? double(width()) / points_x : 1;
  const double scale_y = points_y > 0 ? double(height()) / points_y : 1;
  Point at = pointer_;
  if (!button_changes_.empty()) {
    const ButtonChange change = button_changes_.front();
    button_changes_.pop_front();
    at = change.at;
    if (change.down && !button_) input.pressed = {{at.x * scale_x, at.y * scale_y}};
    button_ = change.down;
  }
  input.x = at.x * scale_x;
  input.y = at.y * scale_y;
  input.button = button_;
  input.wheel = std::exchange(wheel_, 0);
  input.dropped = std::exchange(dropped_, "");
  if (!presses_.empty()) {
    input.presses = {presses_.front()};
    presses_.pop_front();
  }
  return input;
}

Interface::Interface(Window& window, bool scripted) : window_(window), scripted_(scripted) {
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;
  choose_style();
  if (!ImGui_ImplGlfw_InitForOpenGL(window.handle(), !scripted) || !ImGui_ImplOpenGL3_Init("#version 450")) {
    throw machine_error("view: Dear ImGui does not start on this OpenGL");
  }
  glClearColor(0.09f, 0.10f, 0.12f, 1);
  glClear(GL_COLOR_BUFFER_BIT);
}

Interface::~Interface() {
  ImGui_ImplOpenGL3_Shutdown();
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
}

void Interface::begin(const Input& input, int width, int height) {
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  ImGuiIO& io = ImGui::GetIO();
  if (scripted_) {
    io.DisplaySize = {float(width), float(height)};
    io.DisplayFramebufferScale = {1, 1};
    io.DeltaTime = 1.f / 60;
    io.MouseWheel += float(input.wheel);
  }
  io.MousePos = {float(input.x), float(input.y)};
  io.MouseDown[0] = input.button;
  ImGui::NewFrame();
  begun_ = true;
  input_ = input;
}

void Interface::end() {
  begun_ = false;
  ImGui::Render();
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

void Interface::announce(const std::string& text) {
  const bool again = begun_;
  if (!again) begin({}, window_.width(), window_.height());
  const ImVec2 size = ImGui::GetIO().DisplaySize, room = ImGui::CalcTextSize(text.c_str());
  const ImVec2 at(std::floor((size.x - room.x) / 2), std::floor(size.y / 2));
  ImDrawList& draw = *ImGui::GetForegroundDrawList();
  draw.AddRectFilled({at.x - 12, at.y - 8}, {at.x + room.x + 12, at.y + room.y + 8},
                     IM_COL32(23, 26, 31, 255), 4);
  draw.AddText(at, IM_COL32(255, 255, 255, 255), text.c_str());
  end();
  window_.show();
  if (again) begin(input_, int(size.x), int(size.y));
}

bool Interface::takes_pointer() const { return ImGui::GetIO().WantCaptureMouse; }

bool Interface::takes_keys() const { return ImGui::GetIO().WantTextInput; }

}  // namespace lightgrid::app
