#include "cl/program_file.h"

#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>

#include <fmt/format.h>

namespace lightgrid {
namespace {

constexpr char magic[8] = {'l', 'g', 'r', 'i', 'd', 'c', 'l', '1'};

struct Header {
  char magic[8];
  uint64_t key_bytes, binary_bytes, checksum;
};

// FNV-1a (Fowler, Noll, Vo 1991), 64 bits.
uint64_t hash_of(const void* data, size_t bytes) {
  uint64_t hash = 0xcbf29ce484222325;
  for (size_t i = 0; i < bytes; ++i)
    hash = (hash ^ static_cast<const unsigned char*>(data)[i]) * 0x100000001b3;
  return hash;
}

}  // namespace

std::filesystem::path program_file_path(const std::filesystem::path& folder, const std::string& entry,
                                        const std::string& key) {
  return folder / fmt::format("{}-{:016x}.bin", entry, hash_of(key.data(), key.size()));
}

std::vector<unsigned char> read_program_file(const std::filesystem::path& file, const std::string& key) {
  std::ifstream stream(file, std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(stream), {}};
  Header header;
  if (bytes.size() < sizeof header) return {};
  std::memcpy(&header, bytes.data(), sizeof header);
  const size_t rest = bytes.size() - sizeof header;
  if (std::memcmp(header.magic, magic, sizeof magic) != 0 || header.key_bytes != key.size() ||
      rest < key.size() || header.binary_bytes != rest - key.size())
    return {};
  const char* text = bytes.data() + sizeof header;
  const char* binary = text + key.size();
  if (std::memcmp(text, key.data(), key.size()) != 0) return {};
  if (hash_of(binary, header.binary_bytes) != header.checksum) return {};
  return {binary, binary + header.binary_bytes};
}

void write_program_file(const std::filesystem::path& file, const std::string& key,
                        const std::vector<unsigned char>& binary) {
  static std::atomic<int> counter = 0;
  const std::filesystem::path unfinished = fmt::format("{}.{}.{}", file.string(), getpid(), counter++);
  Header header = {{}, key.size(), binary.size(), hash_of(binary.data(), binary.size())};
  std::memcpy(header.magic, magic, sizeof magic);
  std::error_code failure;
  std::filesystem::create_directories(file.parent_path(), failure);
  {
    std::ofstream stream(unfinished, std::ios::binary);
    stream.write(reinterpret_cast<const char*>(&header), sizeof header);
    stream.write(key.data(), key.size());
    stream.write(reinterpret_cast<const char*>(binary.data()), binary.size());
    stream.close();
    if (!stream) {
      std::filesystem::remove(unfinished, failure);
      return;
    }
  }
  std::filesystem::rename(unfinished, file, failure);
  if (failure) std::filesystem::remove(unfinished, failure);
}

}  // namespace lightgrid
