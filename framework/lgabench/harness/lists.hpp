// Values in a suite's file: lists that name nothing twice, and the largest count.
#pragma once
#include <fmt/format.h>

#include <string>
#include <vector>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/json.hpp>
#include <lgabench/core/suggest.hpp>

namespace lgabench {

constexpr int largest_count = 1'000'000;  // of scenes, demonstrations and commands that a file may ask for

/// Each element read and checked by `read`. @throws InputError for an empty list and for a value that comes twice.
template <class T, class Read>
std::vector<T> distinct_values(const JsonReader& list, Read read) {
  std::vector<T> all;
  for (const JsonReader& element : list.elements()) {
    const T value = read(element);
    if (contains(all, value)) element.fail("each value once");
    all.push_back(value);
  }
  if (all.empty()) list.fail("at least one value");
  return all;
}

/// A text; one of `known`, which `what` names, where that is not empty.
std::string name_among(const JsonReader& element, const char* what, const std::vector<std::string>& known);

std::vector<std::string> distinct_names(const JsonReader& list, const char* what = "",
                                        const std::vector<std::string>& known = {});

}  // namespace lgabench
