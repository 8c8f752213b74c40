// Radiance over the square of an octahedral table, as a tree of cells with four children each: sums over lobes
// open only cells that are large next to their distance from the lobe's axis.
#pragma once

#include <cstddef>
#include <functional>
#include <glm/glm.hpp>
#include <utility>
#include <vector>

namespace lightgrid {

class RadianceTree {
 public:
  explicit RadianceTree(int cells);  // along a side: a power of 2

  // Adds radiance to a cell of the finest level, from a direction within it.
  void add(int column, int row, const glm::dvec3& direction, double solid_angle, const glm::dvec3& radiance);
  // Cells without a direction get the direction and radiance of `of(column, row)`.
  void finish(const std::function<std::pair<glm::dvec3, glm::dvec3>(int column, int row)>& of);

  // The mean of the four cells that meet in a corner, from 0 to `cells` along each side.
  glm::dvec3 mean_around(int column, int row) const;

  // The mean over directions l weighted by GGX's distribution of half vectors, for a viewer and a normal along
  // `axis`, and by the cosine: D(h) max(axis.l, 0). alpha: the square of the perceptual roughness.
  glm::dvec3 received(const glm::dvec3& axis, double alpha) const;

 private:
  struct Cell {
    glm::dvec3 direction{0};  // the mean, weighted by solid angle; unit once finished
    double solid_angle = 0;
    glm::dvec3 radiance{0};  // times solid_angle
    double radius = 0;       // chord from `direction` to the farthest of its finest cells
  };
  struct Level {
    int cells;
    std::vector<Cell> cell;
    const Cell& at(int column, int row) const { return cell[size_t(row) * size_t(cells) + size_t(column)]; }
    Cell& at(int column, int row) { return cell[size_t(row) * size_t(cells) + size_t(column)]; }
  };
  std::vector<Level> levels_;  // the finest first
};

}  // namespace lightgrid
