// A synthetic comparison without rendering: round lights on a flat wall, listed per tile. Figures are
// plausible, not measured; every part of a report exists.
#pragma once

#include <algorithm>
#include <cmath>

#include "measures/metrics.h"
#include "report/report.h"

namespace lightgrid::lab {

struct FlatLight {
  glm::vec2 centre;
  float radius;
  glm::vec3 colour;
};

inline std::vector<FlatLight> flat_lights(int width, int height, int count) {
  std::vector<FlatLight> lights;
  uint32_t state = 7;
  const auto random = [&] { return ((state = state * 1664525u + 1013904223u) >> 8) / float(1 << 24); };
  for (int i = 0; i < count; ++i) {
    const glm::vec2 centre(random() * width, random() * height);
    const float radius = width * (0.03f + 0.09f * random());
    lights.push_back({centre, radius, {0.2f + random(), 0.2f + random() * 0.6f, 0.2f + random() * 0.8f}});
  }
  return lights;
}

inline bool is_lit(const FlatLight& light, int x, int y) {
  return glm::length(glm::vec2(x, y) + 0.5f - light.centre) < light.radius;
}

// Lights whose square touches the pixel's tile.
inline bool is_listed(const FlatLight& light, int x, int y, int tile) {
  const glm::vec2 low(x / tile * tile, y / tile * tile);
  const auto nearest = glm::clamp(light.centre, low, low + float(tile));
  return glm::length(nearest - light.centre) < light.radius;
}

inline CompareReport synthetic_report(int width, int height, int light_count = 60) {
  const auto lights = flat_lights(width, height, light_count);
  CompareReport report;
  report.scene = "scenes/hall.glb";
  report.width = width;
  report.height = height;
  report.cl_device = "pthread-Intel Xeon";
  report.gl_device = "llvmpipe (LLVM 15.0.6, 256 bits)";
  report.commit = "0123abc";
  report.reference = "forward";
  report.reference_pixels = uint64_t(width) * height;

  Image exact(width, height);
  std::vector<uint32_t> lit(exact.pixels.size()), tiled(lit), clustered(lit);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const size_t i = size_t(y) * width + x;
      exact.pixels[i] = glm::vec4(0.01f, 0.012f, 0.02f, 1);
      for (const auto& light : lights) {
        tiled[i] += is_listed(light, x, y, 16);
        clustered[i] += is_listed(light, x, y, 8);
        if (!is_lit(light, x, y)) continue;
        ++lit[i];
        const float t = 1 - glm::length(glm::vec2(x, y) + 0.5f - light.centre) / light.radius;
        exact.pixels[i] += glm::vec4(0.9f * t * t * light.colour, 0);
      }
    }
  }
  auto rounded = exact, torn = exact;
  for (size_t i = 0; i < rounded.pixels.size(); ++i) {
    rounded.pixels[i] = glm::vec4(glm::round(glm::vec3(exact.pixels[i]) * 255.f) / 255.f, 1);
    if (lit[i] > 3 && i / 16 % 5 == 0) torn.pixels[i] *= 0.8f;
  }

  const auto total = [](const std::vector<uint32_t>& counts) {
    uint64_t sum = 0;
    for (auto count : counts) sum += count;
    return sum;
  };
  const auto add = [&](const char* name, double ms, const Image& image, std::vector<uint32_t> listed,
                       uint64_t lost, std::vector<PassResult> passes) {
    RunResult row;
    row.technique = name;
    row.settings = {{"tile", "16"}, {"cull-test", "planes+aabb"}, {"radius-cutoff", "0.01"}};
    row.lights_total = light_count;
    row.lights_in_view = light_count;
    row.frame_ms = {ms * 0.97, ms, ms * 1.08, ms * 1.1, 5};
    row.passes = std::move(passes);
    row.memory_total = 48 << 20;
    row.memory_light_grid = row.passes.size() > 2 ? 1234567 : 0;
    row.pairs = PairCounts{total(listed), total(lit), lost, 0};
    row.error = compare_images(image, exact);
    row.error->oracle = OracleError{row.error->max_rel + 3e-7, 4e-8, 4e-7};
    row.error->surfaces = SurfacesError{150, -2e-3, row.error->max_rel + 1e-3, 3e-4, 2e-3};
    row.nan_pixels = count_nan_pixels(image);
    row.skipped = {{"shadows", "no light casts one"}, {"transparency", "no blended surface is in view"}};
    report.rows.push_back(row);
    report.images.push_back(image);
    report.listed.push_back(std::move(listed));
  };
  const std::vector<uint32_t> all(lit.size(), light_count);
  add("forward", 2420, exact, all, 0,
      {{"depth_prepass", "gl", 48, 0, 1}, {"shade_forward", "gl", 2365, 1, 1}});
  add("forward_plus", 214, exact, tiled, 0,
      {{"depth_prepass", "gl", 48, 0, 1},
       {"depth_bounds", "cl", 1.2, 1, 1},
       {"cull_lights", "cl", 2.4, 1, 1},
       {"shade_forward", "gl", 158, 1, 1}});
  add("clustered", 231.5, exact, clustered, 0,
      {{"depth_prepass", "gl", 48, 0, 1},
       {"cull_lights", "cl", 14.1, 1, 1},
       {"shade_forward", "gl", 165, 1, 1}});
  add("deferred_tiled", 262, rounded, tiled, 0,
      {{"geometry_buffer", "gl", 97, 0, 1},
       {"depth_bounds", "cl", 1.2, 1, 1},
       {"cull_lights", "cl", 2.4, 1, 1},
       {"shade_deferred", "cl", 150, 1, 1}});
  add("lidr", 183, torn, clustered, 812,
      {{"depth_prepass", "gl", 48, 0, 1},
       {"light_indices", "gl", 40, 1, 1},
       {"shade_forward", "gl", 88, 1, 1}});
  add("forward_plus", 205, exact, tiled, 0,
      {{"depth_prepass", "gl", 48, 0, 1},
       {"depth_bounds", "cl", 1.2, 1, 1},
       {"cull_lights", "cl", 4.4, 1, 1},
       {"shade_forward", "gl", 148, 1, 1}});
  report.rows.back().settings["cull-test"] = "exact";
  report.rows.back().skipped.pop_back();
  report.rows.emplace_back().technique = "light_prepass";
  report.rows.back().refused = "blending rounds <0.5 of a step> here";
  report.images.emplace_back();
  report.listed.emplace_back();
  report.lit = lit;
  report.reference_surfaces = report.rows[0].error->surfaces;
  report.reference_errors =
      ReferenceErrors{{0.012, 0.003, 0.0004, 0.002, {}, false}, {3e-6, 8e-7, 2e-8, 4e-7, {}, false}, 42};
  return report;
}

// The same with times that go with a power of the number of lights: forward with the first, forward_plus with
// the fourth root. They cross at 60 * (214 / 302.5)^(4 / 3) = 37.83 lights.
inline CompareReport synthetic_view(const std::string& scene, int width, int height, int lights) {
  CompareReport report = synthetic_report(width, height, lights);
  report.scene = scene;
  const auto scale = [&](RunResult& row, double ms) {
    const double factor = ms / row.frame_ms.median;
    for (double* time : {&row.frame_ms.min, &row.frame_ms.median, &row.frame_ms.p90, &row.frame_ms.max})
      *time *= factor;
    for (PassResult& pass : row.passes) pass.median_ms *= factor;
  };
  scale(report.rows[0], 302.5 * lights / 60);
  for (size_t i = 1; i + 1 < report.rows.size(); ++i) {
    scale(report.rows[i], report.rows[i].frame_ms.median * std::pow(lights / 60.0, 0.25));
  }
  return report;
}

}  // namespace lightgrid::lab
