#include "frames/frame_view.h"

#include <algorithm>
#include <cmath>

#include "base/json_file.h"

namespace lightgrid::lab {
namespace {

using nlohmann::json;

constexpr double largest = 1e12;  // largest matrix element; above any world, and its square fits a float
constexpr double min_scale = 1e-9, largest_scale = 1e9;
constexpr double rotation_tolerance = 5e-6;  // engines keep matrices in float
constexpr double near_tolerance = 1e-3;      // relative

// Files store rows, GLM columns.
glm::dmat4 matrix_of(const JsonFile& file, const char* field) {
  const std::vector<double> rows = file.numbers(field, 16, -largest, largest);
  glm::dmat4 m;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) m[column][row] = rows[4 * row + column];
  return m;
}

json rows_of(const glm::dmat4& m) {
  json rows = json::array();
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) rows.push_back(m[column][row]);
  return rows;
}

json row_of(const glm::dmat4& m, int row) { return {m[0][row], m[1][row], m[2][row], m[3][row]}; }

void read_projection(const JsonFile& file, View& view) {
  const char* field = "clip_from_view";
  glm::dmat4& m = view.clip_from_view = matrix_of(file, field);
  const auto row_error = [&](int row, const char* must) {
    return file.error(fmt::format("{} row {}", field, row + 1), row_of(m, row), must);
  };
  const bool flat = m[0][3] == 0 && m[1][3] == 0;
  view.orthographic = flat && m[2][3] == 0 && m[3][3] > 0;
  const bool perspective = flat && m[3][3] == 0 && m[2][3] < 0;
  if (!view.orthographic && !perspective) {
    throw row_error(3,
                    "is neither [0,0,-1,0], a perspective view along -z, nor [0,0,0,1], an orthographic one");
  }
  const double w = view.orthographic ? m[3][3] : -m[2][3];
  if (w != 1) m /= w;  // multiples are the same projection
  // The column with the offsets of x, y and depth: the third in perspective, the fourth in orthographic
  // views.
  const int offset = view.orthographic ? 3 : 2, other = view.orthographic ? 2 : 3;
  if (m[1][0] != 0 || m[other][0] != 0) throw row_error(0, "has more than a scale and an offset of x");
  if (m[0][1] != 0 || m[other][1] != 0) throw row_error(1, "has more than a scale and an offset of y");
  if (m[0][2] != 0 || m[1][2] != 0)
    throw row_error(2, "makes depth depend on x or y; oblique near planes are not supported");
  for (int i = 0; i < 2; ++i) {
    if (!(m[i][i] >= min_scale && m[i][i] <= largest_scale)) {
      throw row_error(i, i ? "has no scale of y above 0 (row 0 of the depth image is at the bottom)"
                           : "has no scale of x above 0");
    }
    if (!(std::abs(m[offset][i]) <= largest_scale)) throw row_error(i, "has an offset beyond any view");
  }
}

// The distance along the view axis with this depth. Infinite or negative if there is none.
double distance_at(const View& view, double depth) {
  const double a = view.clip_from_view[2][2], b = view.clip_from_view[3][2];
  return view.orthographic ? (b - depth) / a : b / (depth + a);
}

void check_depth(const JsonFile& file, View& view) {
  const double a = view.clip_from_view[2][2], b = view.clip_from_view[3][2];
  const auto depth_error = [&](const char* fault) {
    return file.error("clip_from_view row 3", row_of(view.clip_from_view, 2), fault);
  };
  const double slope = view.orthographic ? a : b;
  if (!(std::abs(slope) >= 1e-12)) throw depth_error("gives all distances one depth");
  const bool reversed = slope > 0;
  const double near = distance_at(view, reversed ? 1 : 0), far = distance_at(view, reversed ? 0 : 1);
  if (!view.orthographic && !(near > 0 && near <= largest))
    throw depth_error("has no near plane before the eye");
  if (!view.orthographic && !(far > near || std::isinf(far)))
    throw depth_error("has its far plane behind the eye");
  view.near_m = near;
  view.far_m = std::isinf(far) || far < 0 ? std::numeric_limits<double>::infinity() : far;
  if (view.orthographic) view.far_m = far;
  if (!file.has("near")) return;
  const double told = file.number("near", -largest, largest);
  if (!(std::abs(told - near) <= near_tolerance * std::max(std::abs(told), std::abs(near)) +
                                     (view.orthographic ? near_tolerance * (far - near) : 0))) {
    throw file.error("near", fmt::format("is not the distance {:g} at which clip_from_view has depth {}",
                                         near, reversed ? 1 : 0));
  }
  view.near_m = told;
}

void read_far(const JsonFile& file, View& view) {
  if (!file.has("far")) {
    if (!view.orthographic) view.far_m = std::numeric_limits<double>::infinity();
    return;
  }
  const double far = file.number("far", -largest, std::numeric_limits<double>::max());
  if (!(far > view.near_m)) throw file.error("far", fmt::format("is not beyond near {:g}", view.near_m));
  view.far_m = far;
}

void read_pose(const JsonFile& file, View& view) {
  const char* field = "view_from_world";
  const glm::dmat4& m = view.view_from_world = matrix_of(file, field);
  if (row_of(m, 3) != json({0.0, 0.0, 0.0, 1.0})) {
    throw file.error("view_from_world row 4", row_of(m, 3), "is not [0,0,0,1]");
  }
  const glm::dmat3 rotation(m);
  const glm::dmat3 product = glm::transpose(rotation) * rotation;
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row) {
      if (!(std::abs(product[column][row] - (row == column)) <= rotation_tolerance)) {
        throw file.error(field, "is not rigid: its upper left 3x3 is not a rotation");
      }
    }
  }
  const glm::dvec3 translation(m[3]);
  view.eye = -(glm::inverse(rotation) * translation);
  if (!file.has("eye")) return;
  const std::vector<double> eye = file.numbers("eye", 3, -largest, largest);
  const glm::dvec3 told(eye[0], eye[1], eye[2]);
  if (!(glm::length(told - view.eye) <= rotation_tolerance * (1 + glm::length(view.eye)))) {
    throw file.error("eye", fmt::format("is not where view_from_world has it, [{:g},{:g},{:g}]", view.eye.x,
                                        view.eye.y, view.eye.z));
  }
  view.eye = told;
}

}  // namespace

FrameView read_view_file(const std::filesystem::path& path) {
  const JsonFile file(path);
  file.check_fields(
      {"size", "tile", "near", "far", "surfaces_far", "clip_from_view", "view_from_world", "eye"});
  FrameView frame;
  const std::vector<int> size = file.wholes("size", 2, 1, max_frame_side);
  frame.view.width = size[0];
  frame.view.height = size[1];
  if (file.has("tile")) frame.tile = file.whole("tile", 1, max_frame_side);
  if (frame.tile != 8 && frame.tile != 16 && frame.tile != 32 && frame.tile != 64) {
    throw file.error("tile", "is not 8, 16, 32 or 64");
  }
  read_projection(file, frame.view);
  check_depth(file, frame.view);
  read_far(file, frame.view);
  if (file.has("surfaces_far")) {
    frame.surfaces_far_m = file.number("surfaces_far", -largest, largest);
    if (!(frame.surfaces_far_m > frame.view.near_m)) {
      throw file.error("surfaces_far", fmt::format("is not beyond near {:g}", frame.view.near_m));
    }
  }
  read_pose(file, frame.view);
  return frame;
}

std::string view_file_text(const FrameView& frame) {
  const View& view = frame.view;
  nlohmann::ordered_json out;
  out["size"] = {view.width, view.height};
  out["tile"] = frame.tile;
  out["near"] = view.near_m;
  out["far"] = std::isfinite(view.far_m) ? json(view.far_m) : json();
  if (frame.surfaces_far_m != 0) out["surfaces_far"] = frame.surfaces_far_m;
  out["clip_from_view"] = rows_of(view.clip_from_view);
  out["view_from_world"] = rows_of(view.view_from_world);
  out["eye"] = {view.eye.x, view.eye.y, view.eye.z};
  return text_by_fields(out);
}

}  // namespace lightgrid::lab
