#include "scene/gltf/resources.h"
#include "base/text.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <optional>

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

std::vector<uint8_t> read_uri(const Reporter& report, const std::string& place, const fs::path& folder,
                              const std::string& uri, size_t max_bytes) {
  if (uri.starts_with("data:")) {
    auto bytes = read_data_uri(report, place, uri);
    if (bytes.size() > max_bytes)
      throw report.error("{}is of {} bytes; at most {} are read", place, bytes.size(), max_bytes);
    return bytes;
  }
  if (has_scheme(uri))
    throw report.error("{}uri \"{}\": only relative paths and data URIs are read", place, uri);
  const auto decoded = percent_decoded(uri);
  if (!decoded || decoded->empty() || decoded->find('\0') != std::string::npos)
    throw report.error("{}uri \"{}\" is not a valid path", place, uri);
  std::error_code failed;
  // The folder of a bare file name is an empty path, which would contain everything.
  const fs::path root = fs::weakly_canonical(folder.empty() ? "." : folder, failed);
  const fs::path file = failed ? fs::path() : fs::weakly_canonical(root / *decoded, failed);
  if (failed) throw report.error("{}uri \"{}\": {}", place, uri, failed.message());
  if (!is_below(file, root))
    throw report.error("{}uri \"{}\" leaves the folder of the glTF file", place, uri);
  return read_regular_file(report, fmt::format("{}file \"{}\" ", place, *decoded), file, max_bytes);
}

}  // namespace lightgrid::gltf
