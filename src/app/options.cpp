#include "app/options.h"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "base/error.h"
#include "base/write_file.h"

namespace lightgrid {

void add_scene_options(Subcommand& command, SceneChoice& o) {
  command.option("scene", o.scene, "a .gltf or .glb file, or a built-in scene");
  command.option("--size", o.size, "image size, WxH");
  command.option("--lights", o.lights, "scatter N lights; with --lights-file, its first N", 0, most_lights);
  add_view_options(command, o);
}

void add_view_options(Subcommand& command, SceneChoice& o) {
  command.option("--camera", o.camera, "name, index or eye:x,y,z,target:x,y,z,fov:degrees,near:metres");
  command.option("--lights-file", o.lights_file, "lights as JSON, instead of the scene's own");
  command.option("--light-radius", o.light_radius, "range of scattered lights in metres, MIN,MAX");
  command.option("--ambient", o.ambient, "radiance from all sides instead of the scene's own; 0: none");
  command.option("--shadows", o.shadows,
                 "lights that cast shadows: the N most important, all or none (default: as the scene says)");
  command.option("--virtual-lights", o.virtual_lights,
                 "places N virtual point lights where surfaces reflect the others", 0, most_virtual_lights);
  command.option("--virtual-from", o.virtual_from,
                 "lights that are reflected: the N most important, or all (default)");
  command.option("--virtual-nearest", o.virtual_nearest,
                 "virtual lights count as no nearer, in metres, or auto: by what each stands for (default)");
  command.option("--seed", o.seed, "seed of the scatter, and of the places of virtual lights");
  command.option("--brdf", o.brdf, "ggx, blinn or lambert: short for --set brdf=…");
  command.option("--time", o.time, "seconds into the animations of the file; not given: at rest");
  command.list("--set", o.set, "a setting, KEY=VALUE; may be repeated");
}

void add_exposure_option(Subcommand& command, SceneChoice& o) {
  command.option(
      "--exposure", o.exposure,
      "of pictures, in stops: linear values times 2^EV, or auto (default: auto for files, 0 for built-in "
      "scenes)");
}

void add_path_option(Subcommand& command, SceneChoice& o) {
  command.option("--light-motion", o.light_motion, "lights that move: none, orbit or drift");
  command.option("--camera-path", o.camera_path, "a moving camera: turn:N, dolly:N or a JSON file of keys");
}

void add_device_options(Subcommand& command, DeviceOptions& o) {
  command.option("--device", o.device, "OpenCL device, by a part of its name");
  command.option("--gl", o.gl, "osmesa, egl, auto, or none: OpenCL alone, for the technique visibility");
}

void add_timing_options(Subcommand& command, TimingOptions& o) {
  command.option("--frames", o.frames, "frames to time", 1, 10000);
  command.option("--warmup", o.warmup, "untimed frames before those", 0, 10000);
}

void add_technique_option(Subcommand& command, std::string& technique, const std::string& what) {
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

}  // namespace lightgrid
