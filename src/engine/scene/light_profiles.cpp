#include "scene/light_profiles.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <span>
#include <string_view>

#include "base/error.h"
#include "scene/property_rows.h"

namespace lightgrid {
namespace {

constexpr double largest_float = std::numeric_limits<float>::max();
constexpr size_t max_angles = 4096, max_file_values = size_t(1) << 20, max_tilt_angles = 4096;

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == ',' || c == '\0'; }

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  return text;
}

// The numbers after the line TILT=, one after the other. Line ends have no meaning there.
class PhotometricNumbers {
 public:
  explicit PhotometricNumbers(std::string_view text) : left_(text) {}

  double next(const std::string& name, double low = -largest_float, double high = largest_float) {
    while (!left_.empty() && is_space(left_.front())) left_.remove_prefix(1);
    size_t length = 0;
    while (length < left_.size() && !is_space(left_[length])) ++length;
    if (length == 0) throw input_error("ends before {}", name);
    const std::string_view word = left_.substr(0, length);
    left_.remove_prefix(length);
    const char *begin = word.data() + (word.front() == '+' ? 1 : 0), *end = word.data() + word.size();
    double value = 0;
    const auto [at, fault] = std::from_chars(begin, end, value);
    if (at != end || fault != std::errc() || !std::isfinite(value))
      throw input_error("{} is {:?}, not a number", name, word.substr(0, 40));
    if (value < low || value > high)
      throw input_error("{} is {:g}, not from {:g} to {:g}", name, value, low, high);
    return value;
  }

  size_t count(const std::string& name, size_t most) {
    const double value = next(name, 1, double(most));
    if (value != std::floor(value)) throw input_error("{} is {:g}, not a whole number", name, value);
    return size_t(value);
  }

  // Strictly ascending.
  std::vector<double> angles(const char* name, size_t count, double low, double high) {
    std::vector<double> out;
    for (size_t i = 0; i < count; ++i) {
      out.push_back(next(fmt::format("{} angle {}", name, i), low, high));
      if (i > 0 && !(out[i] > out[i - 1]))
        throw input_error("{} angle {} is {:g}, not above the one before it, {:g}", name, i, out[i],
                          out[i - 1]);
    }
    return out;
  }

 private:
  std::string_view left_;
};

// The text after the line TILT=, and whether tilt factors come first. LM-63 has the keywords before it.
std::pair<std::string_view, bool> after_tilt(std::string_view text) {
  for (size_t at = 0; at < text.size();) {
    const size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view line = trimmed(text.substr(at, end - at));
    at = end + 1;
    if (line.starts_with("TILT="))
      return {text.substr(std::min(at, text.size())), trimmed(line.substr(5)) == "INCLUDE"};
  }
  throw input_error("has no line TILT=, so it is no LM-63 file");
}

// Factors of a lamp in a tilted luminaire. The values are checked and not used: the scene does not say how the
// lamp burns in the luminaire.
void skip_tilt(PhotometricNumbers& numbers) {
  numbers.next("the lamp-to-luminaire geometry of TILT", 1, 3);
  const size_t pairs = numbers.count("the number of tilt angles", max_tilt_angles);
  for (size_t i = 0; i < pairs; ++i) numbers.next(fmt::format("tilt angle {}", i));
  for (size_t i = 0; i < pairs; ++i) numbers.next(fmt::format("tilt factor {}", i), 0);
}

// Candela by two angles; a line for each of `outer`.
struct Candela {
  std::vector<double> inner, outer;
  std::vector<std::vector<double>> lines;
};

Candela transposed(const Candela& in) {
  Candela out{in.outer, in.inner, {}};
  out.lines.assign(in.inner.size(), std::vector<double>(in.outer.size()));
  for (size_t i = 0; i < in.outer.size(); ++i)
    for (size_t k = 0; k < in.inner.size(); ++k) out.lines[k][i] = in.lines[i][k];
  return out;
}

// Adds the lines mirrored about the last outer angle.
void mirror_up(Candela& c) {
  const double about = c.outer.back();
  for (size_t i = c.outer.size() - 1; i-- > 0;) {
    c.outer.push_back(2 * about - c.outer[i]);
    c.lines.push_back(c.lines[i]);
  }
}

// The same about the first.
void mirror_down(Candela& c) {
  std::ranges::reverse(c.outer);
  std::ranges::reverse(c.lines);
  mirror_up(c);
  std::ranges::reverse(c.outer);
  std::ranges::reverse(c.lines);
}

// Type C: from its symmetry to a full turn.
void complete_turn(Candela& c) {
  if (c.outer.size() == 1) return;
  const double first = c.outer.front(), last = c.outer.back();
  if (first == 0 && last == 90) {
    mirror_up(c);
    mirror_up(c);
  } else if (first == 0 && last == 180) {
    mirror_up(c);
  } else if (first == 90 && last == 270) {
    mirror_down(c);
  } else if (first == 0 && last > 180 && last < 360) {  // files without the plane that closes the turn
    c.outer.push_back(360);
    c.lines.push_back(c.lines.front());
  } else if (!(first == 0 && last == 360)) {
    throw input_error(
        "horizontal angles go from {:g} to {:g}; type C has one angle, or 0 to 90, 0 to 180, 0 to 360 or 90 "
        "to 270",
        first, last);
  }
}

// Types A and B: the outer angles become -90 to 90.
void complete_half(Candela& c, const char* name) {
  if (c.outer.back() != 90 || (c.outer.front() != 0 && c.outer.front() != -90))
    throw input_error("{} angles go from {:g} to {:g}; types A and B have 0 to 90 or -90 to 90", name,
                      c.outer.front(), c.outer.back());
  if (c.outer.front() == 0) mirror_down(c);
}

// Types A and B have latitudes of the front half of a ball: A's vertical angles, about a pole across the
// light; B's horizontal ones. Returns polar angles from the pole as inner angles, azimuths as outer ones.
Candela by_polar_angle(Candela file, Photometry type) {
  complete_half(file, "horizontal");
  Candela other = transposed(file);
  complete_half(other, "vertical");
  Candela out = type == Photometry::a ? transposed(other) : other;
  for (double& angle : out.inner) angle += 90;
  return out;
}

FileTable table_of(const Candela& c, Photometry type, double factor) {
  double largest = 0;
  for (const std::vector<double>& line : c.lines) largest = std::max(largest, std::ranges::max(line));
  if (!(largest * factor <= largest_float))
    throw input_error("candela values go up to {:g}, past the largest float", largest * factor);
  FileTable out;
  out.shape = {uint32_t(type), uint32_t(c.inner.size()), uint32_t(c.outer.size())};
  out.values.push_back(float(largest * factor));
  for (const std::vector<double>* angles : {&c.inner, &c.outer})
    for (const double angle : *angles) out.values.push_back(float(angle));
  for (const std::vector<double>& line : c.lines)
    for (const double value : line) out.values.push_back(float(largest > 0 ? value / largest : 0));
  return out;
}

struct Angles {
  std::span<const float> polar, azimuths;
  const float* shares;
};

Angles angles_of(const FileTable& p) {
  const size_t polar = p.shape[profile_polar_angles], azimuths = p.shape[profile_azimuths];
  const std::span<const float> values(p.values);
  return {values.subspan(1, polar), values.subspan(1 + polar, azimuths),
          p.values.data() + 1 + polar + azimuths};
}

bool is_half(const FileTable& p) { return Photometry(p.shape[profile_type]) != Photometry::c; }

// Index of the angle before `at`, and the weight of the next one.
std::pair<size_t, double> bracket(std::span<const float> angles, double at) {
  if (angles.size() == 1) return {0, 0};
  const auto above = std::upper_bound(angles.begin() + 1, angles.end() - 1, at);
  const size_t i = size_t(above - angles.begin()) - 1;
  const double low = angles[i], high = angles[i + 1];
  return {i, std::clamp((at - low) / (high - low), 0.0, 1.0)};
}

// The least number of equal steps of `whole` that contains all angles, counted from `first`.
uint32_t steps_of(std::span<const float> angles, double first, double whole) {
  constexpr double rounding = 1.6e-5;  // degrees: of floats up to 360
  for (uint32_t n = 1; n < max_profile_steps; ++n) {
    const double step = whole / n;
    const auto contains = [&](float angle) {
      return std::abs(std::remainder(angle - first, step)) <= rounding;
    };
    if (std::ranges::all_of(angles, contains)) return n;
  }
  return max_profile_steps;
}

double radians(double degrees) { return degrees * std::numbers::pi / 180; }

void shine_as_measured(Light& light) {
  const double candela = largest_candela(*light_profile.of(light)), brightest = candela * light.intensity;
  light.intensity = float(std::min(brightest, largest_float));
  if (intensity_overflows(light)) throw input_error("its candela values pass the largest float");
}

}  // namespace

const Property<SharedTable> light_profile{"profile", nullptr, {.parse = parse_profile}};
static const bool extension = add_light_extension({"EXT_lights_ies", "profile", shine_as_measured});

FileTable parse_profile(const std::vector<uint8_t>& bytes) {
  const auto [text, has_tilt] = after_tilt({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  PhotometricNumbers numbers(text);
  if (has_tilt) skip_tilt(numbers);
  numbers.next("the number of lamps");
  numbers.next("lumens per lamp");
  double factor = numbers.next("the candela multiplier", 0);
  const size_t vertical = numbers.count("the number of vertical angles", max_angles),
               horizontal = numbers.count("the number of horizontal angles", max_angles);
  if (vertical * horizontal > max_file_values)
    throw input_error("{} vertical and {} horizontal angles give {} values; at most {} are read", vertical,
                      horizontal, vertical * horizontal, max_file_values);
  const auto type = Photometry(uint32_t(numbers.count("the photometric type", 3)));
  for (const char* name : {"the units type", "the width", "the length", "the height"}) numbers.next(name);
  factor *= numbers.next("the ballast factor", 0);
  for (const char* name : {"the ballast-lamp factor", "the input watts"}) numbers.next(name);
  const bool half = type != Photometry::c;
  Candela file;
  file.inner = numbers.angles("vertical", vertical, half ? -90 : 0, half ? 90 : 180);
  file.outer = numbers.angles("horizontal", horizontal, half ? -90 : 0, half ? 90 : 360);
  for (size_t h = 0; h < horizontal; ++h) {
    std::vector<double>& line = file.lines.emplace_back();
    for (size_t v = 0; v < vertical; ++v)
      line.push_back(numbers.next(fmt::format("candela value {} of horizontal angle {}", v, h), 0));
  }
  if (half)
    file = by_polar_angle(std::move(file), type);
  else
    complete_turn(file);
  FileTable table = table_of(file, type, factor);
  const ProfileGrid grid = grid_of(table);
  if (grid.shares.empty())
    throw input_error(
        "its angles are multiples of a {}th and a {}th part of their ranges only: a grid of these "
        "steps has more than {} values; round the angles",
        grid.rows, grid.columns, max_profile_values);
  return table;
}

SharedTable profile_of(const Light& light) {
  return is_directional(light) ? nullptr : light_profile.of(light);
}

float largest_candela(const FileTable& profile) { return profile.values[0]; }

// EXT_lights_ies: (0, 0) is the node's -z. Vertical angles 0 grow towards +x there. Horizontal ones of type C
// turn from +x to +y, those of types A and B the other way.
ProfileAxes profile_axes(const FileTable& profile, const LightAxes& axes) {
  switch (Photometry(profile.shape[profile_type])) {
    case Photometry::c:
      return {axes.direction, axes.right, axes.up};
    case Photometry::b:
      return {axes.up, axes.direction, axes.right};
    case Photometry::a:
      break;
  }
  return {-axes.right, axes.direction, -axes.up};
}

double profile_share(const FileTable& profile, double polar_deg, double azimuth_deg) {
  const Angles a = angles_of(profile);
  if (a.polar.size() > 1 && (polar_deg < a.polar.front() || polar_deg > a.polar.back())) return 0;
  double azimuth = azimuth_deg;
  if (is_half(profile)) {
    azimuth = std::remainder(azimuth, 360);
    if (std::abs(azimuth) > 90) return 0;
  } else {
    while (azimuth < a.azimuths.front()) azimuth += 360;
    while (azimuth >= a.azimuths.front() + 360) azimuth -= 360;
  }
  const auto [row, down] = bracket(a.polar, polar_deg);
  const auto [column, along] = bracket(a.azimuths, azimuth);
  const size_t next_row = a.polar.size() > 1 ? row + 1 : row,
               next_column = a.azimuths.size() > 1 ? column + 1 : column;
  const auto at = [&](size_t azimuth_index, size_t polar_index) {
    return double(a.shares[azimuth_index * a.polar.size() + polar_index]);
  };
  return std::lerp(std::lerp(at(column, row), at(column, next_row), down),
                   std::lerp(at(next_column, row), at(next_column, next_row), down), along);
}

ProfileGrid grid_of(const FileTable& profile) {
  const Angles a = angles_of(profile);
  // One angle: the same in all directions.
  const bool one = a.polar.size() == 1;
  const double first = one ? 0 : a.polar.front(), last = one ? 180 : a.polar.back();
  ProfileGrid grid{.rows = one ? 1 : steps_of(a.polar, first, last - first),
                   .columns = a.azimuths.size() == 1 ? 0 : steps_of(a.azimuths, 0, 360),
                   .first_rad = radians(first),
                   .last_rad = radians(last),
                   .front = is_half(profile),
                   .shares = {}};
  if (size_t(grid.rows + 1) * (grid.columns + 1) > max_profile_values) return grid;
  for (uint32_t column = 0; column <= grid.columns; ++column) {
    double azimuth = grid.columns > 0 ? 360.0 * column / grid.columns : 0;
    // Behind, the value at the edge: it is not read.
    if (grid.front) azimuth = std::clamp(std::remainder(azimuth, 360), -90.0, 90.0);
    for (uint32_t row = 0; row <= grid.rows; ++row) {
      const double polar = row == grid.rows ? last : first + (last - first) * row / grid.rows;
      grid.shares.push_back(float(profile_share(profile, polar, azimuth)));
    }
  }
  return grid;
}

}  // namespace lightgrid
