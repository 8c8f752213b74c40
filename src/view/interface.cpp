#include "view/interface.h"

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include "base/error.h"

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

Interface::Interface(Window& window, bool scripted) : scripted_(scripted) {
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;
  choose_style();
  if (!ImGui_ImplGlfw_InitForOpenGL(window.handle(), !scripted) || !ImGui_ImplOpenGL3_Init("#version 450")) {
    throw machine_error("view: Dear ImGui does not start on this OpenGL");
  }
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
}

void Interface::end() {
  ImGui::Render();
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

bool Interface::takes_pointer() const { return ImGui::GetIO().WantCaptureMouse; }

bool Interface::takes_keys() const { return ImGui::GetIO().WantTextInput; }

}  // namespace lightgrid
