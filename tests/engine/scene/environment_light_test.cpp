// Light from surroundings: files, and moments and tables against integrals in double.
#include "scene/environment_light.h"

#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <numbers>
#include <tuple>

#include "base/image.h"
#include "scene/random.h"
#include "shared/light_moments.h"
#include "support/error_of.h"
#include "support/temp_folder.h"

namespace lightgrid {
namespace {

using glm::dvec3;
constexpr double environment_pi = std::numbers::pi;
using testing::HasSubstr;

RadianceMap constant(const glm::vec3& radiance) { return {"constant", 1, 1, {radiance}}; }

RadianceMap one_texel(int width, int height, int column, int row, const glm::vec3& radiance) {
  RadianceMap map{"one texel", width, height, std::vector<glm::vec3>(size_t(width) * height, glm::vec3(0))};
  map.texels[size_t(row) * width + column] = radiance;
  return map;
}

// Blue above, dark below, and a window of 20 by 20 degrees that is 30 times as bright.
RadianceMap with_window() {
  RadianceMap map{"window", 360, 180, {}};
  for (int row = 0; row < 180; ++row) {
    for (int column = 0; column < 360; ++column) {
      const bool window = row >= 50 && row < 70 && column >= 200 && column < 220;
      map.texels.push_back(window     ? glm::vec3(30, 27, 24)
                           : row < 90 ? glm::vec3(0.5f, 0.7f, 1)
                                      : glm::vec3(0.2f, 0.15f, 0.1f));
    }
  }
  return map;
}

dvec3 sky_zenith(0.2, 0.4, 0.9), sky_horizon(0.8, 0.9, 1), sky_ground(0.12, 0.1, 0.08);

double irradiance(const Environment& environment, int color, const dvec3& n) {
  const auto& m = environment.moments[size_t(color)];
  return 3.0 / 32 * (m[3] + m[4] + m[5]) + 0.5 * (n.x * m[0] + n.y * m[1] + n.z * m[2]) +
         15.0 / 32 *
             (n.x * n.x * m[3] + n.y * n.y * m[4] + n.z * n.z * m[5] +
              2 * (n.x * n.y * m[6] + n.x * n.z * m[7] + n.y * n.z * m[8]));
}

// Over 720 by 360 parts of the sphere.
double integral(const RadianceMap& map, int color, const std::function<double(const dvec3&)>& weight) {
  double sum = 0;
  for (int row = 0; row < 360; ++row) {
    const double polar = environment_pi * (row + 0.5) / 360,
                 solid_angle = std::sin(polar) * (environment_pi / 360) * (2 * environment_pi / 720);
    for (int column = 0; column < 720; ++column) {
      const double around = 2 * environment_pi * (column + 0.5) / 720 - environment_pi;
      const dvec3 l(std::sin(polar) * std::cos(around), std::cos(polar), std::sin(polar) * std::sin(around));
      sum += solid_angle * radiance_at(map, l)[color] * weight(l);
    }
  }
  return sum;
}

TEST(Environment, ConstantRadianceArrivesFromAllSides) {
  const auto environment = make_environment(constant({2, 1, 0.5f}));
  Random random(3);
  for (int i = 0; i < 100; ++i) {
    const dvec3 d = any_direction(random);
    const dvec3 received = lobe_radiance(*environment, d, random.uniform());
    for (int c = 0; c < 3; ++c) {
      const double radiance = c == 0 ? 2 : c == 1 ? 1 : 0.5;
      EXPECT_NEAR(received[c], radiance, 1e-12);
      EXPECT_NEAR(irradiance(*environment, c, d), environment_pi * radiance, 1e-5);
    }
  }
}

// Between the middles of texels it is interpolated, so it is within the change from one texel to the next.
TEST(Environment, TheBackgroundIsTheMap) {
  const RadianceMap sky = sky_gradient(sky_zenith, sky_horizon, sky_ground);
  RadianceMap wide{"wide", 1024, 512, {}}, wider{"wider", 8192, 16, {}};
  for (RadianceMap* map : {&wide, &wider}) {
    for (int row = 0; row < map->height; ++row) {
      for (int column = 0; column < map->width; ++column)
        map->texels.push_back(glm::vec3(2.0 + direction_of_texel(*map, column, row)));
    }
  }
  Random random(4);
  for (const auto& [map, cells, within] :
       {std::tuple{&sky, 1024, 0.04}, {&wide, 512, 0.02}, {&wider, 2048, 0.3}}) {
    const auto environment = make_environment(*map);
    EXPECT_EQ(environment->tables.back().cells, cells);
    double largest = 0;
    for (int i = 0; i < 2000; ++i) {
      const dvec3 d = any_direction(random);
      const dvec3 apart = glm::abs(background_radiance(*environment, d) - radiance_at(*map, d));
      largest = std::max({largest, apart.r, apart.g, apart.b});
    }
    EXPECT_LT(largest, within) << map->name;
    EXPECT_GT(largest, 0) << map->name;
  }
}

TEST(Environment, OneTexelKeepsItsPlaceAndItsEnergy) {
  // Near the seam, and at both poles.
  for (const auto& [width, column, row] : {std::tuple{64, 0, 10}, {64, 63, 10}, {4, 1, 0}, {4, 2, 31}}) {
    const auto environment = make_environment(one_texel(width, 32, column, row, glm::vec3(1000)));
    const double solid_angle =
        (std::cos(environment_pi * row / 32) - std::cos(environment_pi * (row + 1) / 32)) * 2 *
        environment_pi / width;
    const auto& m = environment->moments[1];
    EXPECT_NEAR(m[3] + m[4] + m[5], 1000 * solid_angle, 1e-6 * 1000 * solid_angle);
    const double polar = environment_pi * (row + 0.5) / 32,
                 around = 2 * environment_pi * (column + 0.5) / width - environment_pi;
    const dvec3 to_texel(std::sin(polar) * std::cos(around), std::cos(polar),
                         std::sin(polar) * std::sin(around));
    EXPECT_GT(glm::dot(glm::normalize(dvec3(m[0], m[1], m[2])), to_texel), 0.999);
    EXPECT_NEAR(lobe_radiance(*environment, to_texel, 0).g, 1000, 1e-9);
    for (const double roughness : {0.25, 0.5, 1.0}) {
      const double towards = lobe_radiance(*environment, to_texel, roughness).g;
      EXPECT_GT(towards, 10 * lobe_radiance(*environment, -to_texel, roughness).g) << roughness;
      // The lobe of all directions that reflects the texel has the weight of one lobe.
      double sum = 0, all = 0;
      for (int j = 0; j < 90; ++j) {
        const double height = std::cos(environment_pi * (j + 0.5) / 90),
                     radius = std::sqrt(1 - height * height);
        for (int i = 0; i < 180; ++i) {
          const dvec3 d(radius * std::cos(environment_pi * i / 90), height,
                        radius * std::sin(environment_pi * i / 90));
          sum += radius * lobe_radiance(*environment, d, roughness).g;
          all += radius;
        }
      }
      EXPECT_NEAR(sum / all * 4 * environment_pi, 1000 * solid_angle, 0.03 * 1000 * solid_angle) << roughness;
    }
  }
}

TEST(Environment, HasNoSeam) {
  RadianceMap map{"around", 360, 1, {}};
  for (int i = 0; i < 360; ++i)
    map.texels.emplace_back(2 + float(std::cos(2 * environment_pi * (i + 0.5) / 360)));
  const auto environment = make_environment(map);
  for (const double roughness : {0.0, 0.1, 0.3, 0.6, 1.0}) {
    for (const double height : {-0.9, -0.3, 0.0, 0.3, 0.9}) {
      const dvec3 left = glm::normalize(dvec3(-1, height, 1e-9)),
                  right = glm::normalize(dvec3(-1, height, -1e-9));
      EXPECT_NEAR(lobe_radiance(*environment, left, roughness).r,
                  lobe_radiance(*environment, right, roughness).r, 1e-6);
    }
    // Nor where the faces of the octahedron are folded.
    for (const dvec3& d : {dvec3(0.5, -1e-9, 0.5), dvec3(1e-9, -0.5, 0.5), dvec3(0.5, -0.5, 1e-9)}) {
      const dvec3 beyond(d.x < 1e-6 ? -d.x : d.x, d.y > -1e-6 ? -d.y : d.y, d.z < 1e-6 ? -d.z : d.z);
      EXPECT_NEAR(lobe_radiance(*environment, glm::normalize(d), roughness).r,
                  lobe_radiance(*environment, glm::normalize(beyond), roughness).r, 1e-6);
    }
  }
}

TEST(Environment, RoughLobesMixMoreOfTheSphere) {
  const auto environment = make_environment(with_window());
  const dvec3 to_window(std::cos(environment_pi / 3) * 0 + 0.7849, 0.5,
                        0.3660);  // 210 degrees along, 60 down
  double before = 1e9;
  for (int i = 0; i <= 8; ++i) {
    const double received = lobe_radiance(*environment, glm::normalize(to_window), i / 8.0).r;
    EXPECT_LE(received, before * (1 + 1e-9)) << i;
    before = received;
  }
  EXPECT_LT(before, 5);
}

struct EnvironmentFiles : testing::Test {
  TempFolder folder;

  std::string exr(const std::string& name, int column, int row, const glm::vec3& odd) {
    Image image(4, 3);
    for (glm::vec4& pixel : image.pixels) pixel = {1, 2, 3, 1};
    image.at(column, 2 - row) = glm::vec4(odd, 1);
    save_exr(folder.path / name, image);
    return folder.path / name;
  }
  static std::string fault(const std::string& text) {
    return error_of([&] { parse_environment(text); });
  }
};

TEST_F(EnvironmentFiles, FaultyTexelsAreNamed) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  EXPECT_THAT(fault(exr("nan.exr", 3, 1, {1, nan, 1})), HasSubstr("nan.exr: pixel 3,1 has green nan"));
  EXPECT_THAT(fault(exr("inf.exr", 0, 2, {inf, 1, 1})), HasSubstr("inf.exr: pixel 0,2 has red inf"));
  EXPECT_THAT(fault(exr("minus.exr", 2, 0, {1, 1, -0.5f})), HasSubstr("minus.exr: pixel 2,0 has blue -0.5"));
  EXPECT_THAT(fault(exr("huge.exr", 1, 1, {3e38f, 1, 1})), HasSubstr("huge.exr: pixel 1,1 has red"));
}

TEST_F(EnvironmentFiles, FaultyFilesAreNamed) {
  EXPECT_THAT(fault(folder.path / "none.exr"), HasSubstr("none.exr"));
  EXPECT_THAT(fault("picture.png"), HasSubstr("picture.png: radiance is read from .hdr or .exr"));
  for (const char* name : {"text.hdr", "text.exr"}) {
    std::ofstream(folder.path / name) << "#? no picture";
    EXPECT_THAT(fault(folder.path / name), HasSubstr(name));
  }
  EXPECT_THAT(fault("sky:1,2,3"), HasSubstr("nine numbers"));
  EXPECT_THAT(fault("sky:1,2,3,4,5,6,7,8,-9"), HasSubstr("nine numbers"));
  EXPECT_THAT(fault("sky:1,2,3,4,5,6,7,8,9,10"), HasSubstr("nine numbers"));
  EXPECT_EQ(parse_environment("none"), nullptr);
}

TEST_F(EnvironmentFiles, HugeRadianceIsFinite) {
  const auto environment = parse_environment(exr("bright.exr", 1, 1, glm::vec3(9e29f)));
  for (const auto& color : environment->moments) {
    for (const double m : color) EXPECT_TRUE(std::isfinite(float(m)));
  }
  for (const EnvironmentTable& table : environment->tables) {
    for (const dvec3& texel : table.texels) ASSERT_TRUE(std::isfinite(float(texel.r)));
  }
}

TEST_F(EnvironmentFiles, OnePixelOfEachFormatIsRead) {
  std::ofstream(folder.path / "one.hdr", std::ios::binary)
      << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n"
      << std::string{char(128), char(64), char(32), char(129)};
  const RadianceMap hdr = read_radiance_map(folder.path / "one.hdr");
  ASSERT_EQ(hdr.texels.size(), 1u);
  EXPECT_EQ(hdr.texels[0], glm::vec3(1, 0.5f, 0.25f));
  Image image(1, 1);
  image.pixels[0] = {1, 0.5f, 0.25f, 1};
  save_exr(folder.path / "one.exr", image);
  EXPECT_EQ(read_radiance_map(folder.path / "one.exr").texels, hdr.texels);
}

// Rows begin at the top, columns at -x.
TEST_F(EnvironmentFiles, RowsAndColumnsLookWhereTheirTexelsAre) {
  const RadianceMap map = read_radiance_map(exr("place.exr", 3, 0, {9, 9, 9}));
  EXPECT_EQ(radiance_at(map, glm::normalize(dvec3(-0.3, 0.9, 0.2))).r, 9);
  EXPECT_EQ(radiance_at(map, glm::normalize(dvec3(-0.3, 0.9, -0.2))).r, 1);
  EXPECT_EQ(radiance_at(map, glm::normalize(dvec3(-0.3, -0.9, 0.2))).r, 1);
}

// Mean and largest error, relative to the mean.
struct IntegralError {
  double mean = 0, largest = 0;
};

IntegralError error_against(const std::vector<std::pair<double, double>>& is_and_should) {
  IntegralError error;
  double whole = 0;
  for (const auto& [is, should] : is_and_should) {
    whole += should;
    error.mean += std::abs(is - should);
    error.largest = std::max(error.largest, std::abs(is - should));
  }
  return {error.mean / whole, error.largest * double(is_and_should.size()) / whole};
}

// docs/environment.md#errors has these figures.
TEST(EnvironmentErrors, DiffuseLightIsWithinTheSecondOrder) {
  for (const auto& [map, mean] :
       {std::pair{sky_gradient(sky_zenith, sky_horizon, sky_ground), 0.02}, {with_window(), 0.04}}) {
    const auto environment = make_environment(map);
    const double whole = environment->moments[1][3] + environment->moments[1][4] + environment->moments[1][5];
    Random random(5);
    std::vector<std::pair<double, double>> pairs;
    for (int i = 0; i < 40; ++i) {
      const dvec3 n = any_direction(random);
      const double should = integral(map, 1, [&](const dvec3& l) { return std::max(glm::dot(n, l), 0.0); });
      pairs.emplace_back(irradiance(*environment, 1, n), should);
      EXPECT_LT(std::abs(pairs.back().first - should), 3.0 / 32 * whole);
    }
    const IntegralError error = error_against(pairs);
    fmt::print("diffuse {} mean {:.4f} largest {:.4f}\n", map.name, error.mean, error.largest);
    EXPECT_LT(error.mean, mean);
  }
}

// The radiance that a white lobe (f0 and f90 are 1) reflects of the map, over half vectors drawn by its
// distribution: no prefiltering and no fit.
double reflected_by_lobe(const RadianceMap& map, double alpha, const dvec3& n, const dvec3& v) {
  const double a2 = alpha * alpha, n_dot_v = glm::dot(n, v);
  const dvec3 side = glm::normalize(glm::cross(std::abs(n.y) < 0.9 ? dvec3(0, 1, 0) : dvec3(1, 0, 0), n)),
              other = glm::cross(n, side);
  constexpr int steps = 128;
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const double u = (i + 0.5) / steps, cosine = std::sqrt((1 - u) / (1 + (a2 - 1) * u)),
                 sine = std::sqrt(1 - cosine * cosine);
    for (int j = 0; j < steps; ++j) {
      const double angle = 2 * environment_pi * (j + 0.5 * (1 + i % 2)) / steps;
      const dvec3 h = sine * std::cos(angle) * side + sine * std::sin(angle) * other + cosine * n;
      const double v_dot_h = glm::dot(v, h);
      const dvec3 l = 2 * v_dot_h * h - v;
      const double n_dot_l = glm::dot(n, l);
      if (v_dot_h <= 0 || n_dot_l <= 0) continue;
      const auto masking = [&](double x, double y) { return x * std::sqrt(y * y * (1 - a2) + a2); };
      const double visibility = 0.5 / (masking(n_dot_l, n_dot_v) + masking(n_dot_v, n_dot_l));
      sum += 4 * visibility * n_dot_l * v_dot_h / cosine * radiance_at(map, l).g;
    }
  }
  return sum / (steps * steps);
}

TEST(EnvironmentErrors, TheSplitSumIsMeasuredByRoughness) {
  for (const auto& [map, bound] :
       {std::pair{sky_gradient(sky_zenith, sky_horizon, sky_ground), 0.07}, {with_window(), 0.20}}) {
    const auto environment = make_environment(map);
    for (const double roughness : {0.0, 0.1, 0.2, 0.3, 0.5, 0.7, 1.0}) {
      const double alpha = std::pow(std::max(roughness, double(ROUGHNESS_FLOOR)), 2);
      Random random(7);
      std::vector<std::pair<double, double>> pairs;
      for (int i = 0; i < 60; ++i) {
        const dvec3 n = any_direction(random);
        dvec3 v = any_direction(random);
        if (glm::dot(n, v) < 0) v = -v;
        const double n_dot_v = glm::dot(n, v);
        if (n_dot_v < 0.1) continue;
        const Real3 albedo = lobe_albedo({float(alpha), float(alpha * alpha), float(n_dot_v), 0});
        const dvec3 middle = glm::mix(n, 2 * n_dot_v * n - v, 1 - alpha);
        const dvec3 received = lobe_radiance(*environment, glm::normalize(middle), std::sqrt(alpha));
        pairs.emplace_back(double(albedo.x + albedo.y) * received.g, reflected_by_lobe(map, alpha, n, v));
      }
      const IntegralError error = error_against(pairs);
      fmt::print("specular {} roughness {} mean {:.4f} largest {:.4f}\n", map.name, roughness, error.mean,
                 error.largest);
      EXPECT_LT(error.mean, bound) << map.name << " " << roughness;
    }
  }
}

}  // namespace
}  // namespace lightgrid
