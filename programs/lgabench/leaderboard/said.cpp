#include <lgabench/leaderboard/said.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string_view>
#include <vector>

namespace lgabench::leaderboard {
namespace {

constexpr const char* said_member = "said";

// Calls it with every command of /phi, as far as that has the form.
template <typename Function>
void for_each_command(Json& phi, const Function& call) {
  if (!phi.is_object()) return;
  for (Json& lists : phi)
    if (lists.is_array())
      for (Json& list : lists)
        if (list.is_array())
          for (Json& command : list) call(command);
}

// Calls it with what may be said once of a Selection: each list of names, and each whole number, which would be taken
// for one that stands for a value. Its cost has numbers of its own.
template <typename Function>
void for_each_part(Json& value, const Function& call) {
  const auto is_text = [](const Json& one) { return one.is_string(); };
  if (value.is_number_integer() || (value.is_array() && std::all_of(value.begin(), value.end(), is_text)))
    call(value);
  else if (value.is_array())
    for (Json& one : value) for_each_part(one, call);
  else if (value.is_object())
    for (auto item = value.begin(); item != value.end(); ++item)
      if (item.key() != "cost") for_each_part(*item, call);
}

// Values in the order in which they came, none twice.
class Values {
 public:
  /// The number of the value takes its place.
  void take(Json& value) {
    const auto [known, is_new] = numbers_.try_emplace(canonical(value), all_.size());
    if (is_new) all_.push_back(std::move(value));
    value = known->second;
  }
  Json all() { return std::move(all_); }

 private:
  std::map<std::string, std::size_t> numbers_;
  Json all_ = Json::array();
};

// Puts values in the place of their numbers.
class Said {
 public:
  explicit Said(const JsonReader& all) : all_(all), sizes_(all.elements().size()) {}

  /// Returns whether it was a number.
  bool put(Json& number) {
    if (!number.is_number_integer()) return false;
    const JsonReader reader(number, all_.file(), "a number that stands for a value of /said");
    const auto i = static_cast<std::size_t>(reader.integer(0, static_cast<long long>(sizes_.size()) - 1));
    const Json& value = all_.json()[i];
    if (sizes_[i] == 0) sizes_[i] = canonical(value).size();
    bytes_ += sizes_[i];
    if (bytes_ > most_said_bytes)
      all_.fail(fmt::format("values of at most {} bytes, where each number in /phi has its value", most_said_bytes));
    number = value;
    return true;
  }

 private:
  JsonReader all_;
  std::vector<std::size_t> sizes_;
  std::uintmax_t bytes_ = 0;
};

}  // namespace

Json shortened(Json entry) {
  Values values;
  for_each_command(entry.at("phi"), [&](Json& command) {
    for_each_part(command.at("selection"), [&](Json& part) { values.take(part); });
    for (const char* member : {"selection", "quality"}) values.take(command.at(member));
    values.take(command);
  });
  if (Json all = values.all(); !all.empty()) entry[said_member] = std::move(all);
  return entry;
}

Json expanded(Json entry, const std::string& file) {
  if (!entry.is_object() || !entry.contains(said_member)) return entry;
  const Json all = std::move(entry[said_member]);
  entry.erase(said_member);
  Said values(JsonReader(all, file, "/said"));
  if (entry.contains("phi"))
    for_each_command(entry["phi"], [&](Json& command) {
      values.put(command);
      if (!command.is_object()) return;
      for (const char* member : {"selection", "quality"})
        if (command.contains(member)) values.put(command[member]);
      if (command.contains("selection")) for_each_part(command["selection"], [&](Json& part) { values.put(part); });
    });
  return entry;
}

std::string text_of_entry(Json entry) {
  if (!entry.is_object() || !entry.contains(said_member)) return entry.dump(1) + "\n";
  const Json all = std::move(entry[said_member]);
  entry.erase(said_member);
  std::string text = entry.dump(1);
  text.erase(text.size() - std::string_view("\n}").size());
  text += ",\n \"said\": [";
  for (const Json& value : all) text += (&value == &all.front() ? "\n  " : ",\n  ") + canonical(value);
  return text + "\n ]\n}\n";
}

}  // namespace lgabench::leaderboard
