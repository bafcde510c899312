// JSON with errors that name the file and the place.
#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include <lgabench/core/error.hpp>
#include <lgabench/core/files.hpp>

namespace lgabench {

using Json = nlohmann::json;  // keys sorted, so a dump is canonical

/// Parses a text from outside lgabench; every such text comes in here. Besides what is no JSON it refuses more than 100
/// levels, a member named twice in one object, and a number outside the range of a double. `where` is the file, or
/// "FILE: line 3".
/// @throws InputError naming `where`, the place and what was expected.
Json parse_json(std::string_view text, const std::string& where);

/// The text's JSON, or null for a text that parse_json() refuses.
Json json_or_null(std::string_view text);

/// Parses a file of at most 256 MiB. Where links are refused, the limit is 8 MiB, which take some 150 MiB in memory:
/// somebody else may have written a run's or a board's file. @throws InputError likewise, or why the file cannot be
/// read.
Json read_json(const std::filesystem::path& file, Links links = Links::followed);

/// Parses each line of a text; a last line needs no end. @throws InputError naming `file` and the line.
std::vector<Json> parse_json_lines(std::string_view text, const std::string& file);

/// One line, sorted keys, shortest round-trip numbers: the text that hashes and files use. @throws InputError on
/// invalid UTF-8.
std::string canonical(const Json& value);

/// A value with its place, for strict reading: every complaint reads "FILE: PLACE: expected ...".
/// Holds a reference: the document must outlive it.
class JsonReader {
 public:
  /// `place` is the JSON pointer of `value` in the file.
  JsonReader(const Json& value, std::string file, std::string place = "")
      : value_(value), file_(std::move(file)), place_(std::move(place)) {}

  /// The value as it is; belongs to the document.
  const Json& json() const { return value_; }
  const std::string& file() const { return file_; }
  /// The value's JSON pointer in the file.
  const std::string& place() const { return place_; }
  /// Whether the value is an object with that member.
  bool has(const std::string& key) const { return value_.is_object() && value_.contains(key); }
  /// Member of an object. @throws InputError where missing.
  JsonReader at(const std::string& key) const;
  /// Elements of an array. @throws InputError where it is none.
  std::vector<JsonReader> elements() const;

  /// A text. This and the following @throw InputError for a value of another type.
  std::string string() const;
  /// An array of texts.
  std::vector<std::string> strings() const;
  /// Any number.
  double number() const;
  /// true or false.
  bool boolean() const;
  /// Whole number within [lowest, highest].
  long long integer(long long lowest, long long highest) const;

  /// @throws InputError for the first member whose name is not among `known`.
  void only(const std::vector<std::string>& known) const;
  /// @throws InputError "FILE: PLACE: expected EXPECTATION, got ...", always.
  [[noreturn]] void fail(const std::string& expectation) const;

 private:
  const Json& value_;
  std::string file_, place_;
};

}  // namespace lgabench
