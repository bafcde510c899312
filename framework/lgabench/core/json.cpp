#include <lgabench/core/json.hpp>

#include <fmt/format.h>
#include <algorithm>

#include <lgabench/core/files.hpp>

namespace lgabench {

Json read_json(const std::filesystem::path& file) {
  const std::string text = read_file(file);
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& e) {
    const std::size_t at = std::min<std::size_t>(e.byte, text.size());
    const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
    throw InputError(fmt::format("{}: line {} (byte {}): expected valid JSON", file.string(), line, e.byte));
  }
}

std::string canonical(const Json& value) {
  try {
    return value.dump();
  } catch (const Json::exception&) {
    throw InputError("expected valid UTF-8 in JSON text");
  }
}

void JsonReader::fail(const std::string& expectation) const {
  std::string shown = value_.dump(-1, ' ', false, Json::error_handler_t::replace);
  if (shown.size() > 60) shown = shown.substr(0, 57) + "...";
  throw InputError(
      fmt::format("{}: {}: expected {}, got {}", file_, place_.empty() ? "/" : place_, expectation, shown));
}

JsonReader JsonReader::at(const std::string& key) const {
  if (!value_.is_object()) fail("an object");
  const auto it = value_.find(key);
  if (it == value_.end())
    throw InputError(fmt::format("{}: {}: expected a member \"{}\"", file_, place_.empty() ? "/" : place_, key));
  return JsonReader(*it, file_, place_ + "/" + key);
}

std::vector<JsonReader> JsonReader::elements() const {
  if (!value_.is_array()) fail("an array");
  std::vector<JsonReader> all;
  for (std::size_t i = 0; i < value_.size(); ++i) all.emplace_back(value_[i], file_, fmt::format("{}/{}", place_, i));
  return all;
}

std::string JsonReader::string() const {
  if (!value_.is_string()) fail("a string");
  return value_.get<std::string>();
}

std::vector<std::string> JsonReader::strings() const {
  std::vector<std::string> all;
  for (const auto& e : elements()) all.push_back(e.string());
  return all;
}

double JsonReader::number() const {
  if (!value_.is_number()) fail("a number");
  return value_.get<double>();
}

bool JsonReader::boolean() const {
  if (!value_.is_boolean()) fail("true or false");
  return value_.get<bool>();
}

long long JsonReader::integer(long long lowest, long long highest) const {
  const std::string expectation = fmt::format("a whole number from {} to {}", lowest, highest);
  if (!value_.is_number_integer()) fail(expectation);
  if (value_.is_number_unsigned() && value_.get<std::uint64_t>() > static_cast<std::uint64_t>(highest))
    fail(expectation);
  const auto n = value_.get<long long>();
  if (n < lowest || n > highest) fail(expectation);
  return n;
}

void JsonReader::only(const std::vector<std::string>& known) const {
  if (!value_.is_object()) fail("an object");
  for (const auto& item : value_.items())
    if (std::find(known.begin(), known.end(), item.key()) == known.end())
      throw InputError(fmt::format("{}: {}: unknown member \"{}\", expected one of: {}", file_,
                                   place_.empty() ? "/" : place_, item.key(), fmt::join(known, ", ")));
}

}  // namespace lgabench
