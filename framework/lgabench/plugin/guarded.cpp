#include <cxxabi.h>

#include <boost/core/demangle.hpp>
#include <typeinfo>

#include <lgabench/plugin/guarded.hpp>

namespace lgabench {

MethodGone::~MethodGone() = default;
PluginOutOfMemory::~PluginOutOfMemory() = default;

std::string current_exception_text() {
  const std::type_info* type = abi::__cxa_current_exception_type();
  const std::string name = type ? boost::core::demangle(type->name()) : "something";
  try {
    throw;
  } catch (const std::exception& e) {
    const std::string text = e.what();
    const std::string line = text.substr(0, text.find('\n'));  // LibTorch appends a stack trace
    return line.empty() ? "threw " + name : line;
  } catch (...) {
    return "threw " + name;
  }
}

}  // namespace lgabench
