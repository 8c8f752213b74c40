// Renderers of others that take part in a sweep (docs/put_your_renderer_on_the_plane.md): a file says what
// they are and how to run them, or where their pictures and times are.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "base/image.h"
#include "scene/camera.h"
#include "scene/scene.h"

namespace lightgrid::lab {

// A picture and times that were taken elsewhere, of one view.
struct ExternalFrame {
  std::filesystem::path picture;              // EXR
  std::vector<double> frame_ms, baseline_ms;  // equal length, at least one each
};

struct ExternalFrames {
  std::filesystem::path views;  // the views.json that they are of
  std::vector<ExternalFrame> frames;
};

struct ExternalRenderer {
  std::string name, note;
  std::map<std::string, std::string> settings;
  bool own_surfaces =
      false;  // held against the truth on the surfaces of the rasteriser in OpenCL, not OpenGL's
  std::filesystem::path folder;                  // folder of the file, in which the command runs
  std::vector<std::string> command;              // program and arguments; empty: `scenes` has what there is
  double timeout_s = 60;                         // for one frame
  std::map<std::string, ExternalFrames> scenes;  // by name, as in the sweep
  std::string content;                           // hash of the file and of the pictures that it names

  bool runs() const { return !command.empty(); }
  // It runs, or has frames of the scene.
  bool takes_part(const std::string& scene) const { return runs() || scenes.contains(scene); }
  std::string label() const;  // "my_engine:samples=4"
};

// Throws Error(input) that names the file, the field and the value.
ExternalRenderer read_external_renderer(const std::filesystem::path& path);

// The renderers of several files. Throws also where two have one label, and where one takes part in none of
// the scenes.
std::vector<std::shared_ptr<const ExternalRenderer>> read_external_renderers(
    const std::vector<std::string>& files, const std::vector<std::string>& scenes);

// Throws Error(input) unless its frames of the scene, if it has such, are of the scene's lights and all of
// the views, with pictures of their size.
void check_external_frames(const ExternalRenderer& renderer, const std::string& name, const Scene& scene,
                           const std::vector<View>& views);

// The picture of a view. Throws Error(input): load_exr_picture.
Image picture_of(const ExternalFrame& frame, int width, int height);

}  // namespace lightgrid::lab
