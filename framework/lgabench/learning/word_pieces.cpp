#include <lgabench/learning/word_pieces.hpp>

#include <fmt/format.h>
#include <utf8proc.h>

#include <algorithm>
#include <sstream>

#include <lgabench/core/error.hpp>
#include <lgabench/core/files.hpp>

namespace lgabench {
namespace {

constexpr std::size_t longest_word = 100;

std::u32string decode(const std::string& text) {
  std::u32string all;
  const auto* bytes = reinterpret_cast<const utf8proc_uint8_t*>(text.data());
  auto left = static_cast<utf8proc_ssize_t>(text.size());
  while (left > 0) {
    utf8proc_int32_t character;
    const utf8proc_ssize_t used = utf8proc_iterate(bytes, left, &character);
    if (used <= 0)
      throw InputError(fmt::format("text to embed: expected UTF-8, got another byte at {}",
                                   text.size() - static_cast<std::size_t>(left)));
    all.push_back(static_cast<char32_t>(character));
    bytes += used;
    left -= used;
  }
  return all;
}

std::string encode(const std::u32string& text, std::size_t begin, std::size_t end) {
  std::string bytes;
  for (std::size_t i = begin; i < end; ++i) {
    utf8proc_uint8_t buffer[4];
    const auto count = utf8proc_encode_char(static_cast<utf8proc_int32_t>(text[i]), buffer);
    bytes.append(reinterpret_cast<const char*>(buffer), static_cast<std::size_t>(count));
  }
  return bytes;
}

utf8proc_category_t category(char32_t c) { return utf8proc_category(static_cast<utf8proc_int32_t>(c)); }

bool is_space(char32_t c) {
  if (c == '\t' || c == '\n' || c == '\r' || c == 0x0B || c == 0x0C || c == 0x85) return true;
  const auto kind = category(c);
  return kind == UTF8PROC_CATEGORY_ZS || kind == UTF8PROC_CATEGORY_ZL || kind == UTF8PROC_CATEGORY_ZP;
}

// Categories C*: control, format, surrogate, private, not assigned.
bool is_dropped(char32_t c) {
  if (c == 0xFFFD) return true;
  const auto kind = category(c);
  return kind == UTF8PROC_CATEGORY_CC || kind == UTF8PROC_CATEGORY_CF || kind == UTF8PROC_CATEGORY_CS ||
         kind == UTF8PROC_CATEGORY_CO || kind == UTF8PROC_CATEGORY_CN;
}

bool is_punctuation(char32_t c) {
  if ((c >= 33 && c <= 47) || (c >= 58 && c <= 64) || (c >= 91 && c <= 96) || (c >= 123 && c <= 126)) return true;
  const auto kind = category(c);
  return kind >= UTF8PROC_CATEGORY_PC && kind <= UTF8PROC_CATEGORY_PO;
}

bool is_chinese(char32_t c) {
  constexpr std::pair<char32_t, char32_t> blocks[] = {{0x4E00, 0x9FFF},   {0x3400, 0x4DBF},   {0x20000, 0x2A6DF},
                                                      {0x2A700, 0x2B73F}, {0x2B740, 0x2B81F}, {0x2B920, 0x2CEAF},
                                                      {0xF900, 0xFAFF},   {0x2F800, 0x2FA1F}};
  return std::any_of(std::begin(blocks), std::end(blocks),
                     [c](const auto& block) { return c >= block.first && c <= block.second; });
}

// Canonical decomposition without the marks that it sets apart, in lower case.
std::u32string without_accents(char32_t c) {
  utf8proc_int32_t parts[32];
  int boundary_class = 0;
  const auto count =
      utf8proc_decompose_char(static_cast<utf8proc_int32_t>(c), parts, 32, UTF8PROC_DECOMPOSE, &boundary_class);
  std::u32string plain;
  for (utf8proc_ssize_t i = 0; i < count; ++i)
    if (utf8proc_category(parts[i]) != UTF8PROC_CATEGORY_MN)
      plain.push_back(static_cast<char32_t>(utf8proc_tolower(parts[i])));
  return plain;
}

std::vector<std::u32string> words_of(const std::string& text) {
  std::vector<std::u32string> words;
  std::u32string word;
  const auto finish = [&] {
    if (!word.empty()) words.push_back(std::move(word));
    word.clear();
  };
  for (const char32_t raw : decode(text)) {
    if (is_space(raw)) {
      finish();
      continue;
    }
    if (is_dropped(raw)) continue;
    for (const char32_t c : without_accents(raw)) {
      const bool alone = is_punctuation(c) || is_chinese(raw);
      if (alone) finish();
      word.push_back(c);
      if (alone) finish();
    }
  }
  finish();
  return words;
}

}  // namespace

WordPieces::WordPieces(const fs::path& vocabulary) : file_(vocabulary) {
  std::istringstream lines(read_file(vocabulary));
  for (std::string line; std::getline(lines, line);) numbers_.emplace(line, static_cast<std::int64_t>(numbers_.size()));
  begin_ = special("[CLS]");
  end_ = special("[SEP]");
  unknown_ = special("[UNK]");
}

std::int64_t WordPieces::special(const std::string& token) const {
  const auto found = numbers_.find(token);
  if (found == numbers_.end()) throw InputError(fmt::format("{}: expected a line \"{}\"", file_.string(), token));
  return found->second;
}

// The longest piece that the vocabulary holds, again and again.
void WordPieces::add_word(const std::u32string& word, std::vector<std::int64_t>& ids) const {
  const std::size_t before = ids.size();
  for (std::size_t begin = 0; begin < word.size();) {
    std::size_t end = word.size() > longest_word ? begin : word.size();
    auto found = numbers_.end();
    for (; end > begin; --end) {
      found = numbers_.find((begin > 0 ? "##" : "") + encode(word, begin, end));
      if (found != numbers_.end()) break;
    }
    if (found == numbers_.end()) {
      ids.resize(before);
      ids.push_back(unknown_);
      return;
    }
    ids.push_back(found->second);
    begin = end;
  }
}

std::vector<std::int64_t> WordPieces::ids(const std::string& text, std::size_t most) const {
  std::vector<std::int64_t> ids{begin_};
  for (const std::u32string& word : words_of(text)) {
    if (ids.size() >= most) break;
    add_word(word, ids);
  }
  ids.resize(std::min(ids.size(), most - 1));
  ids.push_back(end_);
  return ids;
}

}  // namespace lgabench
