#include "c_api/images.h"

#include <cstdlib>

#include "measures/error_measures.h"
#include "measures/flip.h"
#include "measures/metrics.h"

namespace lightgrid::app::c {
using namespace lab;
namespace {

constexpr int max_side = 16384;
constexpr const char* format_names[] = {"RGBA_F32", "R_F32", "R_U32", "RGB_U8", "RGBA_U8"};

Image read(const lightgrid_image& image) {
  Image copy(image.width, image.height);
  read_pixels(image, copy.pixels.data());
  return copy;
}

struct Pair {
  Image image, reference;
};

Pair read_pair(const lightgrid_image* image, const lightgrid_image* reference) {
  const lightgrid_image& of = checked(reference, "reference", LIGHTGRID_RGBA_F32);
  return {read(checked(image, "image", LIGHTGRID_RGBA_F32, of.width, of.height)), read(of)};
}

double checked_stops(double stops) {
  if (!(std::abs(stops) <= 60)) throw wrong("stops", "{} is not from -60 to 60", stops);
  return stops;
}

double measured(const Pair& pair, const std::string& name) {
  if (name == "flip_mean") {
    const auto exposures = flip_exposures(pair.reference);
    return exposures ? mean_of(hdr_flip_map(pair.image, pair.reference, *exposures)) : unknown_error;
  }
  if (name == "displayed_flip") return displayed_flip(pair.image, pair.reference).mean;
  for (const ErrorMeasure& m : error_measures())
    if (name == m.key) return compare_images(pair.image, pair.reference).*m.value;
  for (const ErrorMeasure& m : frontier_error_measures()) {
    if (name == m.key)
      return frontier_error(pair.image, pair.reference, brightest_channel(pair.reference)).*m.value;
  }
  throw wrong("measure", "there is no {}; lightgrid_describe(\"measures\") lists them", name);
}

}  // namespace

size_t pixel_bytes(lightgrid_format format) {
  return format == LIGHTGRID_RGBA_F32 ? 16 : format == LIGHTGRID_RGB_U8 ? 3 : 4;
}

const lightgrid_image& checked(const lightgrid_image* image, const std::string& name, lightgrid_format format,
                               int width, int height) {
  const lightgrid_image& in = needed(image, name.c_str());
  if (!in.pixels) throw wrong(name + ".pixels", "is null");
  if (in.format != format)
    throw wrong(name + ".format", "{} is not {}, {}", int(in.format), int(format), format_names[format]);
  for (const auto& [field, side, wanted] :
       {std::tuple(".width", in.width, width), {".height", in.height, height}}) {
    if (side < 1 || side > max_side) throw wrong(name + field, "{} is not from 1 to {}", side, max_side);
    if (wanted && side != wanted) throw wrong(name + field, "{} is not {}", side, wanted);
  }
  const ptrdiff_t row = ptrdiff_t(size_t(in.width) * pixel_bytes(format));
  if (std::abs(in.row_bytes) < row)
    throw wrong(name + ".row_bytes", "{} is less than the {} of a row of {} pixels", in.row_bytes, row,
                in.width);
  const size_t aligned = format == LIGHTGRID_RGB_U8 || format == LIGHTGRID_RGBA_U8 ? 1 : 4;
  if (reinterpret_cast<uintptr_t>(in.pixels) % aligned || size_t(std::abs(in.row_bytes)) % aligned)
    throw wrong(name + ".pixels", "pixels or row_bytes are no multiple of {}", aligned);
  return in;
}

}  // namespace lightgrid::app::c

using namespace lightgrid;
using namespace lightgrid::app::c;

extern "C" {

lightgrid_status lightgrid_exposure(const lightgrid_image* image, double* stops) {
  return call([&] {
    double& out = needed(stops, "stops");
    out = automatic_exposure(read(checked(image, "image", LIGHTGRID_RGBA_F32))).ev;
  });
}

lightgrid_status lightgrid_srgb(const lightgrid_image* image, double stops, const lightgrid_image* picture) {
  return call([&] {
    const lightgrid_image& in = checked(image, "image", LIGHTGRID_RGBA_F32);
    const lightgrid_image& out = checked(picture, "picture", LIGHTGRID_RGB_U8, in.width, in.height);
    const std::vector<uint8_t> bytes = srgb_bytes(read(in), {checked_stops(stops)});
    lightgrid_image from_top = out;  // as srgb_bytes has them
    from_top.pixels = row_of(out, out.height - 1);
    from_top.row_bytes = -out.row_bytes;
    write_pixels(from_top, bytes.data());
  });
}

lightgrid_status lightgrid_save(const char* path, const lightgrid_image* image, double stops) {
  return call([&] {
    const std::string name = &needed(path, "path");
    check_image_path(name);
    save_image(name, read(checked(image, "image", LIGHTGRID_RGBA_F32)), {checked_stops(stops)});
  });
}

lightgrid_status lightgrid_measure(const lightgrid_image* image, const lightgrid_image* reference,
                                   const char* measure, double* value) {
  return call([&] {
    double& out = needed(value, "value");
    const std::string name = &needed(measure, "measure");
    out = measured(read_pair(image, reference), name);
  });
}

lightgrid_status lightgrid_flip(const lightgrid_image* image, const lightgrid_image* reference,
                                double pixels_per_degree, const lightgrid_image* map) {
  return call([&] {
    const Pair pair = read_pair(image, reference);
    const lightgrid_image& out = checked(map, "map", LIGHTGRID_R_F32, pair.image.width, pair.image.height);
    if (!(pixels_per_degree == 0 || (pixels_per_degree >= 1 && pixels_per_degree <= 1000)))
      throw wrong("pixels_per_degree", "{} is neither 0 nor from 1 to 1000", pixels_per_degree);
    const auto exposures = flip_exposures(pair.reference);
    if (!exposures)
      throw wrong("reference",
                  "half of its pixels or more are black or one is not finite, so that no exposures "
                  "follow from it");
    const double density = pixels_per_degree == 0 ? default_pixels_per_degree : pixels_per_degree;
    write_pixels(out, hdr_flip_map(pair.image, pair.reference, *exposures, density).data());
  });
}

}  // extern "C"
