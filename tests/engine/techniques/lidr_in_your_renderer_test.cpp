// docs/lidr_in_your_renderer.md: the shaders of the page, in a renderer of a few lines, show the picture of lidr.
#include <cmath>

#include "gl/bindings.h"
#include "plan/settings/model.h"
#include "support/paths.h"
#include "support/read_files.h"
#include "support/small_scene.h"
#include "techniques/rendering.h"

namespace lightgrid {
namespace {

// The page's blocks of GLSL, in order.
std::vector<std::string> blocks_of_page() {
  const std::string page = file_bytes(std::filesystem::path(source_folder) / "docs/lidr_in_your_renderer.md");
  std::vector<std::string> blocks;
  const std::string fence = "```glsl\n";
  for (size_t at = page.find(fence); at != std::string::npos; at = page.find(fence, at)) {
    at += fence.size();
    blocks.push_back(page.substr(at, page.find("```", at) - at));
  }
  return blocks;
}

GLuint page_shader(GLenum stage, const std::string& source) {
  const GLuint shader = glCreateShader(stage);
  const std::string text = "#version 450 core\n" + source;
  const char* pointer = text.c_str();
  glShaderSource(shader, 1, &pointer, nullptr);
  glCompileShader(shader);
  GLint good = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
  char log[4096] = "";
  glGetShaderInfoLog(shader, sizeof log, nullptr, log);
  EXPECT_TRUE(good) << log << text;
  return shader;
}

GLuint page_program(const std::string& fragment) {
  const GLuint program = glCreateProgram();
  glAttachShader(program, page_shader(GL_VERTEX_SHADER, R"(
    void main() { gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.5, 1.0); })"));
  glAttachShader(program, page_shader(GL_FRAGMENT_SHADER, fragment));
  glLinkProgram(program);
  GLint good = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &good);
  EXPECT_TRUE(good);
  return program;
}

constexpr int page_width = 64, page_height = 40, lamp_count = 6;
constexpr float page_wall_z = -4, lamp_range = 1;

// A wall that fills the view, and lamp_count in front of it, of which at most four reach a pixel.
Scene wall_with_lamps() {
  Scene scene;
  scene.ambient = {0, 0, 0};
  const int material = add_material(scene, "wall", {0.8f, 0.7f, 0.6f}, 0, 1);
  add_instance(scene, "wall", add_mesh(scene, wall_mesh({0, 0, page_wall_z}, 8, material, "wall")));
  for (int i = 0; i < lamp_count; ++i)
    add_point(scene, "lamp", {-1.5 + 0.6 * i, 0.3 * (i % 2), -3.7}, {1, 0.2f * float(i), 0.5f}, 2,
              lamp_range);
  return scene;
}

// What a renderer has of its own: the light of lamp i on the wall, which is Lambert.
std::string lamp_text(const Scene& scene, const View& view) {
  std::string lights;
  for (const Light& l : scene.lights)
    lights += fmt::format("{} vec3({}, {}, {}), vec3({}, {}, {})", lights.empty() ? "" : ",", l.position.x,
                          l.position.y, l.position.z, l.color.r * l.intensity, l.color.g * l.intensity,
                          l.color.b * l.intensity);
  return fmt::format(R"(
    const vec3 lights[{}] = vec3[]({});
    vec3 light_from(int i) {{
      vec2 ndc = gl_FragCoord.xy * 2.0 / vec2({}, {}) - 1.0;
      vec3 position = vec3(ndc * {} / vec2({}, {}), {});
      vec3 to_light = lights[2 * i] - position;
      float d = length(to_light);
      return vec3(0.8, 0.7, 0.6) / 3.14159265 * lights[2 * i + 1] * to_light.z / d *
             max(1.0 - pow(d / {}, 4.0), 0.0) / (d * d);
    }}
    )",
                     2 * lamp_count, lights, page_width, page_height, -page_wall_z, view.clip_from_view[0][0],
                     view.clip_from_view[1][1], page_wall_z, lamp_range);
}

struct PageTargets {
  GlTexture image = make_texture_2d(GL_RGBA8, page_width, page_height);
  GlTexture depth = make_texture_2d(GL_DEPTH32F_STENCIL8, page_width, page_height);
  GlTexture shaded = make_texture_2d(GL_RGBA32F, page_width, page_height);
  GlFramebuffer indices = make_framebuffer({image.name()}, 0);
  GlFramebuffer picture = make_framebuffer({shaded.name()}, 0);
  PageTargets() { glNamedFramebufferTexture(indices.name(), GL_DEPTH_STENCIL_ATTACHMENT, depth.name(), 0); }
};

// The rectangle of pixels around what a lamp reaches on the wall stands for its volume.
void scissor_volume(const Light& light, const View& view) {
  const double before = light.position.z - page_wall_z,
               reach = std::sqrt(lamp_range * lamp_range - before * before);
  const auto pixel = [&](double x, double scale, int size) {
    return (x / -page_wall_z * scale + 1) * size / 2;
  };
  const int left = int(std::floor(pixel(light.position.x - reach, view.clip_from_view[0][0], page_width))),
            right = int(std::ceil(pixel(light.position.x + reach, view.clip_from_view[0][0], page_width))),
            low = int(std::floor(pixel(light.position.y - reach, view.clip_from_view[1][1], page_height))),
            high = int(std::ceil(pixel(light.position.y + reach, view.clip_from_view[1][1], page_height)));
  glScissor(left, low, right - left, high - low);
}

Image draw_by_the_page(const Scene& scene, const View& view) {
  const std::vector<std::string> blocks = blocks_of_page();
  EXPECT_EQ(blocks.size(), 2u);
  const GLuint light_pass = page_program(blocks.at(0)),
               forward = page_program(lamp_text(scene, view) + blocks.at(1) +
                                      "out vec4 color; void main() { color = vec4(sum_of_lights(), 1.0); }");
  reset_gl_state();
  const PageTargets targets;
  const GlVertexArray array = make_vertex_array();
  glBindVertexArray(array.name());
  glViewport(0, 0, page_width, page_height);
  glBindFramebuffer(GL_FRAMEBUFFER, targets.indices.name());
  const float nothing[4] = {0, 0, 0, 0};
  const GLint no_light = 0;
  glClearNamedFramebufferfv(targets.indices.name(), GL_COLOR, 0, nothing);
  glClearNamedFramebufferiv(targets.indices.name(), GL_STENCIL, 0, &no_light);
  // The page's state.
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_CONSTANT_COLOR);
  glBlendColor(0.25f, 0.25f, 0.25f, 0.25f);
  glEnable(GL_STENCIL_TEST);
  glStencilFunc(GL_GREATER, 4, 0xff);
  glStencilOp(GL_KEEP, GL_KEEP, GL_INCR);
  glEnable(GL_SCISSOR_TEST);
  glUseProgram(light_pass);
  for (GLuint i = 0; i < lamp_count; ++i) {
    glUniform1ui(glGetUniformLocation(light_pass, "light"), i);
    scissor_volume(scene.lights[i], view);
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_BLEND);
  glDisable(GL_STENCIL_TEST);
  glBindFramebuffer(GL_FRAMEBUFFER, targets.picture.name());
  glBindTextureUnit(0, targets.image.name());
  glUseProgram(forward);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  Image image(page_width, page_height);
  glReadBuffer(GL_COLOR_ATTACHMENT0);
  glReadPixels(0, 0, page_width, page_height, GL_RGBA, GL_FLOAT, image.pixels.data());
  glUseProgram(0);
  glDeleteProgram(light_pass);
  glDeleteProgram(forward);
  reset_gl_state();
  return image;
}

TEST(LidrInYourRenderer, ShowsThePictureOfLidr) {
  test_devices().require_gl();
  const Scene scene = wall_with_lamps();
  const View view = small_view(page_width, page_height);
  const Image expected = render(scene, view, "lidr", assigned("brdf=lambert lidr-order=scene"));
  ASSERT_GT(brightest_channel(expected), 0.1f);
  EXPECT_LT(compare_images(draw_by_the_page(scene, view), expected).max_rel, 1e-4);
}

}  // namespace
}  // namespace lightgrid
