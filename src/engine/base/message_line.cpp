#include "base/message_line.h"

#include <algorithm>

namespace lightgrid {
namespace {

constexpr size_t longest_part = 240, longest_line = 2000;

bool inside_character(char c) { return (static_cast<unsigned char>(c) & 0xc0) == 0x80; }

// Two thirds of the room go to the beginning; characters of UTF-8 stay whole.
std::string ends_of(const std::string& text, size_t longest) {
  if (text.size() <= longest) return text;
  size_t head = longest * 2 / 3, tail = text.size() - (longest - head);
  while (head > 0 && inside_character(text[head])) --head;
  while (tail < text.size() && inside_character(text[tail])) ++tail;
  return text.substr(0, head) + "…" + text.substr(tail);
}

// The parts between these characters, shortened.
std::string with_short_parts(const std::string& text, char separator) {
  std::string out;
  for (size_t at = 0; at <= text.size();) {
    const size_t end = std::min(text.find(separator, at), text.size());
    out += ends_of(text.substr(at, end - at), longest_part);
    if (end < text.size()) out += separator;
    at = end + 1;
  }
  return out;
}

// Parts between quotes; what is not quoted is left to its words.
std::string with_short_quotes(const std::string& text) {
  std::string out;
  bool quoted = false;
  for (size_t at = 0; at <= text.size(); quoted = !quoted) {
    const size_t end = std::min(text.find('"', at), text.size());
    const std::string part = text.substr(at, end - at);
    out += quoted && end < text.size() ? ends_of(part, longest_part) : part;
    if (end < text.size()) out += '"';
    at = end + 1;
  }
  return out;
}

}  // namespace

std::string message_line(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  while (!text.empty() && text.back() == ' ') text.pop_back();
  if (text.size() <= longest_part) return text;
  return ends_of(with_short_parts(with_short_quotes(text), ' '), longest_line);
}

}  // namespace lightgrid
