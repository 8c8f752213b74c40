// The picture in bytes, made where the image is: those of srgb_bytes for any pixel.
#include "passes/tone_map.h"

#include <gtest/gtest.h>

#include <random>

#include "base/error.h"
#include "base/image.h"
#include "cl/transfer.h"
#include "passes/read_back.h"
#include "plan/settings/picture.h"
#include "renderer/render_view.h"
#include "support/devices.h"
#include "support/small_scene.h"

namespace lightgrid {
namespace {

// All kinds of floats: dark and bright light, negative, infinite, not a number; greys around each step of the
// display.
Image all_kinds(int width, int height) {
  Image image(width, height);
  std::mt19937 random(7);
  const float odd[] = {0.f, -0.f, -1.f, 1e-40f, 1e30f, 3e38f, INFINITY, -INFINITY, NAN, 0.08f, 0.76f, 0.8f};
  std::uniform_real_distribution<float> unit(0, 1), exponent(-20, 12);
  for (size_t i = 0; i < image.pixels.size(); ++i) {
    glm::vec4& p = image.pixels[i];
    for (int c = 0; c < 3; ++c) p[c] = i % 3 == 0 ? unit(random) : std::exp2(exponent(random));
    if (i % 3 == 1)
      p = glm::vec4(srgb_thresholds()[random() % 256] * (1 + 1e-6f * float(int(random() % 5) - 2)));
    if (i % 7 == 0) p[int(i / 7 % 3)] = odd[random() % std::size(odd)];
    p.w = unit(random);
  }
  return image;
}

struct Given {
  Given(Renderer& renderer, int width, int height, double ev)
      : scene(small_scene().scene),
        gpu(renderer, scene),
        view(renderer, gpu, small_view(width, height), bytes_at(ev),
             {.surfaces = {.opengl = renderer.gl != nullptr}}) {}
  static Settings bytes_at(double ev) {
    Settings settings;
    settings.set(setting::picture, PictureFormat::bytes);
    settings.set(setting::display_ev, ev);
    return settings;
  }
  std::vector<glm::u8vec4> picture(const ShadedImage& image) {
    std::vector<glm::u8vec4> pixels;
    HostPicture(view, tone_map(view, view.caches.tone_map, image), pixels).keep();
    return pixels;
  }

  Scene scene;
  GpuScene gpu;
  RenderView view;
};

std::vector<glm::u8vec4> by_opencl(Renderer& renderer, const Image& image, double ev) {
  Given given(renderer, image.width, image.height, ev);
  SharedBuffer& light = given.view.shared_pixels("light", 16);
  write_buffer(*renderer.cl, "light", light.cl_buffer(), image.pixels.data(), image.pixels.size() * 16);
  return given.picture({0, &light});
}

std::vector<glm::u8vec4> by_opengl(Renderer& renderer, const Image& image, double ev) {
  Given given(renderer, image.width, image.height, ev);
  const GLuint light = given.view.targets.resolved("light", GL_RGBA32F);
  glTextureSubImage2D(light, 0, 0, 0, image.width, image.height, GL_RGBA, GL_FLOAT, image.pixels.data());
  return given.picture({given.view.targets.framebuffer({light}, 0)});
}

struct Differences {
  size_t channels = 0;
  int largest = 0;
};

Differences from_host(const std::vector<glm::u8vec4>& picture, const Image& image, double ev) {
  const std::vector<uint8_t> bytes = srgb_bytes(image, {ev});
  Differences found;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const glm::u8vec4 pixel = picture[size_t(y) * image.width + x];
      const uint8_t* expected = &bytes[(size_t(image.height - 1 - y) * image.width + x) * 3];
      for (int c = 0; c < 3; ++c) {
        const int apart = std::abs(int(pixel[c]) - int(expected[c]));
        found.channels += apart > 0;
        found.largest = std::max(found.largest, apart);
      }
      EXPECT_EQ(pixel.w, 255);
    }
  }
  return found;
}

constexpr PixelGrid sizes[] = {{1, 1}, {17, 9}, {1279, 721}};

TEST(ToneMapPass, HasTheBytesOfTheHostsInOpenCl) {
  for (const PixelGrid& size : sizes) {
    for (const double ev : {0.0, -2.5, 3.0}) {
      const Image image = all_kinds(size.width, size.height);
      EXPECT_EQ(from_host(by_opencl(opencl_devices(), image, ev), image, ev).channels, 0u)
          << size.width << " " << ev;
    }
  }
}

// A GPU's OpenGL may divide less exactly, and then a value at a step's edge falls to its other side.
TEST(ToneMapPass, HasTheBytesOfTheHostsInOpenGl) {
  for (const PixelGrid& size : sizes) {
    for (const double ev : {0.0, -2.5, 3.0}) {
      const Image image = all_kinds(size.width, size.height);
      const Differences found = from_host(by_opengl(test_devices(), image, ev), image, ev);
      const bool exact = test_devices().gl->software;
      EXPECT_LE(found.largest, exact ? 0 : 1) << size.width << " " << ev;
      EXPECT_LE(double(found.channels), (exact ? 0 : 1e-3) * 3 * double(image.pixels.size())) << ev;
    }
  }
}

TEST(ToneMapPass, NeedsAnExposure) {
  Settings settings = Given::bytes_at(0);
  check_picture(settings);
  settings.set(setting::display_ev, std::nullopt);
  EXPECT_THROW(check_picture(settings), Error);
  settings.set(setting::picture, PictureFormat::floats);
  check_picture(settings);
}

}  // namespace
}  // namespace lightgrid
