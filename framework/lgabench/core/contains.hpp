// Whether a list has an element.
#pragma once
#include <algorithm>
#include <iterator>

namespace lgabench {

template <typename List, typename Element>
bool contains(const List& list, const Element& element) {
  return std::find(std::begin(list), std::end(list), element) != std::end(list);
}

}  // namespace lgabench
