#include <fmt/format.h>

#include <sstream>
#include <string_view>

#include <lgabench/cli/verbs.hpp>
#include <lgabench/core/error.hpp>
#include <lgabench/core/json.hpp>
#include <lgabench/core/terminal.hpp>

namespace lgabench::cli {

int dispatch(CLI::App& app, int argc, char** argv, const int& exit) {
  const auto complain = [&app](const std::exception& e, int status) {
    constexpr std::size_t longest = 4000;
    to_stderr("{}: {}\n", app.get_name(), std::string_view(e.what()).substr(0, longest));
    return status;
  };
  try {
    try {
      app.parse(argc, argv);
    } catch (const CLI::Success& e) {
      std::ostringstream text;  // of --help, --version: std::cout would lose why it cannot be written
      app.exit(e, text);
      to_stdout("{}", text.str());
      flush_stdout();
      return ok;
    }
    flush_stdout();
    return exit;
  } catch (const CLI::ParseError& e) {
    return complain(e, usage);
  } catch (const PluginError& e) {
    return complain(e, plugin_refused);
  } catch (const InputError& e) {
    return complain(e, usage);
  } catch (const fs::filesystem_error& e) {
    return complain(e, usage);
  } catch (const Json::exception& e) {
    return complain(InputError(fmt::format("JSON with a member of another type than expected: {}", e.what())), usage);
  } catch (const std::exception& e) {
    return complain(e, cells_failed);
  }
}

}  // namespace lgabench::cli
