#include <lgabench/abstraction/server_response.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

#include <lgabench/abstraction/completion.hpp>
#include <lgabench/core/contains.hpp>

namespace lgabench {
namespace {

using Next = Verdict::Next;

// 425 and 529 are what some providers say for "too early" and "overloaded". What a server lacks (501, 505) and a
// network that wants a login first (511) stay.
bool may_pass(long status) {
  constexpr std::array<long, 4> passing{408, 409, 425, 429}, staying{501, 505, 511};
  return contains(passing, status) || (status >= 500 && !contains(staying, status));
}

std::string lower(std::string_view text) {
  std::string all;
  for (const char c : text) all += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return all;
}

std::string_view trimmed(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
  return text;
}

bool is_page(const std::string& body) {
  constexpr std::size_t searched = 300;
  const std::string start = lower(trimmed(body).substr(0, searched));
  return start.rfind('<', 0) == 0 && (start.find("<html") != start.npos || start.find("<!doctype html") != start.npos);
}

// A page's words, without its tags.
std::string words_of(const std::string& page) {
  std::string words;
  bool in_tag = false;
  for (const char c : page) {
    in_tag = c == '<' || (in_tag && c != '>');
    const bool blank = in_tag || c == '>' || std::isspace(static_cast<unsigned char>(c)) != 0;
    if (!blank)
      words += c;
    else if (!words.empty() && words.back() != ' ')
      words += ' ';
  }
  return words;
}

// Server-sent events: lines of fields, or of comments, which begin with a colon.
bool is_stream(const std::string& body) {
  const std::string_view start = trimmed(body);
  constexpr std::array<std::string_view, 5> fields{"data:", "event:", "id:", "retry:", ":"};
  return std::any_of(fields.begin(), fields.end(),
                     [start](std::string_view field) { return start.substr(0, field.size()) == field; });
}

// The error in a body, {"error": {"code", "type"}}, which may be all of the body and stand in an array.
Json error_of(const Json& body) {
  if (body.is_array()) return body.size() == 1 ? error_of(body.front()) : Json();
  if (!body.is_object()) return Json();
  const Json error = body.value("error", Json());
  return error.is_object() ? error : body;
}

bool is_named(const Json& error, const std::vector<std::string>& names) {
  for (const char* member : {"code", "type", "status"})
    if (const Json word = error.is_object() ? error.value(member, Json()) : Json(); word.is_string())
      if (contains(names, lower(word.get<std::string>()))) return true;
  return false;
}

// An account without credit, whatever the status: nothing that waiting mends.
bool is_unpaid(const Json& error) {
  return is_named(error, {"insufficient_quota", "insufficient_balance", "insufficient_credits", "billing_error",
                          "billing_hard_limit_reached", "billing_not_active", "exceeded_current_quota_error"});
}

// A filter that refuses one question's words.
bool is_filtered(const Json& error) { return is_named(error, {"content_filter", "content_policy_violation"}); }

// A 200 that is no completion and names an error: the status that its code says, 0 where it says none.
long status_in(const Json& error) {
  const Json code = error.is_object() ? error.value("code", Json()) : Json();
  constexpr long least = 300, most = 599;
  const long status = code.is_number_integer() ? code.get<long>() : 0;
  return status >= least && status <= most ? status : 0;
}

}  // namespace

std::string without_key(std::string text, const std::string& key) {
  constexpr std::string_view instead = "(key)";
  constexpr std::size_t shortest =
      8;  // a shorter one is a placeholder, such as "none", and may be any word of the text
  for (std::size_t at = 0; key.size() >= shortest && (at = text.find(key, at)) != std::string::npos;
       at += instead.size())
    text.replace(at, key.size(), instead);
  return text;
}

Verdict verdict_of(const ServerResponse& response, const std::string& key) {
  const auto because = [&key](Next next, std::string why) {
    std::replace(why.begin(), why.end(), '\n', ' ');
    return Verdict{next, without_key(std::move(why), key)};
  };
  if (response.status == 0) return because(response.final ? Next::stop : Next::retry, response.problem);
  constexpr std::size_t words_shown = 200, bytes_shown = 80;
  const std::string body = without_key(response.body, key);
  const std::string begins = fmt::format("\"{}\"", beginning(is_page(body) ? words_of(body) : body, bytes_shown));
  const bool is_ok = response.status == 200;
  if (is_ok && is_page(body))
    return because(Next::stop, fmt::format("the server answers with a web page, {}; expected a completion: does "
                                           "OPENAI_BASE_URL end in /v1, and does the server want a login?",
                                           begins));
  if (is_ok && is_stream(body))
    return because(Next::stop, fmt::format("the server streams, {}; expected one completion: turn streaming off in "
                                           "the server's settings",
                                           begins));
  const Json json = json_or_null(body);
  if (is_ok && json.is_object() && json.contains("choices")) return {};
  const std::string says = beginning(without_key(completion_error(json), key), words_shown);
  if (is_ok && says.empty()) return {};
  const Json error = error_of(json);
  const long status = is_ok ? status_in(error) : response.status;
  if (!response.moved_to.empty())
    return because(Next::stop, fmt::format("status {}: moved to {}; set OPENAI_BASE_URL to the new address", status,
                                           beginning(without_key(response.moved_to, key), words_shown)));
  std::string why = is_ok           ? "the server says: " + says
                    : !says.empty() ? fmt::format("status {}: {}", status, says)
                    : !body.empty() ? fmt::format("status {}: {}", status, begins)
                                    : fmt::format("status {}", status);
  if (is_filtered(error)) return because(Next::skip, std::move(why));
  const bool passes = may_pass(status) || (status == 402 && response.retry_after_s > 0);  // other requests spend now
  if (is_unpaid(error) || (status != 0 && !passes)) return because(Next::stop, std::move(why));
  if (response.retry_after_s > longest_retry_after_s)
    return because(Next::stop, fmt::format("{}; the server asks to wait {:.0f} minutes, repeat the command then", why,
                                           response.retry_after_s / 60));
  return because(Next::retry, std::move(why));
}

}  // namespace lgabench
