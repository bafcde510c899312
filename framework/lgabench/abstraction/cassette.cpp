#include <lgabench/abstraction/cassette.hpp>

#include <fmt/format.h>

#include <cstdio>

#include <lgabench/core/files.hpp>
#include <lgabench/core/hash.hpp>

namespace lgabench {

Cassette::Cassette(const fs::path& file) : file_(file) {
  if (!fs::exists(file)) return;
  const std::string text = read_file(file);
  int number = 0;
  std::size_t begin = 0;
  for (std::size_t end; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1) {
    const Json line = Json::parse(text.substr(begin, end - begin), nullptr, false);
    const JsonReader reader(line, fmt::format("{}: line {}", file.string(), ++number));
    reader.only({"key", "model", "request", "reply", "tokens", "seconds"});
    replies_[reader.at("key").string()] = {reader.at("reply").string(), reader.at("tokens").integer(0, 1LL << 40),
                                           reader.at("seconds").number()};
    models_.insert(reader.at("model").string());
  }
  if (begin == text.size()) return;
  fmt::print(stderr, "{}: the last line was cut off; dropped\n", file.string());
  fs::resize_file(file, begin);
}

std::string Cassette::key(const Json& request, const std::string& template_version) {
  return sha256(canonical({{"request", request}, {"template", template_version}}));
}

std::optional<ChatReply> Cassette::find(const std::string& key) const {
  const std::lock_guard lock(mutex_);
  const auto found = replies_.find(key);
  return found == replies_.end() ? std::nullopt : std::optional(found->second);
}

void Cassette::add(const std::string& key, const Json& request, const ChatReply& reply) {
  const std::string model = request.at("model");
  const Json line{{"key", key},          {"model", model},         {"request", request},
                  {"reply", reply.text}, {"tokens", reply.tokens}, {"seconds", reply.seconds}};
  const std::lock_guard lock(mutex_);
  append_file(file_, canonical(line) + '\n');
  replies_[key] = reply;
  models_.insert(model);
}

std::set<std::string> Cassette::models() const {
  const std::lock_guard lock(mutex_);
  return models_;
}

}  // namespace lgabench
