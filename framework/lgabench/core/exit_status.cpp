#include <lgabench/core/exit_status.hpp>

#include <fmt/format.h>

#include <lgabench/core/colour.hpp>
#include <lgabench/core/error.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/json.hpp>
#include <lgabench/core/terminal.hpp>

namespace lgabench {
namespace {

// "PATH: errno's words", of the current directory where it names no path.
std::string text_of(const fs::filesystem_error& e) {
  std::string where = e.path1().empty() ? "the current directory" : e.path1().string();
  if (!e.path2().empty()) where += ", " + e.path2().string();
  return fmt::format("{}: {}", where, e.code().message());
}

}  // namespace

void complain(const std::string& program, std::string_view what) {
  constexpr std::size_t longest = 4000;
  put(stderr, fmt::format("{} {}\n", painted(stderr, Colour::red, program + ":"), printable(what.substr(0, longest))));
}

int report_error(const std::string& program) {
  const auto complained = [&program](std::string_view what, exit_status::Exit status) {
    complain(program, what);
    return status;
  };
  try {
    throw;
  } catch (const PluginError& e) {
    return complained(e.what(), exit_status::plugin_refused);
  } catch (const InputError& e) {
    return complained(e.what(), exit_status::usage);
  } catch (const fs::filesystem_error& e) {
    return complained(text_of(e), exit_status::usage);
  } catch (const Json::exception& e) {
    return complained(fmt::format("JSON with a member of another type than expected: {}", e.what()),
                      exit_status::usage);
  } catch (const std::exception& e) {
    return complained(e.what(), exit_status::cells_failed);
  }
}

}  // namespace lgabench
