#include "command_line/options.h"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "base/error.h"
#include "base/write_file.h"

namespace lightgrid::app {

namespace {

void add_fields(Subcommand& command, SceneChoice& o, ChoiceField::Of of) {
  const Subcommand::Heading heading(command,
                                    of == ChoiceField::Of::picture ? "Picture" : "Scene, lights and camera");
  for (const ChoiceField& field : choice_fields()) {
    if (field.of != of) continue;
    const std::string name = std::string("--") + field.name;
    if (const auto* text = std::get_if<std::string SceneChoice::*>(&field.value)) {
      command.option(name, o.*(*text), field.help);
    } else if (const auto* whole = std::get_if<int SceneChoice::*>(&field.value)) {
      command.option(name, o.*(*whole), field.help, 0, field.most);
    } else {
      command.option(name, o.*std::get<uint64_t SceneChoice::*>(field.value), field.help);
    }
  }
}

}  // namespace

void add_scene_options(Subcommand& command, SceneChoice& o) {
  command.option("scene", o.scene, "a .gltf or .glb file, or a built-in scene");
  add_fields(command, o, ChoiceField::Of::scene);
  add_view_options(command, o);
}

void add_file_options(Subcommand& command, SceneChoice& o) { add_fields(command, o, ChoiceField::Of::file); }

void add_view_options(Subcommand& command, SceneChoice& o) {
  add_file_options(command, o);
  add_fields(command, o, ChoiceField::Of::view);
  const Subcommand::Heading heading(command, "Technique");
  command.list("--set", o.set, "a setting, KEY=VALUE; may be repeated");
}

void add_keep_option(Subcommand& command, std::string& keep) {
  command.option("--keep", keep,
                 "with several numbers of scattered lights: range (all have the ranges of the first number), "
                 "or overlap (ranges shrink, so that equally many lights reach a point)");
}

void add_exposure_option(Subcommand& command, SceneChoice& o) {
  add_fields(command, o, ChoiceField::Of::picture);
}

void add_path_option(Subcommand& command, SceneChoice& o) { add_fields(command, o, ChoiceField::Of::path); }

void add_device_options(Subcommand& command, DeviceOptions& o) {
  const Subcommand::Heading heading(command, "Devices and timing");
  command.option("--device", o.device, "OpenCL device, by a part of its name");
  command.option("--gl", o.gl, "osmesa, egl, auto, or none: only OpenCL, for the technique visibility");
}

void add_timing_options(Subcommand& command, TimingOptions& o) {
  const Subcommand::Heading heading(command, "Devices and timing");
  command.option("--frames", o.frames, "frames to time", 1, 10000);
  command.option("--warmup", o.warmup, "untimed frames before those", 0, 10000);
}

void add_technique_option(Subcommand& command, std::string& technique, const std::string& what) {
  const Subcommand::Heading heading(command, "Technique");
  command.option("-t,--technique,--techniques", technique,
                 "NAME[:KEY=VALUE[,KEY=VALUE…]]: " + what +
                     (technique.empty() ? " (default: forward_plus; without OpenGL visibility)" : ""));
}

void check_output_file(const std::string& option, const std::filesystem::path& path) {
  if (path == "-") return;
  std::error_code unreadable;
  if (std::filesystem::is_directory(path, unreadable))
    throw input_error("{} {}: is a folder, not a file", option, path.string());
  const auto folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  if (!std::filesystem::is_directory(folder, unreadable)) {
    if (unreadable && unreadable != std::errc::no_such_file_or_directory)
      throw input_error("{} {}: {}: {}", option, path.string(), folder.string(), unreadable.message());
    throw input_error("{} {}: there is no folder {}", option, path.string(), folder.string());
  }
  if (access(folder.c_str(), W_OK | X_OK) != 0) {
    throw input_error("{} {}: no file can be made in {}: {}", option, path.string(), folder.string(),
                      std::strerror(errno));
  }
}

void check_output_files(std::initializer_list<std::pair<const char*, std::string>> files) {
  const char* on_stdout = nullptr;
  for (const auto& [option, path] : files) {
    if (path.empty()) continue;
    check_output_file(option, path);
    if (path != "-") continue;
    if (on_stdout) throw input_error("{} -: {} goes to stdout already", option, on_stdout);
    on_stdout = option;
  }
}

int with_output_folder(const std::filesystem::path& folder, const std::function<int()>& work) {
  std::error_code ignored;
  const bool is_new = !std::filesystem::exists(folder, ignored);
  make_folder(folder);
  try {
    return work();
  } catch (...) {
    if (is_new) std::filesystem::remove_all(folder, ignored);
    throw;
  }
}

void write_json(const std::string& destination, const std::string& text) {
  const std::string whole = text.ends_with('\n') ? text : text + '\n';
  if (destination == "-") {
    std::fwrite(whole.data(), 1, whole.size(), stdout);  // main checks stdout
    return;
  }
  write_file(destination, whole);
}

}  // namespace lightgrid::app
