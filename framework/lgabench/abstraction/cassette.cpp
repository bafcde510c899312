#include <lgabench/abstraction/cassette.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string_view>

#include <lgabench/abstraction/asked_model.hpp>
#include <lgabench/core/fields.hpp>
#include <lgabench/core/file_lock.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/core/terminal.hpp>

namespace lgabench {

std::string read_word(const JsonReader& reader) {
  constexpr std::size_t longest = 200;
  std::string text = reader.string();
  if (text.size() > longest || one_line(text) != text) reader.fail("one line of at most 200 bytes");
  return text;
}

constexpr double most_reply_seconds = 1e9;

double read_reply_seconds(const JsonReader& reader) {
  const double seconds = reader.number();
  if (!(seconds >= 0 && seconds <= most_reply_seconds))
    reader.fail(fmt::format("seconds from 0 to {:g}", most_reply_seconds));
  return seconds;
}

void fields(CassetteLine& line, Fields& field) {
  constexpr long long most_tokens = 1LL << 40;
  ChatReply& reply = line.reply;
  const Form apart = within(0, most_tokens, when(reply.prompt_tokens + reply.reply_tokens > 0));
  field("key", line.key);
  field("model", line.model);
  field("request", line.request);
  field("reply", reply.text);
  field("tokens", reply.tokens, within(0, most_tokens));
  field("seconds", reply.seconds, up_to(most_reply_seconds));
  field("prompt_tokens", reply.prompt_tokens, apart);
  field("reply_tokens", reply.reply_tokens, apart);
  field("served", reply.served, when(!reply.served.empty()));
  field("day", reply.day, when(!reply.day.empty()));
  field("prompt", line.prompt, when(!line.prompt.empty()));
  for (const char* word : {"served", "day"})
    if (field.reading() && field.reading()->has(word)) read_word(field.reading()->at(word));
}

Cassette::Cassette(const fs::path& file) : file_(file) {
  if (fs::exists(file) && !read()) to_stderr("{}: the last line is cut off and was not read\n", file.string());
}

bool Cassette::read() {
  const std::string text = read_file(file_);
  if (text.size() < size_) throw InputError(fmt::format("{}: became shorter since it was read", file_.string()));
  const std::lock_guard lock(mutex_);
  for (std::size_t end; (end = text.find('\n', size_)) != std::string::npos; size_ = end + 1) {
    const std::string place = fmt::format("{}: line {}", file_.string(), ++lines_);
    const Json json = parse_json(std::string_view(text).substr(size_, end - size_), place);
    const JsonReader reader(json, place);
    auto [key, model, request, reply, prompt] = value_of<CassetteLine>(reader);
    if (lines_ == 1)
      prompt_ = prompt;
    else if (!prompt.empty() && prompt != prompt_)
      reader.at("prompt").fail("the first line's: one text asks for all of a cassette's replies");
    auto& served = served_[asked_text(model, reader.at("request"))];
    if (!reply.served.empty()) served.insert(reply.served);
    replies_[key] = std::move(reply);
  }
  return size_ == text.size();
}

Cassette::Turn::Turn(Cassette& cassette, const std::function<void(const std::string&)>& waiting)
    : lock_(::open(cassette.file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644)) {
  const auto refuse = [&](const char* what) {
    throw InputError(fmt::format("{}: {}: {}", cassette.file_.string(), what, std::strerror(errno)));
  };
  if (lock_ < 0) refuse("cannot be written");
  try {
    if (!try_lock(lock_, Lock::exclusive, cassette.file_)) {
      if (waiting)
        waiting(fmt::format("{}: another process is filling this cassette; waiting for its replies",
                            cassette.file_.string()));
      wait_for_lock(lock_, Lock::exclusive, cassette.file_);
    }
    if (!cassette.read() && ::ftruncate(lock_, static_cast<off_t>(cassette.size_)) != 0) refuse("cannot be written");
  } catch (...) {
    ::close(lock_);
    throw;
  }
}

Cassette::Turn::~Turn() { ::close(lock_); }

std::string Cassette::key(const Json& request, const std::string& template_version) {
  return sha256(canonical({{"request", request}, {"template", template_version}}));
}

std::string Cassette::asked_text(const std::string& model, const JsonReader& request) const {
  AskedModel asked = AskedModel::of(model, request);
  if (!prompt_.empty()) asked.prompt = sha256(prompt_);
  return to_text(asked);
}

std::string Cassette::prompt() const {
  const std::lock_guard lock(mutex_);
  return prompt_;
}

void Cassette::expect_prompt(const std::string& text) {
  const std::lock_guard lock(mutex_);
  expected_prompt_ = text;
  expect_same_prompt();
}

void Cassette::expect_same_prompt() const {
  const auto named = [](const std::string& text) {
    return text.empty() ? std::string("lgabench's own prompt") : fmt::format("the prompt {}", sha256(text));
  };
  if (lines_ > 0 && prompt_ != expected_prompt_)
    throw InputError(
        fmt::format("{}: expected replies to {}, it has those to {}; give another --cassette, or the same "
                    "--prompt",
                    file_.string(), named(expected_prompt_), named(prompt_)));
}

std::optional<ChatReply> Cassette::find(const std::string& key) const {
  const std::lock_guard lock(mutex_);
  const auto found = replies_.find(key);
  return found == replies_.end() ? std::nullopt : std::optional(found->second);
}

void ChatReply::add(const ChatReply& later) {
  text = later.text;
  tokens += later.tokens;
  seconds += later.seconds;
  prompt_tokens += later.prompt_tokens;
  reply_tokens += later.reply_tokens;
  served = later.served;
  day = later.day;
}

void Cassette::add(const std::string& key, const Json& request, const ChatReply& reply, bool any_served) {
  const std::string model = request.at("model");
  const std::lock_guard lock(mutex_);
  expect_same_prompt();
  const bool first = lines_ == 0;
  if (first) prompt_ = expected_prompt_;
  const std::string asked = asked_text(model, JsonReader(request, "request"));
  if (const auto before = served_.find(asked); before != served_.end() && !any_served && !reply.served.empty() &&
                                               !before->second.empty() && before->second.count(reply.served) == 0)
    throw MethodError(fmt::format(
        "the server now names its model \"{}\", the replies in {} are of \"{}\"; give another --cassette, or "
        "--any-served to keep the replies of both",
        reply.served, file_.string(), fmt::join(before->second, "\", \"")));
  const std::string bytes = canonical(json_of(CassetteLine{key, model, request, reply, first ? prompt_ : ""})) + '\n';
  append_file(file_, bytes);
  size_ += bytes.size();
  ++lines_;
  replies_[key] = reply;
  std::set<std::string>& served = served_[asked];
  if (!reply.served.empty()) served.insert(reply.served);
}

double Cassette::mean_seconds() const {
  const std::lock_guard lock(mutex_);
  double all = 0;
  for (const auto& reply : replies_) all += reply.second.seconds;
  return replies_.empty() ? 0 : all / static_cast<double>(replies_.size());
}

std::set<std::string> Cassette::models() const {
  const std::lock_guard lock(mutex_);
  std::set<std::string> all;
  for (const auto& asked : served_) all.insert(asked.first);
  return all;
}

std::string Cassette::only_model() const {
  const std::set<std::string> all = models();
  if (all.size() != 1)
    throw InputError(fmt::format("{}: expected replies of one model, it has {}", file_.string(),
                                 all.empty() ? "none" : fmt::format("those of {}", fmt::join(all, ", "))));
  return *all.begin();
}

}  // namespace lgabench
