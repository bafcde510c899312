#include <lgabench/study/event_log.hpp>

#include <fmt/format.h>

#include <lgabench/core/hash.hpp>

namespace lgabench::study {
namespace {

constexpr std::size_t digits = 16;

std::string line_of(const std::string& json) {
  return fmt::format("{} {} {}\n", json.size(), sha256(json).substr(0, digits), json);
}

}  // namespace

EventLog::EventLog(fs::path file, bool repair) : file_(std::move(file)) {
  std::error_code error;
  if (!fs::exists(file_, error)) return;
  const std::string bytes = read_file(file_, Links::refused);
  std::size_t begin = 0;
  while (begin < bytes.size()) {
    const std::size_t end = bytes.find('\n', begin);
    if (end == std::string::npos) break;  // an append that was cut off
    const std::string where = fmt::format("{}: line {}", file_.string(), events_.size() + 1);
    const std::string line = bytes.substr(begin, end + 1 - begin);
    const std::size_t first = line.find(' '), second = first == line.npos ? first : line.find(' ', first + 1);
    if (second == line.npos || line_of(line.substr(second + 1, line.size() - second - 2)) != line)
      throw InputError(where + ": expected an event with its length and checksum; the file was changed or damaged");
    events_.push_back(parse_json(line.substr(second + 1), where));
    begin = end + 1;
  }
  size_ = begin;
  if (repair && begin < bytes.size()) write_file(file_, bytes.substr(0, begin));
}

void EventLog::append(const Json& event) {
  const std::string line = line_of(canonical(event));
  std::error_code error;  // what an append left that failed and could not be taken back
  if (const std::uintmax_t there = fs::file_size(file_, error); !error && there > size_) fs::resize_file(file_, size_);
  append_file(file_, line);
  size_ += line.size();
  if (events_.empty()) sync_directory(file_.parent_path());
  events_.push_back(event);
}

}  // namespace lgabench::study
