// Nodes at a time: matrices computed by hand.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "support/animated_gltf.h"

namespace lightgrid {
namespace {

using Ints = std::vector<int>;

glm::dmat4 world_at(Scene& scene, double seconds, int animation = -1) {
  set_time(scene, seconds, animation);
  return scene.instances.at(0).world_from_object;
}

glm::dvec3 position_at(Scene& scene, double seconds, int animation = -1) {
  return glm::dvec3(world_at(scene, seconds, animation)[3]);
}

// Keys at 1 and 3 s, at (2, 0, 0) and (6, 8, -4).
Scene moving(const char* interpolation) {
  GltfBuilder made = GltfBuilder::triangle();
  made.node()["translation"] = {-1, -1, -1};
  animate(made, 0, "translation", {1, 3}, "VEC3", {2, 0, 0, 6, 8, -4}, interpolation);
  return made.load();
}

TEST(AnimationNodes, a_linear_translation_runs_between_its_keys_and_stays_at_its_ends) {
  Scene scene = moving("LINEAR");
  expect_near(position_at(scene, 1), {2, 0, 0});
  expect_near(position_at(scene, 1.5), {3, 2, -1});
  expect_near(position_at(scene, 2), {4, 4, -2});
  expect_near(position_at(scene, 3), {6, 8, -4});
  expect_near(position_at(scene, 0.25), {2, 0, 0});
  expect_near(position_at(scene, -7), {2, 0, 0});
  expect_near(position_at(scene, 100), {6, 8, -4});
}

TEST(AnimationNodes, a_step_keeps_a_keys_value_until_the_next) {
  Scene scene = moving("STEP");
  expect_near(position_at(scene, 1), {2, 0, 0});
  expect_near(position_at(scene, 2.999999), {2, 0, 0});
  expect_near(position_at(scene, 3), {6, 8, -4});
}

TEST(AnimationNodes, a_cubic_spline_scales_its_tangents_by_the_time_between_keys) {
  GltfBuilder made = GltfBuilder::triangle();
  // Two keys, 2 s apart: value 1 with out-tangent 3 a second, value 5 with in-tangent -1 a second. At half
  // the time the Hermite basis is 1/2, 1/8, 1/2, -1/8: 1/2 + 2 * 3 / 8 + 5/2 + 2 * 1 / 8 = 4. At a quarter it
  // is 54/64, 9/64, 10/64, -3/64: (54 + 2 * 9 * 3 + 10 * 5 + 2 * 3) / 64 = 164 / 64.
  animate(made, 0, "translation", {1, 3}, "VEC3", {9, 9, 9, 1, 0, 0, 3, 0, 0, -1, 0, 0, 5, 0, 0, 9, 9, 9},
          "CUBICSPLINE");
  Scene scene = made.load();
  expect_near(position_at(scene, 2), {4, 0, 0});
  expect_near(position_at(scene, 1.5), {164.0 / 64, 0, 0});
  expect_near(position_at(scene, 1), {1, 0, 0});
  expect_near(position_at(scene, 0.5), {1, 0, 0});
  expect_near(position_at(scene, 4), {5, 0, 0});
}

TEST(AnimationNodes, a_rotation_turns_at_constant_speed_along_the_shorter_arc) {
  GltfBuilder made = GltfBuilder::triangle();
  // From none to a quarter turn about z, the second quaternion negated: the same rotation.
  animate(made, 0, "rotation", {0, 1}, "VEC4", {0, 0, 0, 1, 0, 0, -float(root_half), -float(root_half)});
  Scene scene = made.load();
  for (const double t : {0.125, 1.0 / 3, 0.5, 0.9}) {
    const double angle = t * std::numbers::pi / 2;
    expect_near(at(world_at(scene, t), {1, 0, 0}), {std::cos(angle), std::sin(angle), 0}, 1e-7);
  }
}

TEST(AnimationNodes, a_small_rotation_and_an_equal_one_are_exact) {
  GltfBuilder made = GltfBuilder::triangle();
  // A turn of 2e-7 rad, then none.
  animate(made, 0, "rotation", {0, 1, 2}, "VEC4", {0, 0, 0, 1, 0, 0, 1e-7f, 1, 0, 0, 1e-7f, 1});
  Scene scene = made.load();
  EXPECT_NEAR(world_at(scene, 0.5)[0].y, 1e-7, 1e-14);
  EXPECT_NEAR(world_at(scene, 1.5)[0].y, 2e-7, 1e-14);
}

TEST(AnimationNodes, rotations_need_not_be_unit_quaternions) {
  GltfBuilder made = GltfBuilder::triangle();
  // Quarter turn about x of length 3, half turn about x of length 1/2: halfway 135 degrees.
  animate(made, 0, "rotation", {0, 2}, "VEC4",
          {3 * float(root_half), 0, 0, 3 * float(root_half), 0.5f, 0, 0, 0});
  Scene scene = made.load();
  expect_near(at(world_at(scene, 0, 0), {0, 1, 0}), {0, 0, 1}, 1e-7);
  expect_near(at(world_at(scene, 1), {0, 1, 0}), {0, -std::sqrt(0.5), std::sqrt(0.5)}, 1e-7);
}

TEST(AnimationNodes, a_cubic_rotation_is_made_unit) {
  GltfBuilder made = GltfBuilder::triangle();
  const std::vector<float> none = {0, 0, 0, 0};
  std::vector<float> values;
  for (const std::vector<float>& part :
       {none, {0, 0, 0, 1}, none, none, {0, 0, float(root_half), float(root_half)}, none}) {
    values.insert(values.end(), part.begin(), part.end());
  }
  animate(made, 0, "rotation", {0, 1}, "VEC4", values, "CUBICSPLINE");
  Scene scene = made.load();
  // Flat tangents: at a quarter the weights are 27/32 and 5/32. The sum (0, 0, 5 s, 27 + 5 s) / 32 with s =
  // sqrt(1/2) turns by twice its angle atan2(5 s, 27 + 5 s).
  const double s = std::sqrt(0.5), angle = 2 * std::atan2(5 * s, 27 + 5 * s);
  expect_near(at(world_at(scene, 0.25), {1, 0, 0}), {std::cos(angle), std::sin(angle), 0}, 1e-7);
}

TEST(AnimationNodes, a_cubic_rotation_through_zero_keeps_the_key_before) {
  GltfBuilder made = GltfBuilder::triangle();
  std::vector<float> values(24, 0.0f);
  values[4 + 3] = 1;
  values[16 + 3] = -1;  // the same rotation, as two opposite quaternions
  animate(made, 0, "rotation", {0, 1}, "VEC4", values, "CUBICSPLINE");
  Scene scene = made.load();
  expect_near(at(world_at(scene, 0.5), {1, 2, 3}), {1, 2, 3});
}

TEST(AnimationNodes, integers_are_normalised_rotations) {
  GltfBuilder made = GltfBuilder::triangle();
  nlohmann::json& sampler = animate(made, 0, "rotation", {0}, "VEC4", {0, 0, 0, 1});
  const int quarter =
      made.accessor(made.view(bytes_of(std::vector<int16_t>{0, 0, 23170, 23170})), "VEC4", i16, 1, true);
  sampler["output"] = quarter;
  Scene scene = made.load();
  expect_near(at(world_at(scene, 1), {1, 0, 0}), {0, 1, 0}, 1e-12);
}

TEST(AnimationNodes, children_follow_their_parents) {
  GltfBuilder made = GltfBuilder::triangle();
  made.root["nodes"] = {{{"mesh", 0}, {"translation", {1, 0, 0}}},
                        {{"children", {0}}, {"scale", {2, 2, 2}}},
                        {{"children", {1}}}};
  made.root["scenes"][0]["nodes"] = {2};
  animate(made, 2, "rotation", {0, 1}, "VEC4", {0, 0, 0, 1, 0, 1, 0, 0});
  animate(made, 1, "translation", {0, 1}, "VEC3", {0, 0, 0, 0, 4, 0});
  animate(made, 0, "scale", {0, 1}, "VEC3", {1, 1, 1, 3, 1, 1});
  Scene scene = made.load();
  // At 1/2: x is stretched by 2, moved by 1, all doubled, lifted by 2, then turned by 90 degrees about y,
  // which takes x to -z.
  const glm::dmat4 world = world_at(scene, 0.5);
  expect_near(at(world, {0, 0, 0}), {0, 2, -2});
  expect_near(at(world, {1, 0, 0}), {0, 2, -6});
  expect_near(at(world, {0, 1, 0}), {0, 4, -2});
}

TEST(AnimationNodes, negative_scales_mirror) {
  GltfBuilder made = GltfBuilder::triangle();
  animate(made, 0, "scale", {0, 1}, "VEC3", {1, 1, 1, -3, 1, 1});
  Scene scene = made.load();
  EXPECT_GT(glm::determinant(world_at(scene, 0.125)), 0);
  EXPECT_LT(glm::determinant(world_at(scene, 0.5)), 0);
  expect_near(at(world_at(scene, 0.5), {1, 1, 1}), {-1, 1, 1});
}

TEST(AnimationNodes, an_instance_scaled_to_a_line_is_a_point_and_comes_back) {
  GltfBuilder made = GltfBuilder::triangle();
  made.node()["translation"] = {5, 6, 7};
  animate(made, 0, "scale", {0, 1, 2}, "VEC3", {1, 1, 1, 0, 1, 0, 1, 1, 1});
  Scene scene = made.load();
  const glm::dmat4 flat = world_at(scene, 1);
  EXPECT_GT(glm::determinant(flat), 0);
  expect_near(at(flat, {1, 1, 0}), {5, 6, 7}, 1e-11);
  expect_near(at(world_at(scene, 2), {1, 1, 0}), {6, 7, 7});
}

TEST(AnimationNodes, an_instance_flat_at_rest_may_grow) {
  GltfBuilder made = GltfBuilder::triangle();
  made.node()["scale"] = {0, 0, 0};
  animate(made, 0, "scale", {0, 1}, "VEC3", {0, 0, 0, 2, 2, 2});
  Scene scene = made.load();
  ASSERT_EQ(scene.instances.size(), 1u);
  expect_near(at(world_at(scene, 0), {1, 1, 0}), {0, 0, 0}, 1e-11);
  expect_near(at(world_at(scene, 0.5), {1, 1, 0}), {1, 1, 0});
}

TEST(AnimationNodes, keys_that_share_a_time_jump_to_the_last_of_them) {
  GltfBuilder made = GltfBuilder::triangle();
  animate(made, 0, "translation", {0, 1, 1, 1, 2}, "VEC3", {0, 0, 0, 1, 0, 0, 5, 5, 5, 8, 0, 0, 9, 0, 0});
  Scene scene = made.load();
  expect_near(position_at(scene, 0.5), {0.5, 0, 0});
  expect_near(position_at(scene, 1), {8, 0, 0});
  expect_near(position_at(scene, 1.5), {8.5, 0, 0});
}

TEST(AnimationNodes, one_key_holds_at_all_times) {
  GltfBuilder made = GltfBuilder::triangle();
  animate(made, 0, "translation", {2}, "VEC3", {1, 2, 3});
  Scene scene = made.load();
  for (const double seconds : {-1.0, 0.5, 2.0, 9.0}) expect_near(position_at(scene, seconds), {1, 2, 3});
}

TEST(AnimationNodes, all_animations_play_at_once_the_later_over_the_earlier) {
  GltfBuilder made = GltfBuilder::triangle();
  animate(made, 0, "translation", {0, 2}, "VEC3", {0, 0, 0, 2, 0, 0}, "LINEAR", 0);
  animate(made, 0, "scale", {0, 1}, "VEC3", {1, 1, 1, 3, 3, 3}, "LINEAR", 0);
  animate(made, 0, "translation", {0, 4}, "VEC3", {0, 0, 0, 0, 8, 0}, "LINEAR", 1);
  made.root["animations"][1]["name"] = "up";
  Scene scene = made.load();
  EXPECT_EQ(animation_count(scene), 2);
  EXPECT_EQ(duration_of(scene), 4);
  EXPECT_EQ(duration_of(scene, 0), 2);
  EXPECT_EQ(duration_of(scene, 1), 4);
  expect_near(at(world_at(scene, 1), {1, 0, 0}), {3, 2, 0});
  expect_near(at(world_at(scene, 1, 0), {1, 0, 0}), {4, 0, 0});
  expect_near(at(world_at(scene, 1, 1), {1, 0, 0}), {1, 2, 0});
}

TEST(AnimationNodes, looped_times_end_with_the_last_key) {
  const Scene scene = moving("LINEAR");  // keys up to 3 s
  EXPECT_EQ(looped_time(scene, 0), 0);
  EXPECT_EQ(looped_time(scene, 2.5), 2.5);
  EXPECT_EQ(looped_time(scene, 3), 3);
  EXPECT_EQ(looped_time(scene, 3.5), 0.5);
  EXPECT_EQ(looped_time(scene, 6), 3);
  EXPECT_EQ(looped_time(scene, 7), 1);
  EXPECT_EQ(looped_time(GltfBuilder::triangle().load(), 7), 7) << "nothing repeats";
}

TEST(AnimationNodes, changes_name_what_moved_and_nothing_else) {
  GltfBuilder made = GltfBuilder::triangle();
  made.root["nodes"] = {{{"mesh", 0}}, {{"mesh", 0}}, {{"mesh", 0}}, {{"children", {2}}}};
  made.root["scenes"][0]["nodes"] = {0, 1, 3};
  animate(made, 1, "translation", {1, 2}, "VEC3", {0, 0, 0, 1, 0, 0});
  animate(made, 3, "scale", {1, 3}, "VEC3", {1, 1, 1, 2, 2, 2});
  Scene scene = made.load();
  EXPECT_TRUE(set_time(scene, std::nullopt).empty());
  EXPECT_TRUE(set_time(scene, 1).empty()) << "the first keys are the rest pose";
  EXPECT_EQ(set_time(scene, 2).instances, (Ints{1, 2}));
  const SceneChanges changes = set_time(scene, 3);
  EXPECT_EQ(changes.instances, Ints{2});
  EXPECT_TRUE(changes.lights.empty() && changes.cameras.empty() && changes.meshes.empty());
  EXPECT_TRUE(set_time(scene, 3).empty());
  EXPECT_EQ(set_time(scene, std::nullopt).instances, (Ints{1, 2}));
}

TEST(AnimationNodes, time_0_is_a_time_of_the_animation_and_not_the_rest_pose) {
  Scene scene = moving("LINEAR");
  const glm::dmat4 at_rest = scene.instances[0].world_from_object;
  expect_near(glm::dvec3(at_rest[3]), {-1, -1, -1});
  EXPECT_EQ(set_time(scene, 0).instances, Ints{0});
  expect_near(glm::dvec3(scene.instances[0].world_from_object[3]), {2, 0, 0});
  EXPECT_TRUE(set_time(scene, -0.0).empty());
  EXPECT_TRUE(set_time(scene, 1e-6).empty());
  EXPECT_EQ(set_time(scene, std::nullopt).instances, Ints{0});
  EXPECT_EQ(scene.instances[0].world_from_object, at_rest);
}

TEST(AnimationNodes, a_pose_depends_on_its_time_alone) {
  Scene scene = moving("LINEAR");
  const glm::dmat4 at_two = world_at(scene, 2);
  for (const double seconds : {3.0, 0.0, 1.25, -4.0, 2.5}) world_at(scene, seconds);
  EXPECT_EQ(world_at(scene, 2), at_two);
}

TEST(AnimationNodes, a_copy_of_a_scene_moves_by_itself) {
  Scene scene = moving("LINEAR");
  Scene copy = scene;
  position_at(copy, 3);
  expect_near(glm::dvec3(scene.instances[0].world_from_object[3]), {-1, -1, -1});
  expect_near(glm::dvec3(copy.instances[0].world_from_object[3]), {6, 8, -4});
}

TEST(AnimationNodes, a_scene_without_animations_has_no_rig_and_stays) {
  Scene scene = GltfBuilder::triangle().load();
  EXPECT_EQ(scene.rig, nullptr);
  EXPECT_TRUE(set_time(scene, 5).empty());
  EXPECT_EQ(duration_of(scene), 0);
  EXPECT_EQ(animation_count(scene), 0);
}

std::string refusal_at(Scene& scene, double seconds, int animation) {
  try {
    set_time(scene, seconds, animation);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    const std::string what = error.what();
    return what.substr(std::min(what.size(), what.find("made.gltf")));
  }
  ADD_FAILURE() << "is posed, but must not be";
  return {};
}

TEST(AnimationNodes, times_and_animations_that_do_not_exist_are_refused) {
  Scene scene = moving("LINEAR");
  EXPECT_EQ(refusal_at(scene, 1, 1), "made.gltf: animation 1 was requested, but there are 1");
  EXPECT_EQ(refusal_at(scene, 1, -2), "made.gltf: animation -2 was requested, but there are 1");
  EXPECT_THAT([&] { set_time(scene, std::nan("")); },
              testing::ThrowsMessage<Error>("made: time nan is not a finite number of seconds"));
  EXPECT_THROW(duration_of(scene, 1), Error);
}

TEST(AnimationNodes, a_pose_that_is_not_finite_is_refused_and_the_next_is_whole) {
  GltfBuilder made = GltfBuilder::triangle();
  made.root["nodes"] = {{{"children", {1}}}, {{"mesh", 0}, {"name", "far"}}};
  for (int i = 0; i < 10; ++i) {
    made.root["nodes"][1 + i]["children"] = {2 + i};
    made.root["nodes"].push_back({{"mesh", 0}});
    animate(made, 1 + i, "scale", {0, 1}, "VEC3", {1, 1, 1, 3e38f, 1, 1});
  }
  Scene scene = made.load();
  EXPECT_THAT(refusal_at(scene, 1, -1),
              testing::HasSubstr("made.gltf: node 9: its world matrix at 1 s is not finite"));
  EXPECT_TRUE(set_time(scene, 0).empty());
}

}  // namespace
}  // namespace lightgrid
