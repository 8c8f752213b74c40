#include "view/interface.h"

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <cmath>

#include "base/error.h"
#include "gl/gl.h"

namespace lightgrid {
namespace {

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

}  // namespace lightgrid
