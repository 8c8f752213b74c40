// glTF 2.0 into a Scene (Khronos, glTF 2.0 specification, 2021). The only user of tinygltf.
#pragma once

#include <filesystem>

#include "scene/scene.h"

namespace lightgrid {

// Limits on a file's sizes, so that no input can exhaust the machine, and on the files that it may name.
struct GltfLimits {
  int max_image_side = 32768;        // in a file
  int texture_side = 8192;           // larger images are averaged down to it
  size_t max_image_bytes = 0;        // all images, decoded and averaged down; 0: by the memory that is free
  size_t max_vertices = 50'000'000;  // all meshes, and vertices displaced by morph targets
  size_t max_instances = 1'000'000;
  size_t max_animation_values = 50'000'000;  // key times and values of all animations
  size_t max_file_bytes = size_t(2) << 30;
  bool files_anywhere = false;  // else only files in the folder of the glTF file and below
};

struct GltfExtension {
  std::string name;
  bool required = false, supported = false;
};

// Loads .gltf or .glb by content, scene `scene` of the file or its default one at -1. The scene is at rest:
// nodes, joints and morph weights as in the file. If it has animations of this scene's nodes, Scene::rig
// holds them, and set_time (scene/animation.h) plays them. Throws Error(input) in one line that names the
// file, the field and the value. Each optional and unsupported feature (an extension, points) gives one
// warning on stderr. An image that is missing or broken becomes a checkerboard, with a warning that names it.
// Reads only regular files, and without limits.files_anywhere only those in the file's own folder and below;
// the folder of a link is also that of its target. Deterministic.
// `extensions`: those that the file names, in its order.
Scene load_gltf(const std::filesystem::path& path, int scene = -1, const GltfLimits& limits = {},
                std::vector<GltfExtension>* extensions = nullptr);

}  // namespace lightgrid
