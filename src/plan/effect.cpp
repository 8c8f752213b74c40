#include "plan/effect.h"

#include <algorithm>
#include <cctype>

namespace lightgrid {

std::string words_of(const Effect& effect) {
  std::string words = effect.name;
  std::ranges::replace(words, '_', ' ');
  return words;
}

std::string define_of(const Effect& effect) {
  std::string define = std::string("EFFECT_") + effect.name;
  std::ranges::transform(define, define.begin(), [](unsigned char c) { return char(std::toupper(c)); });
  return define;
}

}  // namespace lightgrid
