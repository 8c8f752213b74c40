#include "renderer/renderer.h"

#include "base/error.h"

namespace lightgrid {

Renderer::OpenGl Renderer::open_gl(GlBackend backend) {
  try {
    return {GlContext::create(backend), ""};
  } catch (const Error& error) {
    if (backend != GlBackend::automatic && backend != GlBackend::none) throw;
    return {nullptr, error.what()};
  }
}

Renderer::Renderer(const std::string& cl_substring, GlBackend backend)
    : Renderer(cl_substring, open_gl(backend)) {}

Renderer::Renderer(const std::string& cl_substring, std::unique_ptr<GlContext> context)
    : Renderer(cl_substring, OpenGl{std::move(context), ""}) {}

Renderer::Renderer(const std::string& cl_substring, OpenGl opened)
    : gl(std::move(opened.context)),
      why_no_gl(std::move(opened.why_not)),
      cl(std::make_unique<ClDevice>(cl_substring)),
      kernels(std::make_unique<ProgramCache>(*cl)),
      bridge(gl ? choose_bridge(*cl, *gl) : BridgeKind::none),
      pixel_copies(bridge == BridgeKind::imported),
      tuned(read_tuned_sizes(cl->info())) {}

Renderer::~Renderer() {
  if (gl && programs_.size() + size_t(pixel_copies.programs()) > 0) gl->make_current();
}

void Renderer::require_gl() const {
  if (!gl)
    throw machine_error("{}; visibility draws without it, and so do techniques with raster=opencl",
                        why_no_gl);
}

const GlProgram& Renderer::program(const std::string& vertex, const std::string& fragment,
                                   const std::vector<std::string>& defines) {
  std::string key = vertex + " " + fragment;
  for (const std::string& name : defines) key += " " + name;
  if (asked_) asked_->insert(key);
  const auto found = programs_.find(key);
  if (found != programs_.end()) return found->second;
  return programs_.try_emplace(key, vertex, fragment, defines).first->second;
}

RendererCounts Renderer::counts() const {
  const ProgramCache::Counts& built = kernels->counts();
  return {int(programs_.size()) + pixel_copies.programs(), built.built + built.from_disk, scene_bytes_};
}

}  // namespace lightgrid
