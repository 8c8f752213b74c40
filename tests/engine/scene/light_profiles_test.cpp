// Photometric files: what is read, what is refused, and in which direction a light sends it.
#include "scene/light_profiles.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "base/error.h"
#include "base/write_file.h"
#include "scene/animation.h"
#include "scene/lights_file.h"
#include "scene/load_gltf.h"
#include "scene/random.h"
#include "scene/write_gltf.h"
#include "scenes/profile_text.h"
#include "shared/half_angle.h"
#include "support/gltf_builder.h"

namespace lightgrid {
namespace {

using nlohmann::json;
using testing::HasSubstr;

std::string fault_of(const std::string& text) {
  try {
    parse_profile({text.begin(), text.end()});
  } catch (const Error& error) {
    return error.what();
  }
  return "no fault";
}

ProfileText downlight() {
  return {.vertical = {0, 30, 90}, .candela = [](double v, double) {
            return v == 0 ? 200 : v == 30 ? 100 : 0;
          }};
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const size_t at = text.find(from);
  if (at == text.npos) return "nothing to replace";
  return text.replace(at, from.size(), to);
}

TEST(ProfileFiles, AreInterpolatedInBothAngles) {
  ProfileText file = downlight();
  file.multiplier = 2;
  file.ballast = 1.5;
  const FileTable table = parse_profile(file.bytes());
  EXPECT_EQ(largest_candela(table), 600);
  EXPECT_EQ(profile_share(table, 0, 0), 1);
  EXPECT_DOUBLE_EQ(profile_share(table, 15, 77), 0.75);
  EXPECT_DOUBLE_EQ(profile_share(table, 60, -20), 0.25);
  EXPECT_EQ(profile_share(table, 90.001, 0), 0) << "outside of the file's angles";

  const FileTable turned = parse_profile(ProfileText{
      .vertical = {0, 180}, .horizontal = {0, 90, 180, 270, 360}, .candela = [](double, double h) {
        return h == 90 ? 4.0 : h == 180 ? 2.0 : 0.0;
      }}.bytes());
  EXPECT_DOUBLE_EQ(profile_share(turned, 50, 45), 0.5);
  EXPECT_DOUBLE_EQ(profile_share(turned, 50, 135), 0.75);
  EXPECT_DOUBLE_EQ(profile_share(turned, 50, -135), 0.25) << "225 degrees";
  EXPECT_DOUBLE_EQ(profile_share(turned, 50, 359.999), 0);
}

struct Symmetry {
  double first, last;
  double (*same)(double azimuth);  // the azimuth in the file
};

TEST(ProfileFiles, OfEverySymmetryFillTheTurn) {
  const Symmetry cases[] = {
      {0, 360, [](double a) { return a; }},
      {0, 180, [](double a) { return a > 180 ? 360 - a : a; }},
      {0, 90,
       [](double a) {
         return a > 180 ? std::abs(270 - a) == 90 ? 0 : a > 270 ? 360 - a : a - 180 : a > 90 ? 180 - a : a;
       }},
      {90, 270, [](double a) { return a < 90    ? 180 - a
                                      : a > 270 ? 540 - a
                                                : a; }}};
  for (const Symmetry& c : cases) {
    const FileTable table = parse_profile(ProfileText{
        .vertical = {0, 90},
        .horizontal = equal_angles(c.first, c.last, 12),
        .candela = [](double, double h) {
          return h + 1;
        }}.bytes());
    for (int azimuth = 1; azimuth < 360; azimuth += 7)
      EXPECT_NEAR(profile_share(table, 40, azimuth) * largest_candela(table), c.same(azimuth) + 1, 1e-4)
          << c.first << " to " << c.last << " at " << azimuth;
  }
}

TEST(ProfileFiles, WithATiltFactorAreReadWithoutIt) {
  ProfileText file = downlight();
  const FileTable plain = parse_profile(file.bytes());
  file.tilt = "TILT=INCLUDE\n1\n3\n0 45 90\n1 0.9\n0.7\n";
  EXPECT_EQ(parse_profile(file.bytes()), plain);
  file.tilt = "TILT=lamp.tlt\r\n";
  EXPECT_EQ(parse_profile(file.bytes()), plain);
}

TEST(ProfileFiles, WithOneAngleShineEverywhere) {
  const FileTable table =
      parse_profile(ProfileText{.vertical = {0}, .candela = [](double, double) { return 70; }}.bytes());
  for (const double polar : {0.0, 1.0, 90.0, 180.0}) EXPECT_EQ(profile_share(table, polar, 200), 1);
  EXPECT_EQ(grid_of(table).shares, (std::vector<float>{1, 1}));
}

TEST(ProfileFiles, WithoutThePlaneThatClosesTheTurnAreClosed) {
  const FileTable table = parse_profile(ProfileText{
      .vertical = {0, 90}, .horizontal = {0, 120, 240}, .candela = [](double, double h) {
        return h == 0 ? 2 : 1;
      }}.bytes());
  EXPECT_DOUBLE_EQ(profile_share(table, 10, 300), 0.75);
}

TEST(ProfileFiles, FaultsNameTheFieldAndItsValue) {
  const std::string good = downlight().text();
  EXPECT_EQ(fault_of(good), "no fault");
  EXPECT_EQ(fault_of("IESNA:LM-63-1995\n1 -1 1\n"), "has no line TILT=, so it is no LM-63 file");
  EXPECT_EQ(fault_of("TILT=NONE"), "ends before the number of lamps");
  EXPECT_EQ(fault_of(good.substr(0, good.find("100"))), "ends before candela value 1 of horizontal angle 0");
  EXPECT_EQ(fault_of(replaced(good, "100", "nan")),
            "candela value 1 of horizontal angle 0 is \"nan\", not a number");
  EXPECT_EQ(fault_of(replaced(good, "100", "-inf")),
            "candela value 1 of horizontal angle 0 is \"-inf\", not a number");
  EXPECT_EQ(fault_of(replaced(good, "100", "-4")),
            "candela value 1 of horizontal angle 0 is -4, not from 0 to 3.40282e+38");
  EXPECT_EQ(fault_of(replaced(good, "100", "12O")),
            "candela value 1 of horizontal angle 0 is \"12O\", not a number");
  EXPECT_EQ(fault_of(replaced(good, "0 30 90", "0 90 30")),
            "vertical angle 2 is 30, not above the one before it, 90");
  EXPECT_EQ(fault_of(replaced(good, "0 30 90", "0 0 90")),
            "vertical angle 1 is 0, not above the one before it, 0");
  EXPECT_EQ(fault_of(replaced(good, "0 30 90", "0 30 190")), "vertical angle 2 is 190, not from 0 to 180");
  EXPECT_EQ(fault_of(replaced(good, " 3 1 1 2", " 4000000000 1 1 2")),
            "the number of vertical angles is 4e+09, not from 1 to 4096");
  EXPECT_EQ(fault_of(replaced(good, " 3 1 1 2", " 2.5 1 1 2")),
            "the number of vertical angles is 2.5, not a whole number");
  EXPECT_EQ(fault_of(replaced(good, " 3 1 1 2", " 4096 4096 1 2")),
            "4096 vertical and 4096 horizontal angles give 16777216 values; at most 1048576 are read");
  EXPECT_EQ(fault_of(replaced(good, " 3 1 1 2", " 3 1 4 2")), "the photometric type is 4, not from 1 to 3");
  EXPECT_THAT(fault_of(replaced(good, " 3 1 1 2", " 3 1 2 2")), HasSubstr("types A and B have 0 to 90"));
  ProfileText part = downlight();
  part.horizontal = {0, 45};
  EXPECT_THAT(fault_of(part.text()), HasSubstr("horizontal angles go from 0 to 45"));
  ProfileText bright = downlight();
  bright.multiplier = 3e38;
  EXPECT_EQ(fault_of(bright.text()), "candela values go up to 6e+40, past the largest float");
  ProfileText irregular{.vertical = {0, 1.00003, 31.4159, 90},
                        .horizontal = {0, 0.0301, 77.77123, 360},
                        .candela = [](double, double) { return 1; }};
  EXPECT_THAT(fault_of(irregular.text()), HasSubstr("round the angles"));
}

// A grid of equal steps is the same function.
TEST(ProfileGrids, HaveTheSharesOfTheFilesAngles) {
  Random random(3);
  const ProfileText files[] = {
      {.vertical = {0, 2.5, 5, 40, 90}, .candela = [](double v, double) { return 1 + v; }},
      {.vertical = {0, 13.37, 61.03, 90}, .candela = [](double v, double) { return 2 + std::cos(v); }},
      {.vertical = equal_angles(90, 180, 7),
       .horizontal = {0, 22.5, 30, 90},
       .candela = [](double v, double h) { return 1 + std::sin(v * h); }},
      {.vertical = equal_angles(0, 180, 36),
       .horizontal = equal_angles(90, 270, 36),
       .candela = [](double v, double h) { return 2 + std::sin(v) * std::cos(h); }},
      {.vertical = {-90, -20, 0, 20, 90},
       .horizontal = {0, 5, 90},
       .candela = [](double v, double h) { return 300 + v - h; },
       .type = 2}};
  for (const ProfileText& file : files) {
    const FileTable table = parse_profile(file.bytes());
    const ProfileGrid grid = grid_of(table);
    ASSERT_FALSE(grid.shares.empty());
    double worst = 0;
    for (int i = 0; i < 2000; ++i) {
      const double turn = random.uniform(0, 360),
                   polar = grid.first_rad + (grid.last_rad - grid.first_rad) * random.uniform();
      if (grid.front && std::cos(turn * std::numbers::pi / 180) < 0.01) continue;
      const double down = (polar - grid.first_rad) / (grid.last_rad - grid.first_rad) * grid.rows,
                   around = turn / 360 * grid.columns;
      const size_t row = std::min(size_t(down), size_t(grid.rows - 1)), column = size_t(around);
      const auto at = [&](size_t c, size_t r) { return double(grid.shares[c * (grid.rows + 1) + r]); };
      const double here = std::lerp(at(column, row), at(column, row + 1), down - double(row));
      const double share =
          grid.columns == 0
              ? here
              : std::lerp(here, std::lerp(at(column + 1, row), at(column + 1, row + 1), down - double(row)),
                          around - double(column));
      worst = std::max(worst, std::abs(share - profile_share(table, polar * 180 / std::numbers::pi, turn)));
    }
    EXPECT_LT(worst, 2e-6);
  }
}

TEST(ProfileAngles, HaveARelativeErrorOf3e7) {
  double worst = 0;
  for (int i = 1; i <= 1'000'000; ++i) {
    const float t = float(i) * 1e-6f;
    worst = std::max(worst, std::abs(double(twice_atan(t)) / (2 * std::atan(double(t))) - 1));
  }
  EXPECT_LT(worst, 3e-7);
  EXPECT_GT(worst, 1e-8);
  for (const float degrees : {0.0f, 1e-3f, 30.0f, 89.9f, 90.1f, 179.999f}) {
    const double angle = degrees * std::numbers::pi / 180;
    EXPECT_NEAR(angle_from(float(std::cos(angle)), float(std::sin(angle)), 1), angle, 4e-7);
  }
}

// A beam of one direction. Returns the direction in which it is brightest, in the world.
glm::dvec3 beam_of(const Light& light) {
  const FileTable& table = *light_profile.of(light);
  const ProfileAxes axes = profile_axes(table, axes_of(light));
  glm::dvec3 best{0};
  double most = -1;
  for (int polar = 0; polar <= 180; polar += 5) {
    for (int azimuth = -180; azimuth < 180; azimuth += 5) {
      const double share = profile_share(table, polar, azimuth);
      if (share <= most) continue;
      most = share;
      const double p = polar * std::numbers::pi / 180, a = azimuth * std::numbers::pi / 180;
      best = std::cos(p) * axes.pole + std::sin(p) * (std::cos(a) * axes.first + std::sin(a) * axes.second);
    }
  }
  return best;
}

ProfileText beam(int type, double vertical, double horizontal) {
  const bool half = type != 1;
  return {.vertical = half ? equal_angles(-90, 90, 36) : equal_angles(0, 180, 36),
          .horizontal = half ? equal_angles(-90, 90, 36) : equal_angles(0, 360, 72),
          .candela = [=](double v, double h) { return v == vertical && h == horizontal ? 9 : 0; },
          .type = type};
}

void expect_beam(const Light& light, const glm::dvec3& expected) {
  const glm::dvec3 is = beam_of(light);
  EXPECT_LT(glm::length(is - glm::normalize(expected)), 1e-6) << is.x << " " << is.y << " " << is.z;
}

// EXT_lights_ies: (0, 0) is -z, vertical angles grow towards +x; horizontal ones of type C turn about +z from
// +x to +y, those of types A and B clockwise.
TEST(ProfileAxesOf, ALightWithoutRotation) {
  Light light;
  const auto with = [&](int type, double v, double h) {
    light_profile.set(light, beam(type, v, h).table());
    return light;
  };
  const double c = std::cos(std::numbers::pi / 6), s = 0.5;
  for (const int type : {1, 2, 3}) expect_beam(with(type, 0, 0), {0, 0, -1});
  for (const int type : {1, 2, 3}) expect_beam(with(type, 30, 0), {s, 0, -c});
  expect_beam(with(1, 90, 90), {0, 1, 0});
  expect_beam(with(1, 180, 0), {0, 0, 1});
  for (const int type : {2, 3}) expect_beam(with(type, 0, 30), {0, -s, -c});
  // Type B turns about y, the horizontal angle is a latitude; type A the other way round.
  expect_beam(with(2, 90, 30), {c, -s, 0});
  expect_beam(with(3, 30, 90), {s, -c, 0});
}

TEST(ProfileAxesOf, NodesThatAreShearedMirroredOrTurned) {
  Light light;
  light_profile.set(light, beam(1, 90, 90).table());  // towards the node's +y
  light.direction = {0, 0, -1};
  set_up(light, {0, 2, 5});  // sheared: the part across the direction counts
  expect_beam(light, {0, 1, 0});
  set_up(light, {0, -3, 0});
  expect_beam(light, {0, -1, 0});
  set_up(light, {0, 0, 1});  // along the direction: no part is left
  EXPECT_NEAR(glm::length(axes_of(light).up), 1, 1e-12);
  light.direction = {0, -1, 0};
  set_up(light, {0, 1, 0});
  expect_beam(light, {0, 0, -1});
  set_up(light, glm::dvec3(0));
  expect_beam(light, {0, 0, -1});
}

TEST(ProfileAxesOf, DirectionalLightsAreNotUsed) {
  Light light{.type = LightType::directional};
  light_profile.set(light, downlight().table());
  EXPECT_FALSE(profile_of(light));
}

GltfBuilder with_extension(const json& of_node) {
  GltfBuilder made = GltfBuilder::triangle();
  const std::string text = downlight().text();
  made.root["extensionsUsed"] = {"EXT_lights_ies"};
  made.root["extensions"]["EXT_lights_ies"]["lights"] = {
      {{"uri", "data:application/x-ies-lm-63;base64," + base64(Bytes(text.begin(), text.end()))}}};
  made.node()["extensions"]["EXT_lights_ies"] = of_node;
  return made;
}

TEST(ProfilesInGltf, AreThePointLightsOfTheExtension) {
  GltfBuilder made = with_extension({{"light", 0}, {"multiplier", 0.5}, {"color", {1, 0.25, 3}}});
  made.node()["matrix"] = {1, 0, 0, 0, 0, 0, -2, 0, 0, 3, 0, 0, 4, 5, 6, 1};  // x, then y to -z, z to y
  const Light light = made.load().lights.at(0);
  EXPECT_EQ(light.type, LightType::point);
  EXPECT_EQ(light.position, glm::dvec3(4, 5, 6));
  EXPECT_EQ(light.intensity, 100) << "the largest of 200 candela, times the multiplier";
  EXPECT_EQ(light.color, glm::vec3(1, 0.25, 1));
  EXPECT_EQ(light.radius_m, std::numeric_limits<float>::infinity());
  EXPECT_EQ(light.direction, glm::vec3(0, -1, 0));
  const LightAxes axes = axes_of(light);
  EXPECT_EQ(axes.up, glm::dvec3(0, 0, -1));
  EXPECT_EQ(axes.right, glm::dvec3(1, 0, 0));
  ASSERT_TRUE(profile_of(light));

  // And back: as extras of a punctual light.
  Scene scene;
  scene.lights = {light};
  const std::vector<uint8_t> glb = glb_of(scene);
  TempFolder folder;
  write_file(folder.path / "again.glb", std::string(glb.begin(), glb.end()));
  const Light again = load_gltf(folder.path / "again.glb").lights.at(0);
  EXPECT_EQ(profile_of(again)->values, profile_of(light)->values);
  EXPECT_EQ(again.intensity, light.intensity);
  EXPECT_EQ(axes_of(again).right, axes.right);
}

TEST(ProfilesInGltf, FaultsNameTheNodeAndTheField) {
  EXPECT_THAT(with_extension({{"light", 7}}).refusal(), HasSubstr("EXT_lights_ies light 7 does not exist"));
  EXPECT_THAT(with_extension({{"multiplier", 1}}).refusal(), HasSubstr("EXT_lights_ies has no light"));
  EXPECT_THAT(with_extension({{"light", 0}, {"color", {1, 2}}}).refusal(),
              HasSubstr("color is not three numbers"));
  GltfBuilder empty = with_extension({{"light", 0}});
  empty.root["extensions"]["EXT_lights_ies"]["lights"] = {{{"name", "none"}}};
  EXPECT_THAT(empty.refusal(), HasSubstr("has neither uri nor bufferView"));
  GltfBuilder broken = with_extension({{"light", 0}});
  broken.root["extensions"]["EXT_lights_ies"]["lights"] = {{{"uri", "data:;base64,eHg="}}};
  EXPECT_THAT(broken.refusal(),
              testing::AllOf(HasSubstr("node 0"), HasSubstr("profile data:;base64,eHg=: has no line TILT=")));
}

TEST(ProfilesInLightsFiles, TurnPointLightsToo) {
  TempFolder folder;
  write_file(folder.path / "lamp.ies", downlight().text());
  const json lights = {
      {{"position", {0, 3, 0}}, {"profile", "lamp.ies"}, {"intensity", 40}},
      {{"position", {0, 3, 0}}, {"profile", "lamp.ies"}, {"direction", {1, 0, 0}}, {"up_axis", {0, 0, 1}}},
      {{"position", {0, 3, 0}}}};
  write_file(folder.path / "lights.json", json({{"lights", lights}}).dump());
  const std::vector<Light> read = load_lights_file(folder.path / "lights.json");
  EXPECT_EQ(read[0].direction, glm::vec3(0, -1, 0)) << "down, unless the file says otherwise";
  EXPECT_EQ(read[0].intensity, 40) << "of the brightest direction";
  EXPECT_EQ(axes_of(read[1]).up, glm::dvec3(0, 0, 1));
  EXPECT_EQ(profile_of(read[0]), profile_of(read[1])) << "one file is read once";
  EXPECT_EQ(read[2], (Light{.position = {0, 3, 0}}));
  write_file(folder.path / "again.json", lights_file_text(read));
  EXPECT_EQ(load_lights_file(folder.path / "again.json"), read);
}

}  // namespace
}  // namespace lightgrid
