// Records, parts and machines as JSON, and back.
#include "base/error.h"
#include "frontier/fields.h"
#include "frontier/record_file.h"

namespace lightgrid::lab {
namespace {

using nlohmann::json;

// Reads each visited field, checked.
struct FromJson {
  const JsonFields& fields;

  template <typename T>
  void operator()(const char* key, T& value, FieldRule rule = {}) const {
    if (rule.required || fields.has(key)) read(key, value, rule);
  }
  void read(const char* key, std::string& value, FieldRule) const { value = fields.text(key); }
  void read(const char* key, int& value, FieldRule rule) const { value = fields.whole(key, rule.low); }
  void read(const char* key, uint64_t& value, FieldRule) const { value = fields.count(key); }
  void read(const char* key, bool& value, FieldRule) const {
    if (!fields.at(key).is_boolean()) throw input_error("{}: is neither true nor false", key);
    value = fields.at(key).get<bool>();
  }
  void read(const char* key, double& value, FieldRule) const { value = fields.number(key); }
  void read(const char* key, std::optional<double>& value, FieldRule) const {
    value = fields.optional_number(key);
  }
  void read(const char* key, std::vector<double>& value, FieldRule) const { value = fields.numbers(key); }
  void read(const char* key, std::vector<int>& values, FieldRule) const {
    for (const double value : fields.numbers(key)) values.push_back(int(value));
  }
  void read(const char* key, std::optional<FlipExposures>& value, FieldRule) const {
    const std::vector<double> flip = fields.numbers(key);
    if (flip.empty()) return;
    if (flip.size() != 3) throw input_error("{}: not start, stop and count", key);
    value = FlipExposures{flip[0], flip[1], int(flip[2])};
  }
  template <typename T>
  void read(const char* key, std::map<std::string, T>& values, FieldRule) const {
    const JsonFields inner = fields.object(key);
    for (const std::string& name : inner.names()) FromJson{inner}(name.c_str(), values[name]);
  }
  template <typename T>
  void read(const char* key, std::optional<T>& value, FieldRule rule) const {
    if (fields.has(key)) read(key, value.emplace(), rule);
  }
  template <typename T>
  void read(const char* key, T& value, FieldRule) const {
    const JsonFields inner = fields.object(key);
    visit_fields(value, FromJson{inner});
  }
};

template <typename T>
T read_from(const json& object) {
  const JsonFields fields(object);
  T value;
  visit_fields(value, FromJson{fields});
  return value;
}

}  // namespace

std::string content_hash(const std::string& text) {
  uint64_t hash = 0xcbf29ce484222325;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  return fmt::format("{:016x}", hash);
}

std::string record_key(const FrontierRecord& record) {
  ToJson identity;
  visit_identity(record, identity);
  // As the file has it, so that a record that was read back has the same key.
  return content_hash(identity.object.dump(-1, ' ', false, json::error_handler_t::replace));
}

json to_json(const FrontierRecord& record) { return ToJson{}.json_of(record); }

json to_json(const FrontierMachine& machine) { return ToJson{Numbers::finite}.json_of(machine); }

json header_json(const FrontierPart& part) {
  json header = ToJson{}.json_of(part);
  header["machine"] = to_json(part.machine);
  return header;
}

FrontierRecord record_of(const json& line) {
  FrontierRecord r = read_from<FrontierRecord>(line);
  if (r.frame_ms.size() != r.baseline_ms.size())
    throw input_error("frame_ms: {} times beside {} of baseline_ms", r.frame_ms.size(), r.baseline_ms.size());
  for (const auto& [key, times] : times_by_device) {
    if ((r.*times).size() != r.device_ms.size() || (r.*times).size() > r.frame_ms.size())
      throw input_error("{}: {} times beside {} of frame_ms", key, (r.*times).size(), r.frame_ms.size());
  }
  for (const auto& [key, times] : times_by_cpu) {
    if (!(r.*times).empty() && (r.*times).size() != r.frame_ms.size())
      throw input_error("{}: {} times beside {} of frame_ms", key, (r.*times).size(), r.frame_ms.size());
  }
  r.processes.resize(r.frame_ms.size(), 0);  // parts of earlier versions name none
  return r;
}

json to_json(const FrontierConditions& conditions) { return ToJson{Numbers::finite}.json_of(conditions); }

FrontierConditions conditions_of(const json& object) { return read_from<FrontierConditions>(object); }

FrontierPart part_of(const json& header) {
  FrontierPart part = read_from<FrontierPart>(header);
  if (part.shard >= part.shards)
    throw input_error("shard: {} is not below shards, {}", part.shard, part.shards);
  part.machine.shard = part.shard;
  return part;
}

}  // namespace lightgrid::lab
