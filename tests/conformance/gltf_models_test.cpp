// The feature that each of Khronos' and others' sample models demonstrates. The numbers are from the files'
// JSON.
#include <algorithm>

#include <glm/gtc/constants.hpp>

#include "scene/load_gltf.h"
#include "support/shared_files.h"

namespace lightgrid {
namespace {

std::filesystem::path model(const char* name) { return shared_folder() / "scenes/conformance" / name; }

#define NEEDS_MODEL(name) LIGHTGRID_NEEDS_SHARED(std::filesystem::path("scenes/conformance") / (name))

size_t triangles_drawn(const Scene& scene) {
  size_t count = 0;
  for (const Instance& instance : scene.instances) count += scene.meshes[instance.mesh].indices.size() / 3;
  return count;
}

const Material& material(const Scene& scene, const char* name) {
  for (const Material& candidate : scene.materials)
    if (candidate.name == name) return candidate;
  throw std::runtime_error(std::string("no material ") + name);
}

const Instance& instance(const Scene& scene, const char* name) {
  for (const Instance& candidate : scene.instances)
    if (candidate.name == name) return candidate;
  throw std::runtime_error(std::string("no instance ") + name);
}

void expect_box(const Scene& scene, const glm::dvec3& min, const glm::dvec3& max, double tolerance) {
  const WorldBox box = world_box(scene);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(box.min[i], min[i], tolerance) << i;
    EXPECT_NEAR(box.max[i], max[i], tolerance) << i;
  }
}

TEST(GltfModels, node_hierarchy_places_a_child_by_its_parent) {
  NEEDS_MODEL("02_node_hierarchy");
  const Scene scene = load_gltf(model("02_node_hierarchy/02_node_hierarchy.gltf"));
  ASSERT_EQ(scene.instances.size(), 2u);
  EXPECT_EQ(scene.instances[0].name, "Cube");
  EXPECT_EQ(scene.instances[1].name, "Flat_Sphere");
  EXPECT_EQ(glm::dvec3(scene.instances[1].world_from_object[3]), glm::dvec3(4, 4, 0));
  expect_box(scene, {-1, -1, -1}, {5, 5, 1}, 1e-6);
}

TEST(GltfModels, alpha_modes_and_cutoffs) {
  NEEDS_MODEL("AlphaBlendModeTest");
  const Scene scene = load_gltf(model("AlphaBlendModeTest/AlphaBlendModeTest.glb"));
  EXPECT_EQ(material(scene, "MatBed").alpha_mode, AlphaMode::opaque);
  EXPECT_FALSE(material(scene, "MatBed").double_sided);
  EXPECT_EQ(material(scene, "MatBlend").alpha_mode, AlphaMode::blend);
  EXPECT_EQ(material(scene, "MatCutoff25").alpha_mode, AlphaMode::mask);
  EXPECT_EQ(material(scene, "MatCutoff25").alpha_cutoff, 0.25f);
  EXPECT_EQ(material(scene, "MatCutoff75").alpha_cutoff, 0.75f);
  EXPECT_EQ(material(scene, "MatCutoffDefault").alpha_cutoff, 0.5f);
  EXPECT_EQ(material(scene, "MatOpaque").alpha_mode, AlphaMode::opaque);
  EXPECT_TRUE(material(scene, "MatOpaque").double_sided);
  EXPECT_EQ(scene.bitmaps.size(), 4u);
}

TEST(GltfModels, paths_with_spaces_and_unicode) {
  NEEDS_MODEL("Unicode❤♻Test");
  const Scene spaces = load_gltf(model("Box With Spaces/Box With Spaces.gltf"));
  EXPECT_EQ(spaces.bitmaps.size(), 3u);
  EXPECT_EQ(triangles_drawn(spaces), 12u);
  const Scene unicode = load_gltf(model("Unicode❤♻Test/Unicode❤♻Test.gltf"));
  EXPECT_EQ(unicode.bitmaps.size(), 1u);
  EXPECT_EQ(triangles_drawn(unicode), 2u);
}

TEST(GltfModels, boxes_interleaved_embedded_and_of_odd_texture_size) {
  NEEDS_MODEL("BoxInterleaved");
  for (const char* name : {"BoxInterleaved/BoxInterleaved.glb", "BoxTextured-Embedded/BoxTextured.gltf",
                           "BoxTexturedNonPowerOfTwo/BoxTexturedNonPowerOfTwo.gltf"}) {
    const Scene scene = load_gltf(model(name));
    EXPECT_EQ(triangles_drawn(scene), 12u) << name;
    EXPECT_EQ(scene.meshes.at(0).positions.size(), 24u) << name;
    expect_box(scene, glm::dvec3(-0.5), glm::dvec3(0.5), 1e-6);
  }
  const Scene odd = load_gltf(model("BoxTexturedNonPowerOfTwo/BoxTexturedNonPowerOfTwo.gltf"));
  EXPECT_EQ(odd.bitmaps.at(0).width, 211);
  EXPECT_EQ(odd.bitmaps.at(0).height, 211);
}

TEST(GltfModels, both_kinds_of_camera) {
  NEEDS_MODEL("Cameras");
  const Scene scene = load_gltf(model("Cameras/Cameras.gltf"));
  ASSERT_EQ(scene.cameras.size(), 2u);
  EXPECT_FALSE(scene.cameras[0].orthographic);
  EXPECT_EQ(scene.cameras[0].fov_y_rad, 0.7);
  EXPECT_EQ(scene.cameras[0].aspect, 1);
  EXPECT_EQ(scene.cameras[0].near_m, 0.01);
  EXPECT_EQ(scene.cameras[0].far_m, 100);
  EXPECT_TRUE(scene.cameras[1].orthographic);
  EXPECT_EQ(scene.cameras[1].half_width_m, 1);
  EXPECT_EQ(glm::dvec3(scene.cameras[1].world_from_view[3]), glm::dvec3(0.5, 0.5, 3));
}

TEST(GltfModels, skins_stand_in_their_rest_pose) {
  NEEDS_MODEL("CesiumMan");
  const Scene man = load_gltf(model("CesiumMan/CesiumMan.gltf"));
  EXPECT_EQ(triangles_drawn(man), 4672u);
  const WorldBox box = world_box(man);
  EXPECT_GT(box.max.y - box.min.y, 1.4) << "stands upright, though his mesh lies";
  EXPECT_NEAR(box.min.y, 0, 0.01);

  const Scene simple = load_gltf(model("SimpleSkin/SimpleSkin.gltf"));
  expect_box(simple, {-0.5, 0, 0}, {0.5, 2, 0}, 1e-6);

  const Scene many = load_gltf(model("RecursiveSkeletons/RecursiveSkeletons.glb"));
  EXPECT_EQ(many.instances.size(), 84u);
  for (const Instance& one : many.instances) EXPECT_EQ(one.world_from_object, glm::dmat4(1));
}

TEST(GltfModels, the_milk_truck_shares_its_wheels_and_is_turned_by_its_root) {
  NEEDS_MODEL("CesiumMilkTruck");
  const Scene scene = load_gltf(model("CesiumMilkTruck/CesiumMilkTruck.glb"));
  EXPECT_EQ(scene.instances.size(), 5u);
  EXPECT_EQ(scene.meshes.size(), 4u);
  EXPECT_EQ(instance(scene, "Wheels").mesh, instance(scene, "Wheels.001").mesh);
  EXPECT_NE(instance(scene, "Wheels").world_from_object, instance(scene, "Wheels.001").world_from_object);
}

TEST(GltfModels, emissive_strength_multiplies_the_factor) {
  NEEDS_MODEL("EmissiveStrengthTest");
  const Scene scene = load_gltf(model("EmissiveStrengthTest/EmissiveStrengthTest.glb"));
  const std::pair<const char*, float> strengths[] = {
      {"Emit1", 1}, {"Emit2", 2}, {"Emit4", 4}, {"Emit8", 8}, {"Emit16", 16}};
  for (const auto& [name, strength] : strengths) {
    const glm::vec3 emissive = material(scene, name).emissive;
    EXPECT_FLOAT_EQ(emissive.r, 0.1f * strength) << name;
    EXPECT_FLOAT_EQ(emissive.g, 0.5f * strength) << name;
    EXPECT_FLOAT_EQ(emissive.b, 0.9f * strength) << name;
  }
  EXPECT_EQ(material(scene, "FlatBackdrop").emissive, glm::vec3(0));
}

TEST(GltfModels, animated_nodes_stand_as_the_file_has_them) {
  NEEDS_MODEL("InterpolationTest");
  const Scene scene = load_gltf(model("InterpolationTest/InterpolationTest.glb"));
  EXPECT_EQ(scene.instances.size(), 10u);
  EXPECT_NEAR(instance(scene, "Cube.001").world_from_object[3].x, -3.2963297366, 1e-9);
}

TEST(GltfModels, spot_lights_shine_along_their_nodes_negative_z) {
  NEEDS_MODEL("LightOrientation");
  const Scene scene = load_gltf(model("LightOrientation/LightOrientation.gltf"));
  ASSERT_EQ(scene.lights.size(), 4u);
  const float outer[] = {0.410152376f, 0.115628064f, 0.213802829f, 0.0534507073f};
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(scene.lights[i].type, LightType::spot);
    EXPECT_EQ(scene.lights[i].outer_cone_rad, outer[i]);
    EXPECT_EQ(scene.lights[i].inner_cone_rad, 0);
    EXPECT_EQ(scene.lights[i].intensity, 100000);
    EXPECT_EQ(scene.lights[i].radius_m, 3.40282347e+38f);
    // The nodes are turned by 2 acos(0.8467) = 64.29 degrees about -x: -z goes to (0, -sin, -cos).
    EXPECT_NEAR(scene.lights[i].direction.x, 0, 1e-6);
    EXPECT_NEAR(scene.lights[i].direction.y, -0.90096, 1e-4);
    EXPECT_NEAR(scene.lights[i].direction.z, -0.43389, 1e-4);
  }
  EXPECT_NEAR(scene.lights[0].position.x, 2, 1e-6);
  EXPECT_EQ(scene.lights[0].name, "spotLight_pi_div_4");
}

TEST(GltfModels, the_lamp_has_five_point_lights_with_colours) {
  NEEDS_MODEL("LightsPunctualLamp");
  const Scene scene = load_gltf(model("LightsPunctualLamp/LightsPunctualLamp.gltf"));
  ASSERT_EQ(scene.lights.size(), 5u);
  for (const Light& light : scene.lights) EXPECT_EQ(light.type, LightType::point);
  EXPECT_EQ(scene.lights[0].color, glm::vec3(1, 0.6318749785423279f, 0.23909975588321689f));
  EXPECT_EQ(scene.lights[1].color, glm::vec3(1));
  EXPECT_EQ(scene.lights[1].intensity, 1.5f);
  EXPECT_EQ(scene.lights[4].intensity, 180);
  EXPECT_NEAR(scene.lights[0].position.y, 0.9077973365783693, 1e-15);
  EXPECT_EQ(scene.bitmaps.size(), 6u) << "the transmission image is not needed";
}

TEST(GltfModels, playcanvas_lights_are_of_all_three_types) {
  NEEDS_MODEL("PlaycanvasLights");
  const Scene scene = load_gltf(model("PlaycanvasLights/Lights.glb"));
  ASSERT_EQ(scene.lights.size(), 4u);
  EXPECT_EQ(scene.lights[0].type, LightType::point);
  EXPECT_EQ(scene.lights[1].type, LightType::spot);
  EXPECT_EQ(scene.lights[3].type, LightType::directional);
  EXPECT_EQ(scene.lights[1].color, glm::vec3(0, 1, 0));
  EXPECT_FLOAT_EQ(scene.lights[2].outer_cone_rad, 0.07866951823234558f);
  EXPECT_NEAR(scene.lights[1].direction.y, -1, 1e-6) << "Blender's spots point down";
  EXPECT_NEAR(scene.lights[2].position.y, 6.1562676429748535, 1e-12);
  ASSERT_EQ(scene.cameras.size(), 1u);
  EXPECT_EQ(scene.cameras[0].aspect, 0) << "none in the file";
}

TEST(GltfModels, a_million_triangles_of_shared_accessors) {
  NEEDS_MODEL("MetalRoughSpheresNoTextures");
  const Scene scene = load_gltf(model("MetalRoughSpheresNoTextures/MetalRoughSpheresNoTextures.glb"));
  EXPECT_EQ(triangles_drawn(scene), 1040409u);
}

TEST(GltfModels, two_uv_sets_serve_two_maps) {
  NEEDS_MODEL("MultiUVTest");
  const Scene scene = load_gltf(model("MultiUVTest/MultiUVTest.glb"));
  const Mesh& mesh = scene.meshes.at(0);
  EXPECT_EQ(mesh.uv0.size(), mesh.positions.size());
  EXPECT_EQ(mesh.uv1.size(), mesh.positions.size());
  EXPECT_NE(mesh.uv0, mesh.uv1);
  EXPECT_EQ(scene.materials.at(0).base_color_map.uv_set, 0);
  EXPECT_EQ(scene.materials.at(0).emissive_map.uv_set, 1);
  EXPECT_NEAR(scene.cameras.at(0).world_from_view[3].x, 7.481131553649902, 1e-12);
}

TEST(GltfModels, each_of_several_scenes_can_be_asked_for) {
  NEEDS_MODEL("MultipleScenes");
  const auto path = model("MultipleScenes/MultipleScenes.gltf");
  EXPECT_EQ(triangles_drawn(load_gltf(path, 0)), 1u);
  EXPECT_EQ(triangles_drawn(load_gltf(path, 1)), 2u);
  EXPECT_EQ(triangles_drawn(load_gltf(path)), 2u) << "the file's default is the second";
}

TEST(GltfModels, negative_scales_are_kept_and_two_of_them_cancel) {
  NEEDS_MODEL("NegativeScaleTest");
  const Scene scene = load_gltf(model("NegativeScaleTest/NegativeScaleTest.glb"));
  const auto mirrored = [&](const char* name) {
    return glm::determinant(glm::dmat3(instance(scene, name).world_from_object)) < 0;
  };
  EXPECT_FALSE(mirrored("PositiveScaleTest"));
  EXPECT_TRUE(mirrored("NegativeScaleFront"));
  EXPECT_TRUE(mirrored("NotShinyMinus1"));
  EXPECT_TRUE(mirrored("Shiny1"));
  EXPECT_FALSE(mirrored("ShinyMinus1"));
}

TEST(GltfModels, orientation_test_reaches_equally_far_to_all_sides) {
  NEEDS_MODEL("OrientationTest");
  const Scene scene = load_gltf(model("OrientationTest/OrientationTest.glb"));
  EXPECT_EQ(scene.instances.size(), 13u);
  expect_box(scene, glm::dvec3(-5.331), glm::dvec3(5.331), 1e-3);
}

TEST(GltfModels, sparse_positions_replace_three_of_fourteen) {
  NEEDS_MODEL("SimpleSparseAccessor");
  const Scene scene = load_gltf(model("SimpleSparseAccessor/SimpleSparseAccessor.gltf"));
  expect_box(scene, {0, 0, 0}, {6, 4, 0}, 0);
  EXPECT_EQ(triangles_drawn(scene), 12u);
}

TEST(GltfModels, texture_settings_wrap_and_sidedness) {
  NEEDS_MODEL("TextureSettingsTest");
  const Scene scene = load_gltf(model("TextureSettingsTest/TextureSettingsTest.glb"));
  const auto texture = [&](const char* name) {
    return scene.textures.at(material(scene, name).base_color_map.texture);
  };
  EXPECT_EQ(texture("TextureMirrorMaterialT").wrap_v, Wrap::mirror);
  EXPECT_EQ(texture("TextureMirrorMaterialT").wrap_u, Wrap::repeat);
  EXPECT_EQ(texture("TextureMirrorMaterialS").wrap_u, Wrap::mirror);
  EXPECT_EQ(texture("TextureClampMaterialT").wrap_v, Wrap::clamp);
  EXPECT_EQ(texture("TextureClampMaterialS").wrap_u, Wrap::clamp);
  EXPECT_TRUE(material(scene, "DoubleSidedMaterial").double_sided);
  EXPECT_FALSE(material(scene, "SingleSidedMaterial").double_sided);
  EXPECT_EQ(scene.bitmaps.size(), 3u);
}

// The marker of each quad is where the arrow must point: its position, turned by the transform, lies on the
// arrow's own line, the diagonal of the image, at (0.778, 0.778).
TEST(GltfModels, texture_transforms_turn_the_arrow_to_its_marker) {
  NEEDS_MODEL("TextureTransformTest");
  const Scene scene = load_gltf(model("TextureTransformTest/TextureTransformTest.gltf"));
  EXPECT_EQ(material(scene, "Offset UV").base_color_map.uv_from_vertex,
            (glm::mat3x2{1, 0, 0, 1, 0.5f, 0.5f}));
  const auto image_uv = [&](const char* quad, const char* marker) {
    const glm::dvec3 at(glm::inverse(instance(scene, quad).world_from_object) *
                        instance(scene, marker).world_from_object[3]);
    return material(scene, quad).base_color_map.uv_from_vertex * glm::vec3(at.x + 0.5, 0.5 - at.y, 1);
  };
  EXPECT_LT(glm::length(image_uv("Rotation", "Rotation - Correct") - glm::vec2(0.7778f)), 1e-3f);
  EXPECT_LT(glm::length(image_uv("Scale", "Scale - Correct") - glm::vec2(0.7778f)), 1e-3f);
  EXPECT_GT(glm::length(image_uv("Rotation", "Rotation - Error") - glm::vec2(0.7778f)), 0.5f);
}

TEST(GltfModels, one_triangle_without_indices) {
  NEEDS_MODEL("TriangleWithoutIndices");
  const Scene scene = load_gltf(model("TriangleWithoutIndices/TriangleWithoutIndices.gltf"));
  EXPECT_EQ(scene.meshes.at(0).indices, (std::vector<uint32_t>{0, 1, 2}));
  EXPECT_EQ(scene.meshes.at(0).normals, std::vector<glm::vec3>(3, {0, 0, 1}));
}

TEST(GltfModels, unlit_materials) {
  NEEDS_MODEL("UnlitTest");
  const Scene scene = load_gltf(model("UnlitTest/UnlitTest.glb"));
  EXPECT_TRUE(material(scene, "Orange").unlit);
  EXPECT_TRUE(material(scene, "Blue").unlit);
  EXPECT_EQ(material(scene, "Orange").base_color, glm::vec4(1, 0.217637640824031f, 0, 1));
}

TEST(GltfModels, vertex_colours_lie_on_one_of_the_meshes) {
  NEEDS_MODEL("VertexColorTest");
  const Scene scene = load_gltf(model("VertexColorTest/VertexColorTest.glb"));
  EXPECT_TRUE(scene.meshes.at(instance(scene, "Labels").mesh).colors.empty());
  const Mesh& mesh = scene.meshes.at(instance(scene, "VertexColorTest").mesh);
  ASSERT_EQ(mesh.colors.size(), mesh.positions.size());
  for (const glm::vec3 corner : {glm::vec3(1, 0, 0), glm::vec3(0, 1, 0), glm::vec3(0, 0, 1)})
    EXPECT_TRUE(std::any_of(mesh.colors.begin(), mesh.colors.end(), [&](const glm::vec4& color) {
      return glm::length(glm::vec3(color) - corner) < 0.01f;
    }));
}

}  // namespace
}  // namespace lightgrid
