#include "base/text.h"

#include <algorithm>
#include <array>

namespace lightgrid {

static constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

// Letters to change, insert, remove or exchange with a neighbour. Case, - and _ count as equal.
static size_t letters_apart(std::string_view a, std::string_view b) {
  const auto plain = [](char c) { return c == '-' ? '_' : c >= 'A' && c <= 'Z' ? char(c + 32) : c; };
  std::vector<std::vector<size_t>> apart(a.size() + 1, std::vector<size_t>(b.size() + 1));
  for (size_t i = 0; i <= a.size(); ++i) {
    for (size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        apart[i][j] = i + j;
        continue;
      }
      const bool same = plain(a[i - 1]) == plain(b[j - 1]);
      apart[i][j] = std::min({apart[i - 1][j] + 1, apart[i][j - 1] + 1, apart[i - 1][j - 1] + !same});
      if (i > 1 && j > 1 && plain(a[i - 1]) == plain(b[j - 2]) && plain(a[i - 2]) == plain(b[j - 1]))
        apart[i][j] = std::min(apart[i][j], apart[i - 2][j - 2] + 1);
    }
  }
  return apart[a.size()][b.size()];
}

std::string did_you_mean(std::string_view word, const std::vector<std::string>& names) {
  constexpr size_t longest = 64;
  if (word.size() > longest) return {};
  size_t least = std::min(std::max<size_t>(word.size() / 2, 2) + 1, word.size());
  const std::string* nearest = nullptr;
  for (const std::string& name : names) {
    const bool begins = word.size() > 2 && name.starts_with(word);
    if (const size_t apart = begins ? 0 : letters_apart(word, name); apart < least) {
      least = apart;
      nearest = &name;
    }
  }
  return nearest ? "; did you mean " + *nearest + "?" : "";
}

std::string unknown_field(std::string_view field, const std::vector<std::string>& known) {
  std::string text = "unknown field" + did_you_mean(field, known) + "; fields are ";
  for (const std::string& name : known) text += (&name == known.data() ? "" : ", ") + name;
  return text;
}

std::string xml_escaped(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '&')
      escaped += "&amp;";
    else if (c == '<')
      escaped += "&lt;";
    else if (c == '"')
      escaped += "&quot;";
    else
      escaped += c;
  }
  return escaped;
}

std::string base64(const std::vector<uint8_t>& bytes) {
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (size_t i = 0; i < bytes.size(); i += 3) {
    const size_t left = bytes.size() - i;
    const uint32_t group =
        bytes[i] << 16 | (left > 1 ? bytes[i + 1] << 8 : 0) | (left > 2 ? bytes[i + 2] : 0);
    text += digits[group >> 18];
    text += digits[group >> 12 & 63];
    text += left > 1 ? digits[group >> 6 & 63] : '=';
    text += left > 2 ? digits[group & 63] : '=';
  }
  return text;
}

std::optional<std::vector<uint8_t>> base64_decoded(std::string_view text) {
  static const auto values = [] {
    std::array<int8_t, 256> table;
    table.fill(-1);
    for (size_t i = 0; i < digits.size(); ++i)
      table[static_cast<uint8_t>(digits[i])] = static_cast<int8_t>(i);
    return table;
  }();
  for (int pad = 0; pad < 2 && text.ends_with('='); ++pad) text.remove_suffix(1);
  if (text.size() % 4 == 1) return {};
  std::vector<uint8_t> out;
  out.reserve(text.size() / 4 * 3 + 2);
  uint32_t bits = 0;
  int bit_count = 0;
  for (char c : text) {
    const int value = values[static_cast<uint8_t>(c)];
    if (value < 0) return {};
    bits = bits << 6 | static_cast<uint32_t>(value);
    if ((bit_count += 6) >= 8) out.push_back(static_cast<uint8_t>(bits >> (bit_count -= 8)));
  }
  return out;
}

}  // namespace lightgrid
