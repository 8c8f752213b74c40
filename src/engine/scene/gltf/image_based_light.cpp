#include "scene/gltf/image_based_light.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <numbers>
#include <optional>

#include "base/image.h"
#include "scene/environment_light.h"
#include "scene/gltf/images.h"

namespace lightgrid::gltf {
namespace {

using glm::dvec3;

constexpr const char* extension_name = "EXT_lights_image_based";

std::vector<double> numbers_of(const Document& doc, const tinygltf::Value& list, size_t count,
                               const std::string& place) {
  std::vector<double> numbers;
  for (size_t i = 0; list.IsArray() && i < list.ArrayLen(); ++i) {
    const tinygltf::Value& value = list.Get(int(i));
    numbers.push_back(value.IsNumber() ? value.GetNumberAsDouble() : NAN);
  }
  if (numbers.size() != count || !std::ranges::all_of(numbers, [](double x) { return std::isfinite(x); }))
    throw doc.error("{}: is not {} finite numbers", place, count);
  return numbers;
}

// Spherical harmonics of irradiance, in the order of Ramamoorthi and Hanrahan: 1; y, z, x; xy, yz, 3 z^2 - 1,
// xz, x^2 - y^2. Divided by the factors of the cosine and of the basis they are moments of the radiance.
std::array<double, 9> moments_of(const std::array<double, 9>& c) {
  using std::numbers::pi;
  const double trace = c[0] / pi / 0.28209479177387814, first = 1 / (2 * pi / 3) / 0.4886025119029199,
               second = 4 / pi, across = second / 1.0925484305920792;
  const double zz = (c[6] * second / 0.31539156525252005 + trace) / 3,
               difference = c[8] * second / 0.5462742152960396;
  return {c[3] * first,
          c[1] * first,
          c[2] * first,
          (trace - zz + difference) / 2,
          (trace - zz - difference) / 2,
          zz,
          c[4] * across,
          c[7] * across,
          c[5] * across};
}

// Radiance of order 2 with these moments, at least 0.
double radiance_of(const std::array<double, 9>& m, const dvec3& d) {
  const double trace = m[3] + m[4] + m[5], first = d.x * m[0] + d.y * m[1] + d.z * m[2];
  const double second = d.x * d.x * m[3] + d.y * d.y * m[4] + d.z * d.z * m[5] +
                        2 * (d.x * d.y * m[6] + d.x * d.z * m[7] + d.y * d.z * m[8]);
  return std::max(0.0, (-1.5 * trace + 3 * first + 7.5 * second) / (4 * std::numbers::pi));
}

// Along axes that `turn` maps those of `m` to.
std::array<double, 9> turned(const std::array<double, 9>& m, const glm::dmat3& turn) {
  const dvec3 first = turn * dvec3(m[0], m[1], m[2]);
  const glm::dmat3 second =
      turn * glm::dmat3(m[3], m[6], m[7], m[6], m[4], m[8], m[7], m[8], m[5]) * glm::transpose(turn);
  return {first.x,      first.y,      first.z,      second[0][0], second[1][1],
          second[2][2], second[1][0], second[2][0], second[2][1]};
}

// Faces of a cube map, in the order +x, -x, +y, -y, +z, -z, as OpenGL orients them.
dvec3 radiance_of(const std::array<const Bitmap*, 6>& faces, const dvec3& d) {
  const dvec3 size = glm::abs(d);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const bool minus = d[axis] < 0;
  const dvec3 across[] = {{0, 0, minus ? 1 : -1}, {1, 0, 0}, {minus ? -1 : 1, 0, 0}},
              down[] = {{0, -1, 0}, {0, 0, minus ? -1 : 1}, {0, -1, 0}};
  const Bitmap& face = *faces[size_t(2 * axis + minus)];
  const auto place = [&](const dvec3& along, int pixels) {
    return std::clamp(int((glm::dot(along, d) / size[axis] + 1) / 2 * pixels), 0, pixels - 1);
  };
  const uint8_t* pixel = &face.rgba[4 * (size_t(place(down[axis], face.height)) * size_t(face.width) +
                                         size_t(place(across[axis], face.width)))];
  // RGBD: colours with the sRGB curve, over alpha. Opaque images have an alpha of 1.
  dvec3 radiance;
  for (int c = 0; c < 3; ++c)
    radiance[c] = double(linear_from_srgb(float(pixel[c]) / 255)) * 255 / std::max<int>(pixel[3], 1);
  return radiance;
}

// The six faces of the first level of specularImages. Images without a fault are returned in `decoded`.
std::optional<std::array<const Bitmap*, 6>> read_faces(Document& doc, const tinygltf::Value& light,
                                                       const std::string& place, ImageSet& decoded) {
  const tinygltf::Value& levels = light.Get("specularImages");
  if (!levels.IsArray() || levels.ArrayLen() == 0) return {};
  std::vector<ImageUse> uses;
  for (const double image : numbers_of(doc, levels.Get(0), 6, place + ": specularImages[0]")) {
    checked(doc, doc.images, int(image), place, "specularImages[0]");
    uses.push_back({int(image), true});
  }
  decoded = fetch_images(doc, uses);
  std::array<const Bitmap*, 6> faces{};
  for (size_t i = 0; i < 6; ++i) {
    const DecodedImage& image = decoded.images[decoded.bitmap_of_use[i]];
    if (image.fault) {
      doc.warn("broken image", "{}", image.fault->what());
      return {};
    }
    faces[i] = &image.bitmap;
  }
  return faces;
}

RadianceMoments read_moments(const Document& doc, const tinygltf::Value& light, const std::string& place) {
  const tinygltf::Value& rows = light.Get("irradianceCoefficients");
  if (!rows.IsArray() || rows.ArrayLen() != 9)
    throw doc.error("{}: irradianceCoefficients are not nine of three numbers", place);
  RadianceMoments coefficients{};
  for (int row = 0; row < 9; ++row) {
    const std::vector<double> colors =
        numbers_of(doc, rows.Get(row), 3, fmt::format("{}: irradianceCoefficients[{}]", place, row));
    for (size_t c = 0; c < 3; ++c) coefficients[c][size_t(row)] = colors[c];
  }
  for (auto& color : coefficients) color = moments_of(color);
  return coefficients;
}

glm::dmat3 read_rotation(const Document& doc, const tinygltf::Value& light, const std::string& place) {
  if (!light.Has("rotation")) return glm::dmat3(1);
  const std::vector<double> q = numbers_of(doc, light.Get("rotation"), 4, place + ": rotation");
  const glm::dquat turn(q[3], q[0], q[1], q[2]);
  if (!(glm::length(turn) > 1e-12)) throw doc.error("{}: rotation has a length of 0", place);
  return glm::mat3_cast(glm::normalize(turn));
}

}  // namespace

std::shared_ptr<const Environment> read_image_based_light(Document& doc, int scene) {
  if (scene < 0) return nullptr;
  const tinygltf::Value* of_scene =
      find_extension(doc.model.scenes[size_t(scene)].extensions, extension_name);
  const tinygltf::Value* of_file = find_extension(doc.model.extensions, extension_name);
  if (!of_scene || !of_file) return nullptr;
  const tinygltf::Value& lights = of_file->Get("lights");
  const size_t index = size_or(doc, *of_scene, "light", 0, fmt::format("scene {}", scene));
  if (!lights.IsArray() || index >= lights.ArrayLen())
    throw doc.error("scene {}: {}.light is {}, but there are {}", scene, extension_name, index,
                    lights.IsArray() ? lights.ArrayLen() : 0);
  const tinygltf::Value& light = lights.Get(int(index));
  const std::string place = fmt::format("{} light {}", extension_name, index);
  const double intensity = number_or(doc, light, "intensity", 1, place);
  if (!(intensity >= 0)) throw doc.error("{}: intensity is {}", place, intensity);
  const glm::dmat3 turn = read_rotation(doc, light, place);
  RadianceMoments moments = read_moments(doc, light, place);
  ImageSet decoded;
  const auto faces = read_faces(doc, light, place, decoded);
  if (!faces)
    doc.warn("specular images", "{}: reflections show its irradianceCoefficients, without specularImages",
             place);
  RadianceMap map{doc.place(place), 512, 256, {}};
  for (int row = 0; row < map.height; ++row) {
    for (int column = 0; column < map.width; ++column) {
      const dvec3 d = glm::transpose(turn) * direction_of_texel(map, column, row);
      dvec3 radiance =
          faces ? radiance_of(*faces, d)
                : dvec3(radiance_of(moments[0], d), radiance_of(moments[1], d), radiance_of(moments[2], d));
      map.texels.emplace_back(intensity * radiance);
    }
  }
  for (auto& color : moments) {
    color = turned(color, turn);
    for (double& m : color) m *= intensity;
  }
  return make_environment(map, &moments);
}

}  // namespace lightgrid::gltf
