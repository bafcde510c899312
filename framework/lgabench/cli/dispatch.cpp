#include <fmt/format.h>

#include <cstdio>

#include <lgabench/cli/verbs.hpp>
#include <lgabench/core/error.hpp>

namespace lgabench::cli {

int dispatch(CLI::App& app, int argc, char** argv, const int& exit) {
  const auto complain = [&app](const std::exception& e, int status) {
    fmt::print(stderr, "{}: {}\n", app.get_name(), e.what());
    return status;
  };
  try {
    app.parse(argc, argv);
    return exit;
  } catch (const CLI::Success& e) {
    return app.exit(e);  // --help, --version
  } catch (const CLI::ParseError& e) {
    return complain(e, usage);
  } catch (const PluginError& e) {
    return complain(e, plugin_refused);
  } catch (const InputError& e) {
    return complain(e, usage);
  } catch (const std::exception& e) {
    return complain(e, cells_failed);
  }
}

}  // namespace lgabench::cli
