#include "scene/load_gltf.h"

#include <new>

#include "scene/gltf/lights.h"
#include "scene/gltf/materials.h"
#include "scene/gltf/meshes.h"

namespace lightgrid {
namespace {

Scene load(const std::filesystem::path& path, int scene_index, const GltfLimits& limits) {
  gltf::Document doc = gltf::read_document(path, limits);
  const std::vector<gltf::PlacedNode> nodes = gltf::place_nodes(doc, scene_index);
  Scene scene;
  scene.name = path.stem().string();
  scene.materials = gltf::read_materials(doc);
  gltf::add_meshes(doc, nodes, scene);
  scene.lights = gltf::read_lights(doc, nodes);
  scene.cameras = gltf::read_cameras(doc, nodes);
  gltf::keep_used_materials(scene);
  gltf::add_textures(doc, scene);
  return scene;
}

}  // namespace

Scene load_gltf(const std::filesystem::path& path, int scene, const GltfLimits& limits) {
  try {
    return load(path, scene, limits);
  } catch (const std::bad_alloc&) {
    throw machine_error("{}: not enough memory to load it", path.string());
  }
}

}  // namespace lightgrid
