#include "renderer/device_clock.h"

#include <algorithm>

#include "gl/gl.h"

namespace lightgrid {
namespace {

bool is_hand_over(const std::string& pass) { return pass.ends_with("_to_gl") || pass.ends_with("_to_cl"); }

}  // namespace

DeviceClock::DeviceClock(Renderer& renderer) : renderer_(renderer) {
  GLint bits = 0;
  if (renderer.gl) glGetQueryiv(GL_TIMESTAMP, GL_QUERY_COUNTER_BITS, &bits);
  gl_has_clock_ = bits > 0;
}

DeviceClock::~DeviceClock() {
  if (!queries_.empty()) glDeleteQueries(GLsizei(queries_.size()), queries_.data());
}

void DeviceClock::start() {
  spans_.clear();
  open_.clear();
  span_depth_.reset();
  used_ = 0;
  ClProfiler& profiler = renderer_.cl->profiler();
  profiler.collect_each();  // events of a frame that failed
  profiler.time_launches(true);
  profiler.time_copies(true);
}

void DeviceClock::mark(Span& span, int end) {
  span.events[end] = renderer_.cl->profiler().pending();
  if (!span.in_gl) {
    if (end == 0) host_ = {};
    span.host_ms = host_.elapsed_ms();
    return;
  }
  if (used_ == queries_.size()) glCreateQueries(GL_TIMESTAMP, 1, &queries_.emplace_back());
  span.queries[end] = queries_[used_++];
  glQueryCounter(span.queries[end], GL_TIMESTAMP);
}

void DeviceClock::begin(const std::string& name, const std::string& on) {
  open_.push_back(on);
  if (on == "cl" || span_depth_) return;
  span_depth_ = open_.size();
  spans_.push_back({.name = name, .in_gl = on == "gl"});
  mark(spans_.back(), 0);
}

void DeviceClock::end() {
  if (span_depth_ == open_.size()) {
    mark(spans_.back(), 1);
    span_depth_.reset();
  }
  open_.pop_back();
}

std::optional<DeviceTimes> DeviceClock::stop() {
  ClProfiler& profiler = renderer_.cl->profiler();
  profiler.time_launches(false);
  profiler.time_copies(false);
  const std::vector<ClProfiler::Timed> events = profiler.collect_each();
  const auto in_gl = [](const Span& span) { return span.in_gl; };
  if (!gl_has_clock_ && std::ranges::any_of(spans_, in_gl)) return {};
  DeviceTimes times;
  const auto add = [&](const std::string& name, bool hand_over, bool copy, double ms) {
    const bool read_back = name == read_back_pass || name == read_back_copy;
    (read_back   ? times.read_back_ms
     : hand_over ? times.hand_over_ms
     : copy      ? times.copy_ms
                 : times.device_ms) += ms;
  };
  for (const Span& span : spans_) {
    double ms = span.host_ms;
    if (span.in_gl) {
      GLuint64 ns[2] = {};
      for (int end = 0; end < 2; ++end) glGetQueryObjectui64v(span.queries[end], GL_QUERY_RESULT, &ns[end]);
      ms = 1e-6 * double(ns[1] - ns[0]);
    }
    add(span.name, is_hand_over(span.name), false, ms);
  }
  for (size_t i = 0; i < events.size(); ++i) {
    const bool in_span = std::ranges::any_of(
        spans_, [&](const Span& span) { return span.events[0] <= i && i < span.events[1]; });
    const ClProfiler::Timed& event = events[i];
    if (!in_span) add(event.label, event.label.starts_with("hand_to_"), event.copy, event.ms);
  }
  return times;
}

}  // namespace lightgrid
