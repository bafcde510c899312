#include <lgabench/core/json.hpp>

#include <fmt/format.h>
#include <algorithm>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/suggest.hpp>

namespace lgabench {

namespace {

// Builds the document as the parser goes, and stops it at what no reader here could bear: canonical() recurses, the
// last of two members would win unnoticed, and a number out of range would be infinite.
class Builder : public nlohmann::json_sax<Json> {
 public:
  bool null() override { return add(nullptr) != nullptr; }
  bool boolean(bool value) override { return add(value) != nullptr; }
  bool number_integer(number_integer_t value) override { return add(value) != nullptr; }
  bool number_unsigned(number_unsigned_t value) override { return add(value) != nullptr; }
  bool number_float(number_float_t value, const string_t&) override { return add(value) != nullptr; }
  bool string(string_t& value) override { return add(std::move(value)) != nullptr; }
  bool binary(binary_t&) override { return false; }  // no part of JSON text
  bool start_object(std::size_t) override { return open(Json::object()); }
  bool start_array(std::size_t) override { return open(Json::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  bool key(string_t& name) override {
    key_ = std::move(name);
    return !open_.back()->contains(key_) || refuse("each member once, got a second \"" + key_ + "\"");
  }
  bool parse_error(std::size_t byte, const std::string&, const nlohmann::detail::exception& e) override {
    constexpr int number_overflow = 406;
    if (e.id == number_overflow) return refuse("a number within the range of a double");
    byte_ = byte;
    return false;
  }

  Json document;
  std::string complaint() const { return complaint_; }  // what was expected, after its place; "" for a syntax error
  std::size_t byte() const { return byte_; }            // where the syntax ends

 private:
  Json* add(Json value) {
    if (open_.empty()) return &(document = std::move(value));
    Json& in = *open_.back();
    if (in.is_object()) return &(in[key_] = std::move(value));
    in.push_back(std::move(value));
    return &in.back();
  }
  bool open(Json empty) {
    constexpr std::size_t most_levels = 100;
    if (open_.size() == most_levels) return refuse(fmt::format("no more than {} levels", most_levels));
    open_.push_back(add(std::move(empty)));
    return true;
  }
  bool close() {
    open_.pop_back();
    return true;
  }
  bool refuse(const std::string& expectation) {
    std::string place;  // JSON pointer of the innermost object or array
    for (std::size_t i = 0; i + 1 < open_.size(); ++i) {
      const Json& in = *open_[i];
      std::string step = in.is_array() ? std::to_string(in.size() - 1) : std::string();
      for (auto member = in.begin(); in.is_object() && member != in.end(); ++member)
        if (&*member == open_[i + 1]) step = member.key();
      place += "/" + step;
    }
    complaint_ = fmt::format("{}: expected {}", place.empty() ? "/" : place, expectation);
    return false;
  }

  std::vector<Json*> open_;  // from the document to the innermost object or array; none moves while it is open
  std::string key_, complaint_;
  std::size_t byte_ = 0;
};

[[noreturn]] void fail(const Builder& builder, std::string_view text, const std::string& where) {
  if (!builder.complaint().empty()) throw InputError(fmt::format("{}: {}", where, builder.complaint()));
  const std::size_t at = std::min(builder.byte(), text.size());
  const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
  if (text.find('\n') == text.npos)
    throw InputError(fmt::format("{}: byte {}: expected valid JSON", where, builder.byte()));
  throw InputError(fmt::format("{}: line {} (byte {}): expected valid JSON", where, line, builder.byte()));
}

}  // namespace

Json parse_json(std::string_view text, const std::string& where) {
  Builder builder;
  if (!Json::sax_parse(text.begin(), text.end(), &builder)) fail(builder, text, where);
  return std::move(builder.document);
}

Json json_or_null(std::string_view text) {
  try {
    return parse_json(text, "");
  } catch (const InputError&) {
    return nullptr;
  }
}

Json read_json(const std::filesystem::path& file, Links links) {
  const std::uintmax_t most = std::uintmax_t{1} << (links == Links::refused ? 23 : 28);
  return parse_json(read_file(file, links, most), file.string());
}

std::vector<Json> parse_json_lines(std::string_view text, const std::string& file) {
  std::vector<Json> lines;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = text.substr(begin, end - begin);
    Builder builder;  // its place is put into words for a complaint alone: a run has millions of lines
    if (!Json::sax_parse(line.begin(), line.end(), &builder))
      fail(builder, line, fmt::format("{}: line {}", file, lines.size() + 1));
    lines.push_back(std::move(builder.document));
    begin = end + 1;
  }
  return lines;
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
  constexpr std::size_t longest = 60;
  if (std::size_t end = longest - 3; shown.size() > longest) {
    while ((static_cast<unsigned char>(shown[end]) & 0xc0) == 0x80) --end;  // no character is cut
    shown = shown.substr(0, end) + "...";
  }
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
    if (!contains(known, item.key()))
      throw InputError(fmt::format("{}: {}: unknown member \"{}\"{}, expected one of: {}", file_,
                                   place_.empty() ? "/" : place_, item.key(), suggestion(item.key(), known),
                                   fmt::join(known, ", ")));
}

}  // namespace lgabench
