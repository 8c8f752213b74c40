// Numbers and bytes as text.
#pragma once

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lightgrid {

// The number that is the whole text; none if it is anything else, or out of the type's range.
template <typename T>
std::optional<T> parse_number(std::string_view text) {
  T value{};
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  return failure == std::errc() && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
}

// Two of them with a separator between.
template <typename T>
std::optional<std::pair<T, T>> parse_pair(std::string_view text, char separator) {
  const size_t middle = std::min(text.find(separator), text.size());
  const auto a = parse_number<T>(text.substr(0, middle));
  const auto b = middle < text.size() ? parse_number<T>(text.substr(middle + 1)) : std::nullopt;
  return a && b ? std::optional(std::pair(*a, *b)) : std::nullopt;
}

// "; did you mean NAME?" with the nearest of the names; nothing if none is near.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& names);

// "unknown field; did you mean NAME?; fields are NAME, NAME"
std::string unknown_field(std::string_view field, const std::vector<std::string>& known);

std::string xml_escaped(std::string_view text);  // for text and attributes of XML and HTML

std::string base64(const std::vector<uint8_t>& bytes);
// None if the text is not base64. The padding may be missing.
std::optional<std::vector<uint8_t>> base64_decoded(std::string_view text);

}  // namespace lightgrid
