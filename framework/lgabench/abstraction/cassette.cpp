#include <lgabench/abstraction/cassette.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string_view>

#include <lgabench/abstraction/asked_model.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/core/terminal.hpp>

namespace lgabench {

Cassette::Cassette(const fs::path& file) : file_(file) {
  if (fs::exists(file) && !read()) to_stderr("{}: the last line is cut off and was not read\n", file.string());
}

double read_seconds(const JsonReader& reader) {
  constexpr double longest = 1e7;
  const double seconds = reader.number();
  if (!(seconds >= 0 && seconds <= longest)) reader.fail(fmt::format("seconds from 0 to {}", longest));
  return seconds;
}

bool Cassette::read() {
  const std::string text = read_file(file_);
  if (text.size() < size_) throw InputError(fmt::format("{}: became shorter since it was read", file_.string()));
  const std::lock_guard lock(mutex_);
  for (std::size_t end; (end = text.find('\n', size_)) != std::string::npos; size_ = end + 1) {
    const std::string place = fmt::format("{}: line {}", file_.string(), ++lines_);
    const Json line = parse_json(std::string_view(text).substr(size_, end - size_), place);
    const JsonReader reader(line, place);
    reader.only({"key", "model", "request", "reply", "tokens", "seconds"});
    replies_[reader.at("key").string()] = {reader.at("reply").string(), reader.at("tokens").integer(0, 1LL << 40),
                                           read_seconds(reader.at("seconds"))};
    models_.insert(to_text(AskedModel::of(reader.at("model").string(), reader.at("request"))));
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
    if (::flock(lock_, LOCK_EX | LOCK_NB) != 0 && waiting)
      waiting(fmt::format("{}: another process is filling this cassette; waiting for its replies",
                          cassette.file_.string()));
    while (::flock(lock_, LOCK_EX) != 0)
      if (errno != EINTR) refuse("cannot be locked");
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
  const std::string bytes = canonical(line) + '\n';
  append_file(file_, bytes);
  size_ += bytes.size();
  ++lines_;
  replies_[key] = reply;
  models_.insert(to_text(AskedModel::of(model, JsonReader(request, "request"))));
}

double Cassette::mean_seconds() const {
  const std::lock_guard lock(mutex_);
  double all = 0;
  for (const auto& reply : replies_) all += reply.second.seconds;
  return replies_.empty() ? 0 : all / static_cast<double>(replies_.size());
}

std::set<std::string> Cassette::models() const {
  const std::lock_guard lock(mutex_);
  return models_;
}

std::string Cassette::only_model() const {
  const std::set<std::string> all = models();
  if (all.size() != 1)
    throw InputError(fmt::format("{}: expected replies of one model, it has {}", file_.string(),
                                 all.empty() ? "none" : fmt::format("those of {}", fmt::join(all, ", "))));
  return *all.begin();
}

}  // namespace lgabench
