#include "check/engine_limits.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/error.h"

namespace lightgrid::lab {
namespace {

using Scope = LimitScope;
using Kinds = LimitKinds;
using Of = LimitOf;
using Order = LimitOrder;
using Cells = LimitCells;
using Reach = LimitReach;

constexpr const char* unity_page =
    "https://docs.unity.com/en-us/engine/6000.7/manual/lighting-overview/lighting/light-limits-in-urp";
constexpr const char* unreal_page =
    "https://indxzero.github.io/ue544cvarwiki/articles/r.forward.maxculledlightspercell";
constexpr const char* unity_order =
    "which lights Unity drops, and its test of a light against an object: that code is not public";
constexpr const char* godot_order =
    "the lights that are kept are the first that were paired with the mesh, an order that is not the "
    "scene's; "
    "newer versions (pull request 107234) choose by relevance, by a formula that was not read; the box of a "
    "spot";
constexpr const char* shorter = "Shorten ranges, or merge lamps that stand together.";
constexpr const char* split = "Split the mesh, or shorten ranges.";

const std::vector<EngineLimit> limits = {
    {"urp-forward", "Unity 6000.0 to 6000.7, desktop and consoles", Scope::view, Kinds::local, Of::seen,
     Order::unknown, 256, Cells::none, Reach::range, unity_page, unity_order,
     "Show fewer lights at once: shorter ranges, or lights that are off where nobody sees them."},
    {"urp-forward", "Unity 6000.0 to 6000.7", Scope::mesh, Kinds::local, Of::kept, Order::unknown, 8,
     Cells::none, Reach::range, unity_page, unity_order,
     "Choose the Forward+ path, which has no limit per mesh; or split the mesh."},
    {"urp-forward-mobile", "Unity 6000.0 to 6000.7, mobile, WebGL and WebGPU", Scope::view, Kinds::local,
     Of::seen, Order::unknown, 32, Cells::none, Reach::range, unity_page, unity_order,
     "Show fewer lights at once; with OpenGL ES 3.0 the limit is 16."},
    {"urp-forward-mobile", "Unity 6000.0 to 6000.7", Scope::mesh, Kinds::local, Of::kept, Order::unknown, 8,
     Cells::none, Reach::range, unity_page, unity_order,
     "Choose the Forward+ path, which has no limit per mesh; or split the mesh."},
    {"urp-forward-plus", "Unity 6000.0 to 6000.7, desktop and consoles", Scope::view, Kinds::local, Of::seen,
     Order::unknown, 256, Cells::none, Reach::range, unity_page, unity_order,
     "Show fewer lights at once: shorter ranges, or lights that are off where nobody sees them."},
    {"unreal", "5.x, r.Forward.LightLinkedListCulling=1 (default)", Scope::pool, Kinds::local, Of::seen,
     Order::unknown, 32, Cells::unreal, Reach::range, unreal_page,
     "read in a copy of the engine's source and a list of its variables, not in Epic's own; that cells "
     "behind "
     "what is seen are skipped is left out, so that the count is at most; the cone test",
     "Raise r.Forward.MaxCulledLightsPerCell, or shorten attenuation radii."},
    {"unreal-fixed", "5.x, r.Forward.LightLinkedListCulling=0", Scope::cell, Kinds::local, Of::seen,
     Order::unknown, 32, Cells::unreal, Reach::range, unreal_page,
     "read in a copy of the engine's source and a list of its variables, not in Epic's own; the cone test",
     "Set r.Forward.LightLinkedListCulling=1, or raise r.Forward.MaxCulledLightsPerCell."},
    {"godot-forward-plus", "4.x", Scope::view, Kinds::each, Of::seen, Order::unknown, 512, Cells::none,
     Reach::range,
     "https://github.com/godotengine/godot/blob/master/servers/rendering/renderer_rd/storage_rd/"
     "light_storage.cpp",
     "the lights that are kept are the first that culling finds, an order that is not the scene's; fading by "
     "distance",
     "Raise rendering/limits/cluster_builder/max_clustered_elements."},
    {"godot-mobile", "4.0 to 4.7", Scope::mesh, Kinds::each, Of::scene, Order::unknown, 8, Cells::none,
     Reach::box, "https://github.com/godotengine/godot/blob/master/doc/classes/OmniLight3D.xml", godot_order,
     split},
    {"godot-compatibility", "4.0 to 4.7", Scope::mesh, Kinds::each, Of::scene, Order::unknown, 8, Cells::none,
     Reach::box, "https://github.com/godotengine/godot/blob/master/drivers/gles3/rasterizer_scene_gles3.cpp",
     godot_order, "Raise rendering/limits/opengl/max_lights_per_object, or split the mesh."},
    {"godot-compatibility", "4.x", Scope::view, Kinds::each, Of::seen, Order::unknown, 32, Cells::none,
     Reach::range,
     "https://github.com/godotengine/godot/blob/master/drivers/gles3/rasterizer_scene_gles3.cpp",
     "the lights that are kept are the first that culling finds, an order that is not the scene's",
     "Raise rendering/limits/opengl/max_renderable_lights (at most 256)."},
    {"filament", "main, 2026", Scope::view, Kinds::local, Of::seen, Order::nearest, 256, Cells::none,
     Reach::range, "https://github.com/google/filament/blob/main/filament/src/details/View.cpp", "", shorter},
    {"filament", "main, 2026", Scope::distance, Kinds::local, Of::kept, Order::nearest, 100, Cells::none,
     Reach::range, "https://github.com/google/filament/blob/main/filament/src/Froxelizer.cpp", "",
     "Raise zLightFar with View::setDynamicLightingOptions."},
    {"three-clustered", "r187, ClusteredLighting of the examples", Scope::cell, Kinds::local, Of::scene,
     Order::farthest, 64, Cells::three, Reach::range,
     "https://github.com/mrdoob/three.js/blob/r187/examples/jsm/tsl/lighting/ClusteredLightsNode.js",
     "the far plane, where the scene's camera has none: that of PerspectiveCamera, 2,000 m, is taken; "
     "earlier versions have 32 points; lights without a range are counted everywhere, but the code tests "
     "them "
     "with a range of 0",
     "Raise maxLightsPerCluster of ClusteredLighting; bring the camera's far plane near."},
    {"playcanvas", "2.23.3", Scope::view, Kinds::local, Of::seen, Order::index, 255, Cells::none,
     Reach::range, "https://github.com/playcanvas/engine/blob/main/src/scene/lighting/lights-buffer.js",
     "earlier versions, which have 254; with a higher lighting.maxLights a cell still takes 255",
     "Raise scene.lighting.maxLights, or shorten ranges."},
    {"bevy-webgl", "0.18 and 0.19 without storage buffers", Scope::view, Kinds::local, Of::seen,
     Order::points_first, 204, Cells::none, Reach::range,
     "https://github.com/bevyengine/bevy/blob/v0.19.0/crates/bevy_light/src/cluster/assign.rs",
     "lights with shadow maps or volumetrics come first among their kind, which a scene here does not say; "
     "within a kind the order is that of entities",
     "Use WebGPU, which has storage buffers, or show fewer lights at once."},
    {"babylon", "8.x and 9.28, PBRMaterial and StandardMaterial", Scope::mesh, Kinds::every, Of::scene,
     Order::index, 4, Cells::none, Reach::always,
     "https://doc.babylonjs.com/features/featuresDeepDive/lights/lights_introduction",
     "lights with shadowEnabled and a higher renderPriority come first; both are taken to be equal for all",
     "Raise maxSimultaneousLights of the materials, name includedOnlyMeshes of lights, or put lights into a "
     "ClusteredLightContainer."},
};

const std::vector<UnlimitedEngine> unlimited = {
    {"bevy", "https://github.com/bevyengine/bevy/blob/v0.19.0/crates/bevy_light/src/cluster/assign.rs",
     "with storage buffers lists have any length; since 0.19 those made on the GPU begin with room for "
     "65,536 entries, and lights may be missing for some frames while they grow"},
    {"babylon-clustered",
     "https://github.com/BabylonJS/Babylon.js/blob/master/packages/dev/core/src/Lights/Clustered/"
     "clusteredLightContainer.ts",
     "tiles have a bit for each light of the container; lights of glTF files enter it once their falloffType "
     "is FALLOFF_DEFAULT"},
};

}  // namespace

const std::vector<EngineLimit>& engine_limits() { return limits; }
const std::vector<UnlimitedEngine>& unlimited_engines() { return unlimited; }

std::vector<std::string> engine_names() {
  std::vector<std::string> names;
  for (const EngineLimit& limit : limits) {
    if (names.empty() || names.back() != limit.engine) names.emplace_back(limit.engine);
  }
  for (const UnlimitedEngine& engine : unlimited) names.emplace_back(engine.engine);
  return names;
}

std::vector<const EngineLimit*> limits_of(std::string_view engine) {
  std::vector<const EngineLimit*> found;
  for (const EngineLimit& limit : limits) {
    if (engine == "all" || engine == limit.engine) found.push_back(&limit);
  }
  const std::vector<std::string> names = engine_names();
  if (found.empty() && std::ranges::find(names, engine) == names.end())
    throw input_error("engine {}: is none of all, {}", engine, fmt::join(names, ", "));
  return found;
}

const char* name_of(LimitScope scope) {
  constexpr const char* names[] = {"view", "mesh", "cell", "pool", "distance"};
  return names[int(scope)];
}

const char* name_of(LimitOrder order) {
  constexpr const char* names[] = {"index", "points-first", "nearest", "farthest", "unknown"};
  return names[int(order)];
}

std::string id_of(const EngineLimit& limit) {
  return fmt::format("{}/{}", limit.engine, name_of(limit.scope));
}

}  // namespace lightgrid::lab
