// The machine's side of rendering: lives as long as the program, longer than scenes and views.
#pragma once

#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "bridge/pixel_copies.h"
#include "bridge/shared_buffer.h"
#include "cl/program_cache.h"
#include "cl/tuned_sizes.h"
#include "gl/context.h"
#include "gl/objects.h"

namespace lightgrid {

// Work that a moving camera should not cause. Totals since the renderer was created.
struct RendererCounts {
  int gl_programs = 0;     // GLSL programs compiled and linked
  int cl_programs = 0;     // OpenCL programs built or loaded from disk
  size_t scene_bytes = 0;  // geometry, materials and textures uploaded
};

class Renderer {
 public:
  // Opens both devices. Throws Error(machine) without an OpenCL device, or without the OpenGL backend that is
  // named. Without any (automatic), and with none, `gl` is null.
  Renderer(const std::string& cl_substring, GlBackend backend);
  // With a current context, such as a window's.
  Renderer(const std::string& cl_substring, std::unique_ptr<GlContext> context);
  Renderer(Renderer&&) = default;
  // Makes its context current, since its programs are deleted there.
  ~Renderer();

  // Throws Error(machine) without OpenGL: why, and what to install.
  void require_gl() const;

  std::unique_ptr<GlContext> gl;  // null: without OpenGL, for this reason:
  std::string why_no_gl;
  std::unique_ptr<ClDevice> cl;
  std::unique_ptr<ProgramCache> kernels;
  BridgeKind bridge = BridgeKind::none;
  PixelCopies pixel_copies;  // by shader where the bridge is imported memory
  TunedSizes tuned{};        // sizes for settings that are not given

  // A GLSL program, compiled at first use: embedded shader files, each after one "#define" per name.
  const GlProgram& program(const std::string& vertex, const std::string& fragment,
                           const std::vector<std::string>& defines);

  RendererCounts counts() const;
  // From now on the set receives the name and the defines of each program and kernel in use; null: no longer.
  void note_programs(std::set<std::string>* asked) {
    asked_ = asked;
    kernels->note_kernels(asked);
  }
  void note_scene_bytes(size_t bytes) const { scene_bytes_ += bytes; }

 private:
  struct OpenGl {
    std::unique_ptr<GlContext> context;
    std::string why_not;
  };
  static OpenGl open_gl(GlBackend backend);
  Renderer(const std::string& cl_substring, OpenGl opened);

  std::map<std::string, GlProgram> programs_;
  mutable size_t scene_bytes_ = 0;
  std::set<std::string>* asked_ = nullptr;
};

}  // namespace lightgrid
