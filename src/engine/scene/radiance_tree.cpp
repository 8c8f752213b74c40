#include "scene/radiance_tree.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lightgrid {
namespace {

using glm::dvec3;

// A cell is opened if its radius is above this part of the distance over which the lobe changes.
constexpr double opening = 0.2;

}  // namespace

RadianceTree::RadianceTree(int cells) {
  for (int side = cells; side >= 2; side /= 2)
    levels_.push_back({side, std::vector<Cell>(size_t(side) * side)});
}

void RadianceTree::add(int column, int row, const dvec3& direction, double solid_angle,
                       const dvec3& radiance) {
  Cell& cell = levels_[0].at(column, row);
  cell.direction += solid_angle * direction;
  cell.solid_angle += solid_angle;
  cell.radiance += solid_angle * radiance;
}

void RadianceTree::finish(const std::function<std::pair<dvec3, dvec3>(int column, int row)>& of) {
  const double mean_solid_angle = 12.566370614359172 / double(levels_[0].cell.size());
  for (int row = 0; row < levels_[0].cells; ++row) {
    for (int column = 0; column < levels_[0].cells; ++column) {
      if (levels_[0].at(column, row).solid_angle > 0) continue;
      const auto [direction, radiance] = of(column, row);
      add(column, row, direction, 1e-3 * mean_solid_angle, radiance);
    }
  }
  for (size_t i = 0; i + 1 < levels_.size(); ++i) {
    const Level& fine = levels_[i];
    for (int row = 0; row < fine.cells; ++row) {
      for (int column = 0; column < fine.cells; ++column) {
        const Cell& cell = fine.at(column, row);
        Cell& parent = levels_[i + 1].at(column / 2, row / 2);
        parent.direction += cell.direction;
        parent.solid_angle += cell.solid_angle;
        parent.radiance += cell.radiance;
      }
    }
  }
  for (size_t i = 0; i < levels_.size(); ++i) {
    for (Cell& cell : levels_[i].cell) cell.direction = glm::normalize(cell.direction);
    if (i == 0) continue;
    const Level& fine = levels_[i - 1];
    for (int row = 0; row < fine.cells; ++row) {
      for (int column = 0; column < fine.cells; ++column) {
        Cell& parent = levels_[i].at(column / 2, row / 2);
        const Cell& cell = fine.at(column, row);
        parent.radius =
            std::max(parent.radius, glm::distance(parent.direction, cell.direction) + cell.radius);
      }
    }
  }
}

dvec3 RadianceTree::mean_around(int column, int row) const {
  const int cells = levels_[0].cells;
  dvec3 radiance(0);
  double solid_angle = 0;
  for (const auto& [x, y] : {std::array{-1, -1}, {0, -1}, {-1, 0}, {0, 0}}) {
    int i = column + x, j = row + y;
    // Beyond an edge the square goes on at the mirrored place of the same edge.
    if (i < 0 || i >= cells) {
      i = std::clamp(i, 0, cells - 1);
      j = cells - 1 - j;
    }
    if (j < 0 || j >= cells) {
      j = std::clamp(j, 0, cells - 1);
      i = cells - 1 - i;
    }
    const Cell& cell = levels_[0].at(i, j);
    radiance += cell.radiance;
    solid_angle += cell.solid_angle;
  }
  return radiance / solid_angle;
}

dvec3 RadianceTree::received(const dvec3& axis, double alpha) const {
  struct Place {
    int level, column, row;
  };
  std::array<Place, 64> open;  // three stay behind at each level
  size_t count = 0;
  const int coarsest = int(levels_.size()) - 1;
  for (int i = 0; i < 4; ++i) open[count++] = {coarsest, i % 2, i / 2};
  dvec3 sum(0);
  double weights = 0;
  while (count > 0) {
    const Place place = open[--count];
    const Cell& cell = levels_[size_t(place.level)].at(place.column, place.row);
    const double cosine = glm::dot(axis, cell.direction);
    const dvec3 apart = axis - cell.direction;
    const double chord2 = glm::dot(apart, apart);
    const double scale = std::max(std::sqrt(chord2) - cell.radius, 0.0) + 2 * alpha;
    if (place.level > 0 && cell.radius > opening * scale) {
      for (int i = 0; i < 4; ++i)
        open[count++] = {place.level - 1, 2 * place.column + i % 2, 2 * place.row + i / 2};
      continue;
    }
    if (cosine <= 0) continue;
    // (n.h)^2 (alpha^2 - 1) + 1, with (n.h)^2 = (1 + cosine) / 2, without cancellation.
    const double width = 0.25 * chord2 + 0.5 * alpha * alpha * (1 + cosine);
    const double weight = cosine / (width * width);
    sum += weight * cell.radiance;
    weights += weight * cell.solid_angle;
  }
  return sum / weights;
}

}  // namespace lightgrid
