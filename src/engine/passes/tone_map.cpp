#include "passes/tone_map.h"

#include "base/error.h"
#include "base/image.h"
#include "cl/buffers.h"
#include "cl/launch.h"
#include "plan/settings/picture.h"
#include "renderer/drawing/draw.h"

namespace lightgrid {

// The kernel and its table.
class ToneMap : public PassCache {
 public:
  explicit ToneMap(PassContext& work) : kernel_(*work.renderer.kernels, "resolve/tone_map", "") {
    const auto& least = srgb_thresholds();
    thresholds_.put(*work.renderer.cl, "uploading the curve of a display",
                    std::vector<float>(least.begin(), least.end()));
  }
  bool follow(PassContext&) override { return true; }
  size_t memory_bytes() const override { return thresholds_.bytes(); }

  void run(PassContext& work, SharedBuffer& image, float scale, SharedBuffer& picture) {
    constexpr size_t group = 64;
    const size_t pixels = work.grid().pixels();
    kernel_.launch(*work.renderer.cl, "tone_map", cl::NDRange((pixels + group - 1) / group * group),
                   cl::NDRange(group),
                   {{"image", image.cl_buffer()},
                    {"pixels", cl_uint(pixels)},
                    {"scale", scale},
                    {"min_linear", thresholds_.buffer()},
                    {"picture", picture.cl_buffer()}});
  }

 private:
  NamedKernel kernel_;
  UploadedBuffer thresholds_;
};

static GLuint color_of(GLuint framebuffer) {
  GLint texture = 0;
  glGetNamedFramebufferAttachmentParameteriv(framebuffer, GL_COLOR_ATTACHMENT0,
                                             GL_FRAMEBUFFER_ATTACHMENT_OBJECT_NAME, &texture);
  return GLuint(texture);
}

static void draw(PassContext& work, GLuint image, float scale, GLuint framebuffer) {
  const GlProgram& program = work.renderer.program("shaders/screen.vert", "shaders/tone_map.frag", {});
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glViewport(0, 0, work.view.width, work.view.height);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
  bind_sampler_object(Sampler::image, 0);
  bind_texture(Sampler::image, image);
  glUseProgram(program.name());
  glUniform1f(program.uniform("scale"), scale);
  glUniform1fv(program.uniform("min_linear"), GLsizei(srgb_thresholds().size()), srgb_thresholds().data());
  draw_screen(program);
}

void check_picture(const Settings& settings) {
  if (settings[setting::picture] == PictureFormat::bytes && !settings[setting::display_ev])
    throw input_error(
        "set picture=bytes: an automatic exposure needs the finished picture; give --exposure a number");
}

DisplayedImage tone_map(PassContext& work, Cached<ToneMap>& cache, const ShadedImage& image) {
  const float scale = Exposure{*work.plan.settings[setting::display_ev]}.scale();
  const size_t pixels = work.grid().pixels();
  DisplayedImage displayed;
  auto pass = work.timer.pass("tone_map", image.in_cl ? "cl" : "gl");
  if (image.in_cl) {
    displayed.in_cl = &work.shared_pixels("picture", 4);
    cache.of(work).run(work, *image.in_cl, scale, *displayed.in_cl);
  } else {
    displayed.framebuffer = work.targets.framebuffer({work.targets.resolved("picture", GL_RGBA8)}, 0);
    draw(work, color_of(image.framebuffer), scale, displayed.framebuffer);
  }
  pass.moves(pixels * 16, pixels * 4);
  return displayed;
}

}  // namespace lightgrid
