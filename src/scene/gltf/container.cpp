#include "scene/gltf/container.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace lightgrid::gltf {
namespace {

constexpr uint32_t magic_gltf = 0x46546c67, type_json = 0x4e4f534a, type_bin = 0x004e4942;
constexpr size_t header_bytes = 12, chunk_header_bytes = 8;

uint32_t u32_at(std::span<const uint8_t> bytes, size_t at) {
  return bytes[at] | bytes[at + 1] << 8 | bytes[at + 2] << 16 | uint32_t(bytes[at + 3]) << 24;
}

}  // namespace

Container open_container(const Reporter& report, std::span<const uint8_t> bytes) {
  if (bytes.size() < 4 || u32_at(bytes, 0) != magic_gltf) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const size_t bom = text.starts_with("\xef\xbb\xbf") ? 3 : 0;
    const size_t first = text.find_first_not_of(" \t\r\n", bom);
    if (first == std::string_view::npos || text[first] != '{')
      throw report.error("is neither a GLB file nor a JSON object");
    return {.json = text.substr(bom), .is_glb = false};
  }
  if (bytes.size() < header_bytes) throw report.error("GLB header is cut off after {} bytes", bytes.size());
  const uint32_t version = u32_at(bytes, 4), length = u32_at(bytes, 8);
  if (version != 2) throw report.error("GLB version is {}; only 2 is read", version);
  if (length < header_bytes || length > bytes.size())
    throw report.error("GLB length is {}, but the file has {} bytes", length, bytes.size());

  Container out{.is_glb = true};
  bool has_binary = false;
  int chunk = 0;
  for (size_t at = header_bytes; at < length; ++chunk) {
    if (length - at < chunk_header_bytes) throw report.error("GLB chunk {} has no whole header", chunk);
    const uint32_t size = u32_at(bytes, at), type = u32_at(bytes, at + 4);
    at += chunk_header_bytes;
    if (size > length - at)
      throw report.error("GLB chunk {} has {} bytes, but only {} are left", chunk, size, length - at);
    const auto body = bytes.subspan(at, size);
    at += size;
    if (chunk == 0 && type != type_json) throw report.error("GLB chunk 0 is not JSON");
    if (chunk == 0) out.json = {reinterpret_cast<const char*>(body.data()), body.size()};
    if (type == type_bin && !std::exchange(has_binary, true)) out.binary = body;
  }
  if (chunk == 0) throw report.error("GLB has no chunk");
  return out;
}

}  // namespace lightgrid::gltf
