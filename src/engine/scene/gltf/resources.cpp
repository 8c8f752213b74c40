#include "scene/gltf/resources.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <optional>
#include <utility>

#include "base/text.h"

namespace lightgrid::gltf {
namespace {

namespace fs = std::filesystem;

class Descriptor {
 public:
  // Without O_NONBLOCK, opening a pipe without a writer would wait for ever.
  explicit Descriptor(const fs::path& path) : fd_(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {}
  ~Descriptor() {
    if (fd_ >= 0) close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return fd_; }

 private:
  int fd_;
};

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

std::optional<std::string> percent_decoded(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      out += text[i];
      continue;
    }
    if (i + 2 >= text.size()) return {};
    const int high = hex_digit(text[i + 1]), low = hex_digit(text[i + 2]);
    if (high < 0 || low < 0) return {};
    out += static_cast<char>(high * 16 + low);
    i += 2;
  }
  return out;
}

std::vector<uint8_t> read_data_uri(const Reporter& report, const std::string& place, std::string_view uri) {
  const size_t comma = uri.find(',');
  if (comma == std::string_view::npos) throw report.error("{}data URI has no comma", place);
  const std::string_view head = uri.substr(0, comma), body = uri.substr(comma + 1);
  if (head.ends_with(";base64")) {
    if (auto bytes = base64_decoded(body)) return *std::move(bytes);
    throw report.error("{}data URI is not base64", place);
  }
  if (auto text = percent_decoded(body)) return {text->begin(), text->end()};
  throw report.error("{}data URI has a broken percent code", place);
}

bool has_scheme(std::string_view uri) {
  const size_t colon = uri.find(':');
  if (colon == std::string_view::npos || colon == 0 || !std::isalpha(static_cast<unsigned char>(uri[0])))
    return false;
  return std::all_of(uri.begin(), uri.begin() + colon,
                     [](unsigned char c) { return std::isalnum(c) || c == '+' || c == '-' || c == '.'; });
}

bool is_below(const fs::path& file, const fs::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first == folder.end();
}

}  // namespace

std::vector<uint8_t> read_regular_file(const Reporter& report, const std::string& place, const fs::path& path,
                                       size_t max_bytes) {
  const Descriptor file(path);
  if (file.get() < 0) throw report.error("{}cannot be read: {}", place, std::strerror(errno));
  struct stat info = {};
  if (fstat(file.get(), &info) != 0) throw report.error("{}cannot be read: {}", place, std::strerror(errno));
  if (S_ISDIR(info.st_mode)) throw report.error("{}is a folder, not a file", place);
  if (!S_ISREG(info.st_mode)) throw report.error("{}is not a regular file", place);
  const auto size = static_cast<size_t>(info.st_size);
  if (size == 0) throw report.error("{}is empty", place);
  if (size > max_bytes) throw report.error("{}is of {} bytes; at most {} are read", place, size, max_bytes);
  std::vector<uint8_t> bytes(size);
  for (size_t done = 0; done < size;) {
    const ssize_t got = read(file.get(), bytes.data() + done, size - done);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw report.error("{}cannot be read: {}", place, std::strerror(errno));
    if (got == 0) throw report.error("{}ends at byte {} of {}", place, done, size);
    done += static_cast<size_t>(got);
  }
  return bytes;
}

FileReach reach_of(const fs::path& gltf, bool anywhere) {
  // The folder of a bare file name is an empty path, which would contain everything.
  const fs::path beside = gltf.has_parent_path() ? gltf.parent_path() : fs::path(".");
  FileReach reach{.folders = {}, .anywhere = anywhere};
  for (const fs::path& folder : {fs::weakly_canonical(gltf).parent_path(), fs::weakly_canonical(beside)})
    if (std::ranges::find(reach.folders, folder) == reach.folders.end()) reach.folders.push_back(folder);
  return reach;
}

namespace {

struct FoundFile {
  fs::path path;
  bool leaves = false;  // and must not be read
};

// The first file of this name that exists and may be read; empty if none exists. A file that leaves the
// folder is found whether it exists or not.
std::optional<FoundFile> find_file(const FileReach& reach, const std::string& name) {
  std::optional<FoundFile> outside;
  for (const fs::path& folder : reach.folders) {
    const fs::path file = fs::weakly_canonical(folder / name);
    if (!is_below(file, folder) && !reach.anywhere)
      outside = {file, true};
    else if (fs::exists(file))
      return FoundFile{file};
  }
  return outside;
}

fs::path found_path(Reporter& report, const std::string& place, const FileReach& reach,
                    const std::string& uri, const std::string& name) {
  std::optional<FoundFile> found = find_file(reach, name);
  if (!found && name.find('\\') != std::string::npos) {
    std::string slashed = name;
    std::ranges::replace(slashed, '\\', '/');
    found = find_file(reach, slashed);
    if (found && !found->leaves)
      report.warn("backslash", "{}uri \"{}\" has backslashes; read as \"{}\"", place, uri, slashed);
  }
  if (!found) throw report.error("{}file \"{}\" cannot be read: {}", place, name, std::strerror(ENOENT));
  if (found->leaves)
    throw report.error("{}uri \"{}\" leaves the folder of the glTF file; --files anywhere reads it", place,
                       uri);
  return found->path;
}

}  // namespace

std::vector<uint8_t> read_uri(Reporter& report, const std::string& place, const FileReach& reach,
                              const std::string& uri, size_t max_bytes) {
  if (uri.starts_with("data:")) {
    auto bytes = read_data_uri(report, place, uri);
    if (bytes.size() > max_bytes)
      throw report.error("{}is of {} bytes; at most {} are read", place, bytes.size(), max_bytes);
    return bytes;
  }
  if (has_scheme(uri))
    throw report.error("{}uri \"{}\": only relative paths and data URIs are read", place, uri);
  auto decoded = percent_decoded(uri);
  if (!decoded) decoded = uri;  // written without encoding
  if (decoded->empty() || decoded->find('\0') != std::string::npos)
    throw report.error("{}uri \"{}\" is not a valid path", place, uri);
  try {
    const fs::path file = found_path(report, place, reach, uri, *decoded);
    return read_regular_file(report, fmt::format("{}file \"{}\" ", place, *decoded), file, max_bytes);
  } catch (const fs::filesystem_error& failure) {  // a name too long, links in a circle
    throw report.error("{}uri \"{}\": {}", place, uri, failure.code().message());
  }
}

std::function<std::pair<std::vector<uint8_t>, std::string>(const std::string& where, const std::string& uri)>
property_files(const fs::path& file, bool anywhere) {
  constexpr size_t max_bytes = size_t(64) << 20;
  return [=](const std::string& where, const std::string& uri) {
    Reporter report(where);
    std::vector<uint8_t> bytes = read_uri(report, "", reach_of(file, anywhere), uri, max_bytes);
    const fs::path folder = fs::absolute(file).parent_path();
    return std::pair(std::move(bytes),
                     uri.starts_with("data:") ? uri : (folder / uri).lexically_normal().string());
  };
}

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
