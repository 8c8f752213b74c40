#include "scene/environment_light.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <optional>

#include "base/error.h"
#include "base/exr_picture.h"
#include "base/parallel.h"
#include "base/text.h"
#include "scene/radiance_tree.h"
#include "shared/effects/environment_light.h"

namespace lightgrid {
namespace {

using glm::dvec3;
using std::numbers::pi;

// Parts along each side of a texel. Parts are small next to the finest cells of the tree.
constexpr int min_columns = 2400, min_rows = 1200;
int parts_of(int texels, int least) { return std::max(1, (least + texels - 1) / texels); }

// Calls add(direction, solid angle, radiance) for the parts of all texels.
void for_each_part(const RadianceMap& map, const auto& add) {
  const int columns = map.width * parts_of(map.width, min_columns),
            rows = map.height * parts_of(map.height, min_rows);
  std::vector<dvec3> around;
  for (int i = 0; i < columns; ++i) {
    const double longitude = 2 * pi * (i + 0.5) / columns - pi;
    around.emplace_back(std::cos(longitude), 0, std::sin(longitude));
  }
  for (int row = 0; row < rows; ++row) {
    const double top = std::cos(pi * row / rows), bottom = std::cos(pi * (row + 1) / rows);
    const double height = 0.5 * (top + bottom), radius = std::sqrt(1 - height * height);
    const double solid_angle = 2 * pi * (top - bottom) / columns;
    const glm::vec3* texels = &map.texels[size_t(row / (rows / map.height)) * map.width];
    for (int column = 0; column < columns; ++column)
      add(radius * around[size_t(column)] + dvec3(0, height, 0), solid_angle,
          dvec3(texels[column / (columns / map.width)]));
  }
}

// A direction's place in the square of a table, from 0 to 1.
glm::dvec2 place_of(const dvec3& d) {
  const dvec3 on_faces = d / (std::abs(d.x) + std::abs(d.y) + std::abs(d.z));
  glm::dvec2 place(on_faces.x, on_faces.z);
  if (d.y < 0)
    place = {std::copysign(1 - std::abs(on_faces.z), on_faces.x),
             std::copysign(1 - std::abs(on_faces.x), on_faces.z)};
  return 0.5 * place + 0.5;
}

dvec3 direction_of(const glm::dvec2& place) {
  const glm::dvec2 p = 2.0 * place - 1.0;
  const double height = 1 - std::abs(p.x) - std::abs(p.y);
  glm::dvec2 side = p;
  if (height < 0) side = {std::copysign(1 - std::abs(p.y), p.x), std::copysign(1 - std::abs(p.x), p.y)};
  return glm::normalize(dvec3(side.x, height, side.y));
}

// Tables of smooth lobes have more cells.
constexpr int cells_of[] = {256, 128, 64, 64, 32, 32, 32, 16, 16};
static_assert(std::size(cells_of) == size_t(ENVIRONMENT_STEPS) + 1);
constexpr int tree_cells = 512;  // along a side of its finest level

EnvironmentTable table_of(const RadianceTree& tree, int step) {
  EnvironmentTable table{cells_of[step], {}};
  const int side = table.cells + 1;
  table.texels.resize(size_t(side) * side);
  const double roughness = std::max(step / double(ENVIRONMENT_STEPS), double(ROUGHNESS_FLOOR));
  parallel_for(side, [&](int row) {
    for (int column = 0; column < side; ++column) {
      const dvec3 d = direction_of(glm::dvec2(column, row) / double(table.cells));
      table.texels[size_t(row) * side + column] =
          step == 0 ? tree.mean_around(column * (tree_cells / table.cells), row * (tree_cells / table.cells))
                    : tree.received(d, roughness * roughness);
    }
  });
  return table;
}

// The map, interpolated between the middles of texels.
dvec3 smooth_radiance(const RadianceMap& map, const dvec3& d) {
  const double across = (0.5 + std::atan2(d.z, d.x) / (2 * pi)) * map.width - 0.5,
               down = std::acos(std::clamp(d.y, -1.0, 1.0)) / pi * map.height - 0.5;
  const double left = std::floor(across), top = std::floor(down);
  const auto texel = [&](double column, double row) {
    const int x = (int(column) + map.width) % map.width, y = std::clamp(int(row), 0, map.height - 1);
    return dvec3(map.texels[size_t(y) * map.width + x]);
  };
  return glm::mix(glm::mix(texel(left, top), texel(left + 1, top), across - left),
                  glm::mix(texel(left, top + 1), texel(left + 1, top + 1), across - left), down - top);
}

// As fine as the map, up to 0.1 degrees a cell. If the map is finer, texels are means over their cells.
EnvironmentTable background_of(const RadianceMap& map) {
  const int texels_around = std::max(map.width, 2 * map.height);
  EnvironmentTable table{std::clamp(int(std::bit_floor(unsigned(texels_around / 2))), 256, 2048), {}};
  const int side = table.cells + 1, parts = (texels_around / 2 + table.cells - 1) / table.cells;
  table.texels.resize(size_t(side) * side);
  parallel_for(side, [&](int row) {
    for (int column = 0; column < side; ++column) {
      dvec3 sum(0);
      for (int part = 0; part < parts * parts; ++part) {
        const glm::dvec2 aside = (glm::dvec2(part % parts, part / parts) + 0.5) / double(parts) - 0.5;
        const glm::dvec2 place = (glm::dvec2(column, row) + aside) / double(table.cells);
        sum += smooth_radiance(map, direction_of(glm::clamp(place, 0.0, 1.0)));
      }
      table.texels[size_t(row) * side + column] = sum / double(parts * parts);
    }
  });
  return table;
}

std::optional<std::array<dvec3, 3>> parse_sky(const std::string& text) {
  std::array<dvec3, 3> colors;
  size_t begin = 0;
  for (int i = 0; i < 9; ++i) {
    const size_t end = text.find(',', begin);
    if ((end == text.npos) != (i == 8)) return {};
    const auto number = parse_number<double>(text.substr(begin, end - begin));
    if (!number || !(*number >= 0) || !(*number <= max_radiance)) return {};
    colors[size_t(i / 3)][i % 3] = *number;
    begin = end + 1;
  }
  return colors;
}

}  // namespace

RadianceMap read_radiance_map(const std::filesystem::path& path) {
  const Image image = load_radiance_picture(path);
  RadianceMap map{path.string(), image.width, image.height, {}};
  map.texels.reserve(image.pixels.size());
  for (int row = 0; row < image.height; ++row) {
    for (int column = 0; column < image.width; ++column) {
      const glm::vec3 texel(image.at(column, image.height - 1 - row));
      for (int c = 0; c < 3; ++c) {
        if (!(texel[c] >= 0) || !(texel[c] <= max_radiance))
          throw input_error("{}: pixel {},{} has {} {}: a radiance is from 0 to {:g}", path.string(), column,
                            row, std::array{"red", "green", "blue"}[size_t(c)], texel[c], max_radiance);
      }
      map.texels.push_back(texel);
    }
  }
  return map;
}

RadianceMap sky_gradient(const dvec3& zenith, const dvec3& horizon, const dvec3& ground) {
  RadianceMap map{"sky", 1, 1024, {}};
  for (int row = 0; row < map.height; ++row) {
    const double height = std::cos(pi * (row + 0.5) / map.height);
    // The ground fades in below the horizon, so that no edge is mirrored.
    const double up = std::sqrt(std::max(height, 0.0)), down = std::min(1.0, std::max(-height, 0.0) * 4);
    map.texels.push_back(height > 0 ? glm::mix(horizon, zenith, up) : glm::mix(horizon, ground, down));
  }
  return map;
}

// The gradient's mean is zenith / 3 + horizon * 11 / 48 + ground * 7 / 16.
RadianceMap sky_of_mean(const dvec3& mean) {
  constexpr double zenith = 0.9, horizon = 1.8, ground = (1 - zenith / 3 - horizon * 11 / 48) * 16 / 7;
  return sky_gradient(zenith * mean, horizon * mean, ground * mean);
}

dvec3 direction_of_texel(const RadianceMap& map, int column, int row) {
  const double polar = pi * (row + 0.5) / map.height, longitude = 2 * pi * (column + 0.5) / map.width - pi;
  return {std::sin(polar) * std::cos(longitude), std::cos(polar), std::sin(polar) * std::sin(longitude)};
}

dvec3 radiance_at(const RadianceMap& map, const dvec3& d) {
  const double across = 0.5 + std::atan2(d.z, d.x) / (2 * pi),
               down = std::acos(std::clamp(d.y, -1.0, 1.0)) / pi;
  const int column = std::clamp(int(across * map.width), 0, map.width - 1),
            row = std::clamp(int(down * map.height), 0, map.height - 1);
  return map.texels[size_t(row) * map.width + column];
}

std::shared_ptr<const Environment> make_environment(const RadianceMap& map, const RadianceMoments* moments) {
  auto environment = std::make_shared<Environment>();
  environment->name = map.name;
  RadianceTree tree(tree_cells);
  for_each_part(map, [&](const dvec3& d, double solid_angle, const dvec3& radiance) {
    const glm::dvec2 place = place_of(d) * double(tree_cells);
    tree.add(std::min(int(place.x), tree_cells - 1), std::min(int(place.y), tree_cells - 1), d, solid_angle,
             radiance);
    const double products[] = {d.x,       d.y,       d.z,       d.x * d.x, d.y * d.y,
                               d.z * d.z, d.x * d.y, d.x * d.z, d.y * d.z};
    for (int c = 0; c < 3; ++c) {
      for (size_t k = 0; k < 9; ++k)
        environment->moments[size_t(c)][k] += solid_angle * radiance[c] * products[k];
    }
  });
  if (moments) environment->moments = *moments;
  tree.finish([&](int column, int row) {
    const dvec3 d = direction_of((glm::dvec2(column, row) + 0.5) / double(tree_cells));
    return std::pair(d, radiance_at(map, d));
  });
  for (int step = 0; step < int(std::size(cells_of)); ++step)
    environment->tables.push_back(table_of(tree, step));
  environment->tables.push_back(background_of(map));
  return environment;
}

static dvec3 interpolated(const EnvironmentTable& table, const glm::dvec2& at) {
  const glm::dvec2 in_cells = at * double(table.cells);
  const int column = std::min(int(in_cells.x), table.cells - 1),
            row = std::min(int(in_cells.y), table.cells - 1);
  const dvec3* texel = &table.texels[size_t(row) * size_t(table.cells + 1) + size_t(column)];
  const double x = in_cells.x - column, y = in_cells.y - row;
  return glm::mix(glm::mix(texel[0], texel[1], x),
                  glm::mix(texel[table.cells + 1], texel[table.cells + 2], x), y);
}

dvec3 lobe_radiance(const Environment& environment, const glm::dvec3& direction, double roughness) {
  const glm::dvec2 at = place_of(direction);
  const double place = std::clamp(roughness * ENVIRONMENT_STEPS, 0.0, double(ENVIRONMENT_STEPS));
  const int first = std::min(int(place), int(ENVIRONMENT_STEPS) - 1);
  return glm::mix(interpolated(environment.tables[size_t(first)], at),
                  interpolated(environment.tables[size_t(first) + 1], at), place - first);
}

dvec3 background_radiance(const Environment& environment, const dvec3& direction) {
  return interpolated(environment.tables.back(), place_of(direction));
}

std::shared_ptr<const Environment> parse_environment(const std::string& text) {
  if (text == "none") return nullptr;
  if (text == "sky") return make_environment(sky_gradient({0.2, 0.4, 0.9}, {0.8, 0.9, 1}, {0.12, 0.1, 0.08}));
  if (!text.starts_with("sky:")) return make_environment(read_radiance_map(text));
  const auto colors = parse_sky(text.substr(4));
  if (!colors)
    throw input_error(
        "environment {}: not sky: and nine numbers from 0 to {:g}, the colours of zenith, horizon and ground",
        text, max_radiance);
  return make_environment(sky_gradient((*colors)[0], (*colors)[1], (*colors)[2]));
}

}  // namespace lightgrid
