// The settings that trade accuracy for time, by the names of the command line
// (docs/command_line.md#settings). Each is one row, a static object: in plan/settings/ if several techniques
// or passes read it, else in the file that reads it.
#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <cstring>
#include <functional>
#include <initializer_list>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace lightgrid {

class Settings;

// How a setting affects pictures and other settings. Conditions are evaluated only for techniques that read
// the setting, with the defaults of all settings that they do not read.
struct SettingFlags {
  using Condition = bool (*)(const Settings&);
  bool model = false;    // says which picture is meant: images with other values cannot be compared
  bool common = false;   // every technique reads it
  bool tunable = false;  // changes no result, only times: `lightgrid bench --tune` tries its values
  // An effect's, which changes how much of a light reaches surfaces. LightRanges::effects has its value,
  // since all code that reads lights is given ranges.
  bool of_lights = false;
  bool of_tiles = false;              // read for light grids and exact shadows only
  bool shown_if_given = false;        // shown only where apply_setting has set it
  Condition shown = nullptr;          // without effect, and not shown, where this is false
  Condition approximate = nullptr;    // images are not meant to be exact
  Condition random = nullptr;         // images differ by a seed
  void (*mean)(Settings&) = nullptr;  // sets what the picture that is meant has in its place
  bool any_number = false;  // of a double: from 1e-9 to 1e9 besides the values, which sweeps and lists show
};

// Numbers of rows count from 0 in the order in which static objects are constructed.
struct SettingNumber {
  size_t number;
};

struct SettingRow : SettingNumber {
  int place;  // lists of settings are in this order
  std::string key;
  std::vector<std::string> values;  // the first is the default
  std::string meaning;
  SettingFlags flags;
  std::vector<uint64_t> bits;  // of each value
};

// Returns the row's number, which it ignores. Ends the program if there are more than max_settings.
SettingNumber add_setting(SettingRow row);
SettingNumber add_unlisted_setting();

// A value in 64 bits. An optional number without a value is a NaN.
template <typename T>
uint64_t setting_bits(const T& value) {
  static_assert(sizeof(T) <= sizeof(uint64_t) && std::is_trivially_copyable_v<T>);
  uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof value);
  return bits;
}
inline uint64_t setting_bits(const std::optional<double>& value) {
  return setting_bits(value.value_or(std::numeric_limits<double>::quiet_NaN()));
}

template <typename T>
struct FromSettingBits {
  static T value(uint64_t bits) {
    T value;
    std::memcpy(&value, &bits, sizeof value);
    return value;
  }
};
template <>
struct FromSettingBits<std::optional<double>> {
  static std::optional<double> value(uint64_t bits) {
    const double value = FromSettingBits<double>::value(bits);
    return value == value ? std::optional(value) : std::nullopt;
  }
};

// A row, and typed access to its value: settings[row], settings.set(row, value). `flags` and values are
// listed once it is constructed. In headers it is an inline variable, so that statics of files that include
// them may use it.
template <typename T>
class Setting : public SettingNumber {
 public:
  // Values with their names, the default first.
  Setting(int place, const char* key, const char* meaning,
          std::initializer_list<std::pair<const char*, T>> values, const SettingFlags& flags = {})
      : Setting(row_of(place, key, meaning, values, flags)) {}
  Setting(int place, const char* key, const char* meaning,
          const std::vector<std::pair<const char*, T>>& values, const SettingFlags& flags = {})
      : Setting(row_of(place, key, meaning, values, flags)) {}
  // Numbers as they are written, the default first.
  Setting(int place, const char* key, const char* meaning, std::initializer_list<const char*> numbers,
          const SettingFlags& flags = {})
      : Setting(row_of(place, key, meaning, with_names(numbers), flags)) {}
  // Without a row: other options of commands set it.
  explicit Setting(T without_row)
      : SettingNumber(add_unlisted_setting()), default_bits_(setting_bits(without_row)) {}

  // A value's difference from the default, 0 for the default itself.
  uint64_t difference(const T& value) const { return setting_bits(value) ^ default_bits_; }
  // The value of a setting with `of_lights`, from LightRanges.
  T of(const auto& ranges) const {
    const auto found = ranges.effects.find(key_);
    return value(found == ranges.effects.end() ? 0 : found->second);
  }
  T value(uint64_t difference) const { return FromSettingBits<T>::value(difference ^ default_bits_); }

 private:
  explicit Setting(const SettingRow& row)
      : SettingNumber(add_setting(row)), default_bits_(row.bits.front()), key_(row.key) {}

  static SettingRow row_of(int place, const char* key, const char* meaning, const auto& values,
                           const SettingFlags& flags) {
    SettingRow row{{0}, place, key, {}, meaning, flags, {}};
    for (const auto& [name, value] : values) {
      row.values.push_back(name);
      row.bits.push_back(setting_bits(value));
    }
    return row;
  }
  static std::vector<std::pair<const char*, T>> with_names(std::initializer_list<const char*> numbers) {
    std::vector<std::pair<const char*, T>> values;
    for (const char* number : numbers) values.emplace_back(number, T(std::stod(number)));
    return values;
  }

  uint64_t default_bits_;
  std::string key_{};
};

// One value per row of a table, the default first.
template <typename Row, size_t rows, typename T>
std::vector<std::pair<const char*, T>> choices_of(const Row (&table)[rows], T Row::*value,
                                                  std::type_identity_t<T> first) {
  std::vector<std::pair<const char*, T>> choices;
  for (const Row& row : table)
    choices.insert(row.*value == first ? choices.begin() : choices.end(), {row.name, row.*value});
  return choices;
}

// A setting with a value, for Settings{{tile, 8}, {z_bins, 64}}.
struct SettingValue : SettingNumber {
  template <typename T>
  SettingValue(const Setting<T>& setting, const std::type_identity_t<T>& value)
      : SettingNumber(setting), difference(setting.difference(value)) {}
  uint64_t difference;
};

// A value for each setting: the default, unless set.
class Settings {
 public:
  Settings() = default;
  Settings(std::initializer_list<SettingValue> values) {
    for (const SettingValue& v : values) differences_[v.number] = v.difference;
  }

  template <typename T>
  T operator[](const Setting<T>& setting) const {
    return setting.value(differences_[setting.number]);
  }
  template <typename T>
  Settings& set(const Setting<T>& setting, const std::type_identity_t<T>& value) {
    return set_difference(setting, setting.difference(value));
  }
  Settings& reset(SettingNumber setting) { return set_difference(setting, 0); }
  Settings& copy(SettingNumber setting, const Settings& from) {
    return set_difference(setting, from.difference(setting));
  }

  // 0: the default.
  uint64_t difference(SettingNumber setting) const { return differences_[setting.number]; }
  Settings& set_difference(SettingNumber setting, uint64_t difference) {
    differences_[setting.number] = difference;
    return *this;
  }

  // Returns whether apply_setting has set it, to any value.
  bool given(SettingNumber setting) const { return given_[setting.number]; }
  Settings& give(SettingNumber setting) {
    given_.set(setting.number);
    return *this;
  }

  bool operator==(const Settings&) const = default;

  static constexpr size_t max_settings = 128;

 private:
  std::array<uint64_t, max_settings> differences_{};  // by the number of the row
  std::bitset<max_settings> given_;
};

// By place.
const std::vector<SettingRow>& setting_rows();

// Sorted keys of the settings that are given.
std::vector<std::string> given_keys(const Settings& settings);

// Keys of the settings that say which picture is meant: images with other values cannot be compared.
const std::vector<std::string>& model_settings();
bool same_model(const Settings& a, const Settings& b);
// `settings` with the values that `model` has for those.
Settings with_model(Settings settings, const Settings& model);

// The settings of the picture that `settings` approximate, such as ranges without end in place of far light
// or exact shadows in place of shadow maps.
Settings meant_by(Settings settings);

// `settings`, with the default of every key for which `keeps` is false.
Settings only_with(Settings settings, const std::function<bool(const std::string& key)>& keeps);

// Keys of the settings that change no result, only times.
const std::vector<std::string>& tunable_settings();

// `settings` with the fastest values found for tunable settings (cl/tuned_sizes.h), except for those that are
// given. Other keys and unknown values are ignored.
Settings with_tuned(Settings settings, const std::map<std::string, std::string>& tuned);

// Applies "key=value". Throws Error(input) that lists the keys, or the values of a key.
void apply_setting(Settings& settings, const std::string& assignment);

// By the keys of results.json: "-" becomes "_".
std::map<std::string, std::string> to_strings(const Settings& settings);
std::string json_key(std::string setting);

}  // namespace lightgrid
