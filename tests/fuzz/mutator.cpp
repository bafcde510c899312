// A mutation that keeps JSON whole: in one of the input's lines one value becomes another. Half of all mutations are
// libFuzzer's own, of bytes, as are those of an input without JSON.
#include <cstdint>
#include <cstring>
#include <random>

#include <lgabench/core/json.hpp>

#include "fuzz.hpp"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace {

using lgabench::Json;
using Random = std::minstd_rand;

void collect(Json& value, std::vector<Json*>& all) {
  all.push_back(&value);
  if (value.is_structured())
    for (Json& inner : value) collect(inner, all);
}

Json odd_value(Random& random) {
  static const Json values =
      Json::parse(R"([null, true, false, 0, -1, 1, 0.5, 1e308, -1e-300, 2147483648, 9007199254740993,
    18446744073709551615, -9223372036854775808, "", "ALL", "a/b", "..", "\u001b[2J", "=1+1", [], {}, [[]], {"": 0}])");
  return values[random() % values.size()];
}

std::string other_text(std::string text) {
  const std::size_t size = text.size();
  text.resize(size + 8);
  text.resize(LLVMFuzzerMutate(reinterpret_cast<std::uint8_t*>(text.data()), size, text.size()));
  return text;
}

// One value of the document: it goes, becomes another, is doubled, renamed or wrapped.
void mutate(Json& document, Random& random) {
  std::vector<Json*> all;
  collect(document, all);
  Json& value = *all[random() % all.size()];
  const Json other = *all[random() % all.size()];
  const auto inner = [&] { return std::next(value.begin(), static_cast<std::ptrdiff_t>(random() % value.size())); };
  const auto choice = random() % 6;
  if (choice == 0)
    value = other;
  else if (choice == 1)
    value = Json::array({value});
  else if (choice == 2 && value.is_array())
    value.push_back(other);
  else if (choice == 2 && value.is_object() && !value.empty())
    value[other_text(inner().key())] = other;
  else if (choice == 3 && value.is_structured() && !value.empty())
    value.erase(inner());
  else if (choice == 4 && value.is_string())
    value = other_text(value.get<std::string>());
  else if (choice == 4 && value.is_number())
    value = value.get<double>() * (random() % 2 == 0 ? -1 : 1e3);
  else
    value = odd_value(random);
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned int seed) {
  using namespace lgabench;
  Random random(seed);
  const std::string_view text = fuzz::text_of(data, size);
  const std::vector<std::string_view> lines = fuzz::split(text, "\n");
  const std::string_view line = lines[random() % lines.size()];
  const std::string_view before_tab = line.substr(0, line.find('\t'));
  Json document = random() % 2 == 0 ? Json() : json_or_null(before_tab);
  if (!document.is_structured()) return LLVMFuzzerMutate(data, size, max_size);
  mutate(document, random);
  const std::string changed = document.dump(-1, ' ', false, Json::error_handler_t::replace);
  const auto begin = static_cast<std::size_t>(before_tab.data() - text.data());
  const std::string mutated =
      std::string(text.substr(0, begin)) + changed + std::string(text.substr(begin + before_tab.size()));
  if (mutated.size() > max_size) return LLVMFuzzerMutate(data, size, max_size);
  std::memcpy(data, mutated.data(), mutated.size());
  return mutated.size();
}
