#include <lgabench/abstraction/completion.hpp>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <cctype>
#include <cmath>
#include <ctime>
#include <optional>

#include <lgabench/core/terminal.hpp>

namespace lgabench {
namespace {

constexpr const char* replacement = "\\ufffd";

// A message's content: a text, or a list of parts, of which a model's thoughts and refusals are no answer.
std::string content_of(const JsonReader& message) {
  const JsonReader content = message.at("content");
  std::string text;
  if (content.json().is_array()) {
    for (const JsonReader& part : content.elements()) {
      const Json type = part.has("type") ? part.at("type").json() : Json("text");
      if ((type == "text" || type == "output_text") && part.has("text")) text += part.at("text").string();
    }
  } else if (!content.json().is_null()) {
    text = content.string();
  }
  return text;
}

// Servers count in ways of their own; no answer depends on it.
long long count_in(const Json& usage, const char* what) {
  const Json count = usage.is_object() ? usage.value(what, Json()) : Json();
  constexpr double most = 1e12;
  const double tokens = count.is_number() ? count.get<double>() : 0;
  return tokens >= 0 && tokens <= most ? std::llround(tokens) : 0;
}

// Whose words these are, as the server says.
std::string served_by(const Json& body) {
  constexpr std::size_t longest = 200;
  const Json model = body.value("model", Json());
  return model.is_string() ? beginning(one_line(model.get<std::string>()), longest) : "";
}

std::string day_of(const Json& body) {
  const Json created = body.value("created", Json());
  constexpr double earliest = 1.5e9, latest = 4e9;  // seconds since 1970: what a clock may say
  const double time_s = created.is_number() ? created.get<double>() : 0;
  if (!(time_s >= earliest && time_s <= latest)) return "";
  return fmt::format("{:%Y-%m-%d}", fmt::gmtime(static_cast<std::time_t>(time_s)));
}

// Words for a finish_reason differ from server to server: those are refused that say that the content is not whole.
bool is_cut_off(const std::string& reason) {
  for (const char* cut : {"length", "max_tokens", "model_length", "content_filter", "safety", "recitation", "refusal",
                          "error", "abort", "insufficient_system_resource"})
    if (reason.rfind(cut, 0) == 0) return true;
  return false;
}

void expect_whole(const JsonReader& choice, const JsonReader& message) {
  if (const std::string says = completion_error(choice.json()); choice.has("error") && !says.empty())
    throw NoAnswer("the server says: " + says);
  const Json reason = choice.has("finish_reason") ? choice.at("finish_reason").json() : Json();
  if (!reason.is_string()) return;
  const auto word = reason.get<std::string>();
  std::string lower;
  for (const char c : word) lower += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (is_cut_off(lower)) throw NoAnswer("the reply was cut off: finish_reason is " + word);
  const bool calls = message.has("tool_calls") && !message.at("tool_calls").json().empty();
  if (lower == "tool_calls" || lower == "function_call" || calls)
    throw NoAnswer("the model called a tool, and none was offered: finish_reason is " + word);
}

void expect_text(const std::string& text, const JsonReader& message) {
  if (text.find_first_not_of(" \t\r\n") != std::string::npos) return;
  const bool says = message.has("refusal") && message.at("refusal").json().is_string();
  if (says) throw NoAnswer("the model refused: " + message.at("refusal").string());
  for (const char* thoughts : {"reasoning_content", "reasoning", "thinking"})
    if (message.has(thoughts) && message.at(thoughts).json().is_string() && !message.at(thoughts).string().empty())
      throw NoAnswer(fmt::format("the reply is empty: the model only thought, in {}", thoughts));
  throw NoAnswer("the reply is empty");
}

// The four digits after "\u" at that place.
std::optional<unsigned> escaped_unit(const std::string& text, std::size_t at) {
  constexpr std::size_t length = 6;
  if (at + length > text.size() || text[at] != '\\' || text[at + 1] != 'u') return std::nullopt;
  unsigned unit = 0;
  for (std::size_t i = at + 2; i < at + length; ++i) {
    const auto digit = static_cast<unsigned char>(text[i]);
    if (std::isxdigit(digit) == 0) return std::nullopt;
    unit = unit * 16 + static_cast<unsigned>(std::isdigit(digit) != 0 ? digit - '0' : std::tolower(digit) - 'a' + 10);
  }
  return unit;
}

// No backslash stands outside strings in JSON, and within one each begins an escape.
std::string without_lone_surrogates(const std::string& text) {
  constexpr std::size_t unit = 6;
  const auto within = [](std::optional<unsigned> one, unsigned first) {
    return one && *one >= first && *one < first + 0x400;
  };
  std::string mended;
  std::size_t from = 0;  // what comes before is in `mended`
  for (std::size_t at = text.find('\\'); at != std::string::npos && at + 1 < text.size(); at = text.find('\\', at)) {
    const auto first = escaped_unit(text, at);
    const bool high = within(first, 0xd800);
    if (high && within(escaped_unit(text, at + unit), 0xdc00)) {
      at += 2 * unit;
    } else if (high || within(first, 0xdc00)) {
      mended.append(text, from, at - from).append(replacement);
      from = at += unit;
    } else {
      at += 2;
    }
  }
  return mended.append(text, from);
}

}  // namespace

std::string beginning(const std::string& text, std::size_t most) {
  if (text.size() <= most) return text;
  while (most > 0 && (static_cast<unsigned char>(text[most]) & 0xc0) == 0x80) --most;
  return text.substr(0, most);
}

// The library that writes JSON puts U+FFFD where it is told to, and reads back what it wrote.
std::string mended_json(const std::string& text) {
  const std::string quoted = Json(text).dump(-1, ' ', false, Json::error_handler_t::replace);
  return without_lone_surrogates(parse_json(quoted, "a text").get<std::string>());
}

std::string completion_error(const Json& body) {
  if (body.is_array()) return body.size() == 1 ? completion_error(body.front()) : "";
  if (!body.is_object()) return "";
  const Json error = body.value("error", Json());
  if (error.is_string()) return error;
  if (error.is_object()) return completion_error(error);
  for (const char* words : {"message", "detail"})
    if (body.contains(words) && body.at(words).is_string()) return body.at(words);
  return "";
}

ChatReply read_completion(const std::string& body) {
  constexpr const char* where = "language model's reply";
  constexpr std::size_t shown = 80;
  const auto got = [&] { return fmt::format(", got \"{}\"", beginning(body, shown)); };
  Json json;
  try {
    json = parse_json(body, where);
  } catch (const InputError& e) {
    throw InputError(e.what() + got());
  }
  const JsonReader reader(json, where);
  if (!reader.has("choices")) {
    if (const std::string says = completion_error(json); !says.empty()) throw NoAnswer("the server says: " + says);
    throw InputError(fmt::format("{}: /: expected a member \"choices\"{}", where, got()));
  }
  const auto choices = reader.at("choices").elements();
  if (choices.size() != 1) reader.at("choices").fail("one choice");
  const bool is_null = choices[0].has("message") && choices[0].at("message").json().is_null();
  const Json none = Json::object();
  const JsonReader message = is_null ? JsonReader(none, where, "/choices/0/message") : choices[0].at("message");
  expect_whole(choices[0], message);
  const std::string text = message.has("content") ? content_of(message) : "";
  expect_text(text, message);
  const Json usage = json.value("usage", Json());
  ChatReply reply{text, count_in(usage, "total_tokens"), 0};
  reply.prompt_tokens = count_in(usage, "prompt_tokens");
  reply.reply_tokens = count_in(usage, "completion_tokens");
  if (reply.tokens == 0) reply.tokens = reply.prompt_tokens + reply.reply_tokens;
  reply.served = served_by(json);
  reply.day = day_of(json);
  return reply;
}

}  // namespace lgabench
