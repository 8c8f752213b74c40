// A rasteriser that tests every pixel of a triangle's box, with 64-bit edges and depth in double; right, or
// with one fault. What it cuts and where it snaps to is the oracle's (oracle/coverage.h), so that its
// images can be compared with it.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "hard_cases/faults.h"
#include "oracle/coverage.h"
#include "raster/raster_samples.h"
#include "verify/engine.h"

namespace lightgrid::lab::verify {

class NaiveRasterizer {
 public:
  NaiveRasterizer(const RasterInput& input, Fault fault) : input_(input), fault_(fault) {
    const size_t values = input.camera.grid.values();
    image_.triangles.assign(values, no_triangle);
    image_.depths.assign(values, 0.0f);
  }

  RasterImage draw() {
    for (const RasterInstance& instance : input_.instances) {
      const RasterInputMesh& mesh = input_.meshes[instance.mesh];
      image_.clip.push_back(clip_positions(instance, mesh));
      for (size_t i = 0; i < mesh.indices.size(); i += 3, ++number_) {
        if (fault_ == Fault::capacity_of_4096 && number_ >= 4096) continue;
        const std::vector<glm::vec4>& clip = image_.clip.back();
        draw_triangle(instance,
                      {clip[mesh.indices[i]], clip[mesh.indices[i + 1]], clip[mesh.indices[i + 2]]});
      }
    }
    return image_;
  }

 private:
  std::vector<glm::vec4> clip_positions(const RasterInstance& instance, const RasterInputMesh& mesh) const {
    const glm::dmat4 clip_from_object =
        input_.camera.clip_from_view * input_.camera.view_from_world * instance.world_from_object;
    std::vector<glm::vec4> clip;
    for (const glm::vec3& p : mesh.positions)
      clip.push_back(glm::vec4(glm::mat4(clip_from_object) * glm::vec4(p, 1)));
    return clip;
  }

  void draw_triangle(const RasterInstance& instance, std::array<glm::vec4, 3> corners) {
    if (fault_ == Fault::invalid_is_zero) {
      for (glm::vec4& c : corners) {
        for (int k = 0; k < 4; ++k) c[k] = std::isfinite(c[k]) ? c[k] : 0.1f;
      }
    }
    if (fault_ == Fault::no_near_cut) return draw_part(instance, corners);
    const auto polygon = cut_triangle(corners, input_.camera.grid);
    if (!polygon) ++image_.invalid_triangles;
    for (size_t i = 2; polygon && i < polygon->size(); ++i)
      draw_part(instance, {(*polygon)[0], (*polygon)[i - 1], (*polygon)[i]});
  }

  // Positive inside, where the sample counts as on this side.
  bool lets_in(const SnappedPoint& a, const SnappedPoint& b, int64_t x, int64_t y) const {
    const int64_t across = b.x - a.x, up = b.y - a.y;
    if (fault_ == Fault::edges_in_float) {
      const float value = float(across) * float(y - a.y) - float(up) * float(x - a.x);
      return value > 0 || (value == 0 && (up < 0 || (up == 0 && across < 0)));
    }
    const int64_t value = across * (y - a.y) - up * (x - a.x);
    if (value != 0 || fault_ == Fault::edges_of_both) return value >= 0;
    if (fault_ == Fault::edges_of_none) return false;
    return up < 0 || (up == 0 && across < 0);
  }

  void draw_part(const RasterInstance& instance, const std::array<glm::vec4, 3>& corners) {
    const int width = input_.camera.grid.width, height = input_.camera.grid.height;
    std::array<SnappedPoint, 3> p;
    std::array<double, 3> z;
    for (int k = 0; k < 3; ++k) {
      p[k] = snapped(corners[k], input_.camera.grid);
      z[k] = std::min(double(corners[k].z) / corners[k].w, 1.0);
      const int64_t most = 1 << 24;
      if (p[k].x < -most || p[k].x > most || p[k].y < -most || p[k].y > most) return;
    }
    const auto area = [](const SnappedPoint& a, const SnappedPoint& b, const SnappedPoint& c) {
      return (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
    };
    const int64_t whole = area(p[0], p[1], p[2]);
    const bool mirrored =
        glm::determinant(glm::dmat3(instance.world_from_object)) < 0 && fault_ != Fault::mirrors_ignored;
    if (whole == 0 || (!instance.two_sided && (whole < 0) != mirrored)) return;
    if (whole < 0) {
      std::swap(p[1], p[2]);
      std::swap(z[1], z[2]);
    }
    const auto [x0, x1] = std::minmax({p[0].x, p[1].x, p[2].x});
    const auto [y0, y1] = std::minmax({p[0].y, p[1].y, p[2].y});
    for (int64_t y = std::max<int64_t>(0, y0 / 256 - 1); y <= std::min<int64_t>(height - 1, y1 / 256); ++y) {
      for (int64_t x = std::max<int64_t>(0, x0 / 256 - 1); x <= std::min<int64_t>(width - 1, x1 / 256); ++x) {
        const SnappedPoint centre{x * 256 + 128, y * 256 + 128};
        const bool in_box = centre.x >= x0 && centre.x <= x1 && centre.y >= y0 && centre.y <= y1;
        if (fault_ == Fault::box_of_centres && !in_box) continue;
        for (int s = 0; s < input_.camera.grid.samples; ++s) {
          const SnappedPoint c = sample_place(centre, s), d = fault_ == Fault::depth_of_centres ? centre : c;
          if (!lets_in(p[0], p[1], c.x, c.y) || !lets_in(p[1], p[2], c.x, c.y) ||
              !lets_in(p[2], p[0], c.x, c.y))
            continue;
          const double weighted = z[0] * double(area(d, p[1], p[2])) + z[1] * double(area(p[0], d, p[2])) +
                                  z[2] * double(area(p[0], p[1], d));
          put(input_.camera.grid.index(int(x), int(y), s), float(weighted / double(std::abs(whole))));
        }
      }
    }
  }

  SnappedPoint sample_place(const SnappedPoint& centre, int s) const {
    const int samples = input_.camera.grid.samples;
    if (fault_ == Fault::last_sample_as_first && s == samples - 1) s = 0;
    if (fault_ == Fault::samples_at_centres) return centre;
    const glm::ivec2 p = raster_samples(samples)[size_t(s)];
    return {centre.x + p.x, centre.y + (fault_ == Fault::samples_upside_down ? -p.y : p.y)};
  }

  void put(size_t pixel, float depth) {
    const bool equal_wins = fault_ != Fault::first_of_equal_depths && image_.triangles[pixel] != no_triangle;
    if (!(depth > image_.depths[pixel]) && !(equal_wins && depth == image_.depths[pixel])) return;
    image_.depths[pixel] = depth;
    image_.triangles[pixel] = number_;
  }

  const RasterInput& input_;
  const Fault fault_;
  RasterImage image_;
  uint32_t number_ = 0;
};

inline RasterImage naive_image(const RasterInput& input, Fault fault) {
  return NaiveRasterizer(input, fault).draw();
}

}  // namespace lightgrid::lab::verify
