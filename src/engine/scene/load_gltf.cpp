#include "scene/load_gltf.h"

#include <algorithm>
#include <new>

#include "scene/animation.h"
#include "scene/gltf/image_based_light.h"
#include "scene/gltf/json.h"
#include "scene/gltf/materials.h"
#include "scene/gltf/nodes.h"

namespace lightgrid {
namespace {

bool has_channels(const Rig& rig) {
  return std::any_of(rig.animations.begin(), rig.animations.end(),
                     [](const Animation& animation) { return !animation.channels.empty(); });
}

std::vector<GltfExtension> extensions_of(const gltf::Document& doc) {
  std::vector<GltfExtension> all;
  for (const std::string& name : doc.model.extensionsUsed) {
    const bool required = std::ranges::count(doc.model.extensionsRequired, name) > 0;
    all.push_back({name, required, gltf::is_supported_extension(name)});
  }
  return all;
}

Scene load(const std::filesystem::path& path, int scene_index, const GltfLimits& limits,
           std::vector<GltfExtension>* extensions) {
  gltf::Document doc = gltf::read_document(path, limits);
  if (extensions) *extensions = extensions_of(doc);
  std::vector<gltf::PlacedNode> nodes = gltf::place_nodes(doc, scene_index);
  Rig rig{.file = path.string(),
          .nodes = {},
          .animations = gltf::read_animations(doc, nodes),
          .skins = {},
          .meshes = {},
          .lights = {}};
  Scene scene;
  scene.name = path.stem().string();
  scene.environment = gltf::read_image_based_light(doc, gltf::chosen_scene(doc, scene_index));
  if (scene.environment) scene.ambient = glm::vec3(0);
  gltf::apply_extras(doc, scene_index, scene);
  scene.materials = gltf::read_materials(doc, nodes);
  if (has_channels(rig)) rig.nodes = gltf::rig_nodes(doc, nodes);
  const std::vector<int> node_of_instance = gltf::add_meshes(doc, nodes, scene, rig);
  GivenByFile given{{}, {}, gltf::property_files(path, limits.files_anywhere)};
  scene.lights = gltf::read_lights(doc, nodes, given, rig);
  gltf::add_extension_lights(doc, nodes, given, rig, scene.lights);
  scene.has_own_lights =
      !scene.lights.empty() || std::ranges::any_of(nodes, [&](const gltf::PlacedNode& placed) {
        const auto& extensions = doc.model.nodes[size_t(placed.node)].extensions;
        return gltf::find_extension(extensions, "KHR_lights_punctual") ||
               gltf::find_extension(extensions, "EXT_lights_area");
      });
  given.instances = gltf::properties_of_instances(doc, node_of_instance);
  apply_properties(scene, given);
  for (const Light& light : scene.lights) {
    const auto blinking = rig.lights.find(light.node);
    if (blinking != rig.lights.end() && blinking->second.light < 0) blinking->second.rest = light;
  }
  scene.cameras = gltf::read_cameras(doc, nodes);
  gltf::keep_used_materials(scene);
  gltf::add_textures(doc, scene);
  if (has_channels(rig)) scene.rig = std::make_shared<const Rig>(std::move(rig));
  set_time(scene, {});  // hides what is hidden at rest
  return scene;
}

}  // namespace

Scene load_gltf(const std::filesystem::path& path, int scene, const GltfLimits& limits,
                std::vector<GltfExtension>* extensions) {
  try {
    return load(path, scene, limits, extensions);
  } catch (const std::bad_alloc&) {
    throw machine_error("{}: not enough memory to load it", path.string());
  }
}

}  // namespace lightgrid
