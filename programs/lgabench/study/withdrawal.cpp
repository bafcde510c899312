#include <lgabench/study/withdrawal.hpp>

#include <sys/random.h>

#include <array>
#include <cctype>
#include <cerrno>
#include <cstdint>
#include <cstring>

#include <lgabench/core/error.hpp>
#include <lgabench/core/hash.hpp>

namespace lgabench::study {

std::string random_id() {
  std::array<std::uint64_t, 2> words{};
  if (::getrandom(words.data(), sizeof words, 0) != static_cast<ssize_t>(sizeof words))
    throw InputError(std::string("no random numbers: ") + std::strerror(errno));
  return hex(words[0]) + hex(words[1]);
}

bool is_id(const std::string& text) {
  return text.size() == 32 && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

std::string withdrawal_code(const std::string& id) {
  constexpr char letters[] = "0123456789ABCDEFGHJKMNPQRSTVWXYZ";  // Crockford's: none looks like another
  const std::string digest = sha256("withdrawal " + id);
  std::string code;
  for (std::size_t i = 0; i < 16; ++i) {  // 5 bits of each byte: 80 bits
    if (i != 0 && i % 4 == 0) code += '-';
    code += letters[std::stoul(digest.substr(2 * i, 2), nullptr, 16) % 32];
  }
  return code;
}

std::string plain_code(const std::string& typed) {
  std::string plain;
  for (const char c : typed)
    if (std::isalnum(static_cast<unsigned char>(c))) {
      const char upper = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
      plain += upper == 'O' ? '0' : upper == 'I' || upper == 'L' ? '1' : upper;
    }
  return plain;
}

}  // namespace lgabench::study
