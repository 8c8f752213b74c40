#include "base/write_file.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "base/error.h"

namespace lightgrid {
namespace {

namespace fs = std::filesystem;

// Returns 0, or the errno of the call that failed.
int write_to(const fs::path& path, const void* data, size_t size) {
  errno = 0;
  std::FILE* file = std::fopen(path.c_str(), "wb");
  if (!file) return errno;
  const bool written = (size == 0 || std::fwrite(data, 1, size, file) == size) && std::fflush(file) == 0;
  const int failure = written ? 0 : (errno ? errno : EIO);
  const bool closed = std::fclose(file) == 0;
  return failure ? failure : closed ? 0 : (errno ? errno : EIO);
}

// Such as /dev/stdout, a link to whatever stdout is.
bool is_in_system_folder(const fs::path& path) {
  std::error_code failure;
  const fs::path folder = fs::weakly_canonical(fs::absolute(path, failure).parent_path(), failure);
  const auto below = [&](const fs::path& root) {
    return std::mismatch(root.begin(), root.end(), folder.begin(), folder.end()).first == root.end();
  };
  return below("/dev") || below("/proc");
}

fs::path partial_of(fs::path path) { return path += fmt::format(".{}.part", getpid()); }

void write_whole(const fs::path& path, const void* data, size_t size) {
  std::error_code ignored;
  const auto at_path = fs::symlink_status(path, ignored).type();
  if (fs::is_directory(path, ignored)) throw input_error("{}: is a folder, not a file", path.string());
  const bool replaceable = at_path == fs::file_type::regular || at_path == fs::file_type::not_found ||
                           at_path == fs::file_type::none ||
                           (at_path == fs::file_type::symlink && !is_in_system_folder(path));
  if (!replaceable) {
    if (const int failure = write_to(path, data, size)) throw write_error(path, failure);
    return;
  }
  const fs::path partial = partial_of(path);
  int failure = write_to(partial, data, size);
  if (!failure && std::rename(partial.c_str(), path.c_str()) != 0) failure = errno;
  if (failure) {
    fs::remove(partial, ignored);
    throw write_error(path, failure);
  }
}

ErrorKind kind_of(int code) {
  const bool full = code == ENOSPC || code == EDQUOT || code == EFBIG;
  const bool machine = full || code == EIO || code == EMFILE || code == ENFILE;
  return machine ? ErrorKind::machine : ErrorKind::input;
}

}  // namespace

Error write_error(const fs::path& path, int code) {
  return {kind_of(code), fmt::format("{}: cannot be written: {}", path.string(), std::strerror(code))};
}

void write_file(const fs::path& path, const std::vector<uint8_t>& bytes) {
  write_whole(path, bytes.data(), bytes.size());
}

void write_file(const fs::path& path, std::string_view text) { write_whole(path, text.data(), text.size()); }

void write_files(const fs::path& folder, std::span<const NamedBytes> files,
                 std::span<const char* const> outdated) {
  std::error_code ignored;
  const auto fail = [&](const fs::path& path, int code) {
    for (const NamedBytes& file : files) fs::remove(partial_of(folder / file.name), ignored);
    throw write_error(path, code);
  };
  for (const auto& [name, bytes] : files) {
    if (fs::is_directory(folder / name, ignored)) fail(folder / name, EISDIR);
    if (const int failure = write_to(partial_of(folder / name), bytes.data(), bytes.size()))
      fail(folder / name, failure);
  }
  const auto remove = [&](const fs::path& path) {
    if (std::remove(path.c_str()) != 0 && errno != ENOENT) fail(path, errno);
  };
  remove(folder / files[0].name);
  for (const char* name : outdated) remove(folder / name);
  for (size_t i = files.size(); i-- > 0;) {
    const fs::path path = folder / files[i].name;
    if (std::rename(partial_of(path).c_str(), path.c_str()) != 0) fail(path, errno);
  }
}

void make_folder(const fs::path& path) {
  std::error_code failure, unreadable;
  fs::create_directories(path, failure);
  if (!fs::is_directory(path, unreadable)) {
    if (!failure) failure = unreadable;
    const auto why = failure ? failure.message() : std::string("it is a file");
    throw Error(kind_of(failure.value()), fmt::format("{}: cannot be made a folder: {}", path.string(), why));
  }
  if (access(path.c_str(), W_OK | X_OK) != 0) {
    throw input_error("{}: no file can be made in it: {}", path.string(), std::strerror(errno));
  }
}

}  // namespace lightgrid
