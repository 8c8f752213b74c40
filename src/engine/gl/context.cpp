#include "gl/context.h"

#include <cstdio>
#include <cstdlib>
#include <functional>

#include "base/error.h"
#include "gl/gl.h"

namespace lightgrid {
namespace {

std::string gl_string(GLenum name) {
  const GLubyte* text = glGetString(name);
  return text ? reinterpret_cast<const char*>(text) : "";
}

#ifndef NDEBUG
// Aborts rather than throws: the driver's C frames lie between here and the call. Shader compiler messages
// and out-of-memory errors also arrive here; the caller checks for both.
void APIENTRY on_debug_message(GLenum source, GLenum type, GLuint, GLenum, GLsizei, const GLchar* message,
                               const void*) {
  if (source != GL_DEBUG_SOURCE_API || type != GL_DEBUG_TYPE_ERROR) return;
  if (std::string_view(message).find("OUT_OF_MEMORY") != std::string_view::npos) return;
  std::fprintf(stderr, "OpenGL: %s\n", message);
  std::abort();
}
#endif

}  // namespace

GlBackend parse_gl_backend(const std::string& name) {
  if (name == "auto") return GlBackend::automatic;
  if (name == "osmesa") return GlBackend::osmesa;
  if (name == "egl") return GlBackend::egl;
  if (name == "none") return GlBackend::none;
  throw input_error("gl: \"{}\" is not one of auto, osmesa, egl, none", name);
}

void GlContext::begin(const std::string& name, const std::function<void()>& release) {
  backend = name;
  try {
    make_current();
    describe();
  } catch (...) {
    release();
    throw;
  }
}

void GlContext::describe() {
  vendor = gl_string(GL_VENDOR);
  renderer = gl_string(GL_RENDERER);
  version = gl_string(GL_VERSION);
  software = renderer.find("llvmpipe") != std::string::npos ||
             renderer.find("softpipe") != std::string::npos || renderer.find("swrast") != std::string::npos;
  GLint major = 0, minor = 0;
  glGetIntegerv(GL_MAJOR_VERSION, &major);
  glGetIntegerv(GL_MINOR_VERSION, &minor);
  if (major * 10 + minor < 45)
    throw machine_error("{} offers OpenGL {}.{}, below 4.5", renderer, major, minor);
#ifndef NDEBUG
  glEnable(GL_DEBUG_OUTPUT);
  glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
  glDebugMessageCallback(on_debug_message, nullptr);
#endif
}

std::unique_ptr<GlContext> GlContext::create(GlBackend backend) {
  using Attempt = std::function<std::unique_ptr<GlContext>()>;
  const Attempt osmesa = create_osmesa_context;
  const Attempt egl = [] { return create_egl_context(false); };
  const Attempt egl_hardware = [] { return create_egl_context(true); };
  std::vector<std::pair<std::string, Attempt>> attempts;
  switch (backend) {
    case GlBackend::none:
      throw machine_error("gl none: OpenGL is left out");
    case GlBackend::osmesa:
      attempts = {{"osmesa", osmesa}};
      break;
    case GlBackend::egl:
      attempts = {{"egl", egl}};
      break;
    case GlBackend::automatic:
      attempts = {{"egl on hardware", egl_hardware}, {"osmesa", osmesa}, {"egl", egl}};
      break;
  }
  std::string tried;
  for (const auto& [name, attempt] : attempts) {
    try {
      return attempt();
    } catch (const Error& error) {
      tried += fmt::format("{}{}: {}", tried.empty() ? "" : "; ", name, error.what());
    }
  }
  throw machine_error(
      "no OpenGL 4.5 context ({}). Debian packages that bring one without a GPU: libosmesa6, or libegl1 with "
      "libgl1-mesa-dri",
      tried);
}

}  // namespace lightgrid
