// lgabench-worker cell: one cell, described on stdin. `lgabench run` starts it; by hand: lgabench-worker cell <job.json
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstdio>
#include <iostream>
#include <iterator>

#include <lgabench/cli/verbs.hpp>
#include <lgabench/harness/run_cell.hpp>

namespace lgabench::cli {
namespace {

// Lines of JSON on descriptor 3, if whoever started us opened it. Before anything else is opened, or it could be that.
class Messages {
 public:
  Messages() : open_(::fcntl(3, F_GETFD) != -1) {}
  void send(const Json& message) const {
    if (!open_) return;
    const std::string line = message.dump(-1, ' ', false, Json::error_handler_t::replace) + '\n';
    [[maybe_unused]] const ssize_t sent = ::write(3, line.data(), line.size());  // nobody listening: no harm
  }

 private:
  bool open_;
};

void limit(int resource, long long value) {
  const rlimit both{static_cast<rlim_t>(value), static_cast<rlim_t>(value)};
  ::setrlimit(static_cast<__rlimit_resource>(resource), &both);
}

// Before any plugin is loaded: a crash leaves no core; a loop, a leak or a log without end ends with this process.
void apply_limits(const JsonReader& limits) {
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_FSIZE, 1LL << 28);
  limit(RLIMIT_CPU, limits.at("cpu_s").integer(1, 1LL << 40));
#if !defined(__SANITIZE_ADDRESS__)  // whose shadow memory counts
  limit(RLIMIT_DATA, limits.at("data_bytes").integer(1, 1LL << 60));
#endif
}

PluginInfo plugin(const JsonReader& reader) {
  PluginInfo info = read_plugin(reader.at("file").string());
  if (info.sha256 != reader.at("sha256").string())
    throw PluginError(fmt::format("{}: changed since the run began", info.file.string()));
  return info;
}

void run(const Messages& messages) {
  const std::string text((std::istreambuf_iterator<char>(std::cin)), {});
  const Json json = Json::parse(text, nullptr, false);
  const JsonReader reader(json, "job");
  apply_limits(reader.at("limits"));
  CellJob job{read_cell(reader.at("cell").json(), "job: /cell"),
              plugin(reader.at("engine")),
              std::nullopt,
              reader.at("directory").string(),
              reader.at("cache").string(),
              reader.at("answers").string(),
              reader.at("build").json()};
  if (reader.has("method")) job.method = plugin(reader.at("method"));
  if (job.cell.method.is_reference() == job.method.has_value())
    reader.at("cell").fail("a plugin for a method, and only there");
  run_cell(job, [&messages](const std::string& phase, long long count) {
    messages.send({{"phase", phase}, {"count", count}});
  });
}

}  // namespace

void add_cell(CLI::App& app, int&) {
  CLI::App* verb = app.add_subcommand("cell", "Compute the cell described as JSON on stdin; progress on descriptor 3");
  verb->callback([] {
    const Messages messages;
    const auto complain = [&messages](const std::exception& e, const char* fault) {
      messages.send({{"reason", e.what()}, {"fault", fault}});
    };
    try {
      run(messages);
    } catch (const MethodError& e) {
      complain(e, "plugin");
      throw;
    } catch (const PluginError& e) {
      complain(e, "plugin");
      throw;
    } catch (const std::bad_alloc&) {
      const MethodError e("out of memory (the limit is --memory)");
      complain(e, "plugin");
      throw e;
    } catch (const std::exception& e) {
      complain(e, "host");
      throw;
    }
    // All is on the disk. What plugins do at exit can neither help nor harm any more.
    std::fflush(nullptr);
    ::_exit(ok);
  });
}

}  // namespace lgabench::cli
