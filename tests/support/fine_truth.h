// A picture drawn at 16 times the size, 256 samples a pixel in a grid, by visibility with one sample: its
// surfaces and their light, but no code of samples.
#pragma once

#include <algorithm>
#include <cmath>

#include "accuracy/surfaces_in_double.h"
#include "run/technique_run.h"

namespace lightgrid {
using namespace lab;

struct FineTruth {
  static constexpr int side = 16;

  // large: the view at `side` times the image's size. most: light above it counts as that much.
  FineTruth(Renderer& renderer, const Scene& scene, const View& large, float most = INFINITY)
      : most(most), image(large.width / side, large.height / side), edges(image.pixels.size()) {
    TechniqueRun run(renderer, scene, large, {}, find_technique("visibility"));
    run.run_frame();
    const std::vector<SceneTriangle> shown = own_triangles(run);
    constexpr int no_instance_yet = -2;
    std::vector<int> first(image.pixels.size(), no_instance_yet);
    for (int y = 0; y < large.height; ++y) {
      for (int x = 0; x < large.width; ++x) {
        const size_t pixel = size_t(y / side) * size_t(image.width) + size_t(x / side),
                     fine = size_t(y) * size_t(large.width) + size_t(x);
        image.pixels[pixel] += run.image().pixels[fine] / float(side * side);
        int& instance = first[pixel];
        if (instance == no_instance_yet) instance = shown[fine].instance;
        if (shown[fine].instance != instance) edges[pixel] = true;
      }
    }
  }

  // Root mean square of the brightest channel's difference over pixels at edges, where several instances are
  // seen, or over those inside.
  double error(const Image& other, bool at_edges) const {
    double sum = 0;
    size_t count = 0;
    for (size_t i = 0; i < edges.size(); ++i) {
      if (edges[i] != at_edges) continue;
      const glm::vec3 d = glm::abs(limited(image.pixels[i]) - limited(other.pixels[i]));
      sum += std::pow(double(std::max({d.r, d.g, d.b})), 2);
      ++count;
    }
    return std::sqrt(sum / double(count));
  }
  double edge_share() const { return double(std::ranges::count(edges, true)) / double(edges.size()); }

  float most;
  Image image;
  std::vector<bool> edges;

 private:
  glm::vec3 limited(const glm::vec4& c) const { return glm::min(glm::vec3(c), glm::vec3(most)); }
};

}  // namespace lightgrid
