// Numbers as a command line and JSON write them. CLI11 takes 010 for 8, and the nearest there is for one out of range.
#pragma once
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <type_traits>
#include <vector>

namespace lgabench::cli {

/// The number that the whole word is: decimal, finite, within the type's range, without leading zeros or a plus.
template <class T>
std::optional<T> number_of(std::string_view word) {
  T value{};
  const char* const end = word.data() + word.size();
  const auto [rest, error] = std::from_chars(word.data(), end, value);
  if (error != std::errc() || rest != end) return std::nullopt;
  if constexpr (std::is_floating_point_v<T>) return std::isfinite(value) ? std::optional<T>(value) : std::nullopt;
  const std::size_t first = word.find_first_not_of('-');
  return word[first] == '0' && word.size() > 1 ? std::nullopt : std::optional<T>(value);
}

/// The texts between separators, also an empty one at the end, which CLI11's split() drops.
inline std::vector<std::string> items_of(const std::string& text, char separator) {
  return CLI::detail::split(text + separator, separator);
}

/// A check for an option: "" for such a number, else what was expected.
template <class T>
std::string not_a_number(const std::string& word) {
  if (number_of<T>(word)) return "";
  if constexpr (std::is_floating_point_v<T>) return fmt::format("expected a number, got {}", word);
  return fmt::format("expected a whole number up to {}, without leading zeros, got {}", std::numeric_limits<T>::max(),
                     word);
}

/// The type of the numbers that an option's value holds; void where it holds none.
template <class T>
struct number_in {
  using type = std::conditional_t<std::is_arithmetic_v<T> && !std::is_same_v<T, bool>, T, void>;
};
template <class T>
struct number_in<std::optional<T>> : number_in<T> {};
template <class T>
struct number_in<std::vector<T>> : number_in<T> {};
template <class T>
struct number_in<std::function<void(const T&)>> : number_in<T> {};

}  // namespace lgabench::cli
