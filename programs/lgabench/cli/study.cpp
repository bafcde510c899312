// lgabench study: the user study that people take in a browser, from a protocol to participants' files.
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <ctime>
#include <memory>
#include <optional>
#include <random>

#include <lgabench/cli/help.hpp>
#include <lgabench/cli/own_names.hpp>
#include <lgabench/cli/verbs.hpp>
#include <lgabench/core/filled.hpp>
#include <lgabench/core/json.hpp>
#include <lgabench/core/refused.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/document/writers.hpp>
#include <lgabench/http/page_server.hpp>
#include <lgabench/record/layout.hpp>
#include <lgabench/study/pair_study.hpp>
#include <lgabench/study/report.hpp>
#include <lgabench/study/server.hpp>

namespace lgabench::cli {
namespace {

struct StudyArguments {
  std::string what, host, invitation, protocol = "paper";
  fs::path path, out;
  std::string bind = "127.0.0.1";
  int port = 8000, begins = 30;
  bool pin = false, rehearsal = false, behind_tls_proxy = false;
};

// What may stand in an address as it is.
bool is_word(const std::string& text) {
  return !text.empty() &&
         text.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789") == text.npos;
}

int new_study(const StudyArguments& a) {
  const fs::path templates = data_directory() / "protocols";
  const fs::path shipped = templates / (a.protocol + ".json.in");
  if (a.protocol.find('/') != a.protocol.npos || !fs::exists(shipped))
    throw InputError(fmt::format("--protocol {}: expected paper, crossover or disputed", a.protocol));
  if (std::error_code error; fs::exists(a.path / "protocol.json", error))
    throw InputError(fmt::format("{}: holds a study already; nothing was written", a.path.string()));
  const unsigned seed = std::random_device()() % 1000000;
  std::vector<std::pair<std::string, std::string>> drawn{{"@SEED@", std::to_string(seed)}};
  if (a.protocol == "disputed") drawn.emplace_back("@PAIRS@", study::disputed_items(seed).dump(1));
  const std::string protocol = filled(read_file(shipped), drawn);
  const Json json = parse_json(protocol, shipped.string());
  const std::vector<std::pair<std::string, std::string>> values{{"@DIR@", path_word(a.path)},
                                                                {"@MINUTES@", json.at("minutes").dump()}};
  write_file(a.path / "protocol.json", protocol);
  write_file(a.path / "consent.txt", read_file(templates / "consent.txt.in"));
  write_file(a.path / "README.md",
             filled(read_file(templates / (a.protocol == "disputed" ? "disputed.md.in" : "README.md.in")), values));
  for (const char* file : {"protocol.json", "consent.txt", "README.md"}) to_stdout("{}\n", (a.path / file).string());
  to_stdout("\nTo see what is left to fill in:\n  lgabench study check {}\n", path_word(a.path));
  to_stdout("To try it in a browser first:\n  lgabench study serve {} --out {} --rehearsal\n",
            path_word(a.path / "protocol.json"), path_word(a.path / "tried"));
  return ok;
}

// A protocol, or the directory of one.
fs::path protocol_file(const fs::path& path) { return fs::is_directory(path) ? path / "protocol.json" : path; }

int check(const StudyArguments& a) {
  const fs::path file = protocol_file(a.path);
  const study::Protocol protocol = study::read_protocol(file);
  const std::vector<std::string> blanks = study::blanks(protocol);
  for (const std::string& blank : blanks) to_stdout("to fill: {}\n", blank);
  to_stdout("{}: {} commands a person, {} people planned, ", protocol.id, protocol.trials(), protocol.planned);
  if (protocol.of_pairs())
    to_stdout("{}\n", study::power_words(protocol));
  else
    to_stdout("{} with spares for {} interruptions\n",
              protocol.crossover() ? "a crossover" : "each command in both conditions", protocol.spares.size());
  const fs::path pin = study::pin_file(file);
  if (a.pin && blanks.empty() && !fs::exists(pin)) write_file(pin, study::pin_of(protocol).dump(1) + "\n");
  if (!blanks.empty()) throw InputError(fmt::format("{}: {} blanks to fill in", file.string(), blanks.size()));
  if (const std::string why = study::not_ready(protocol, file); !why.empty())
    throw InputError(fmt::format("{}: {}", file.string(), why));
  to_stdout("pinned: {}\n", protocol.pin);
  return ok;
}

int serve(const StudyArguments& a) {
  const fs::path file = protocol_file(a.path);
  study::Protocol protocol = study::read_protocol(file);
  const study::Kind kind = a.rehearsal ? study::Kind::rehearsal : study::Kind::people;
  if (const std::string why = study::not_ready(protocol, file); !a.rehearsal && !why.empty())
    throw InputError(fmt::format("{}: {} (--rehearsal tries it without)", file.string(), why));
  const bool beyond = a.bind != "127.0.0.1" && a.bind != "::1" && a.bind != "localhost";
  if (beyond && !a.behind_tls_proxy)
    throw InputError(
        fmt::format("--bind {}: the study speaks plain HTTP, which others on the network can read and change; put a "
                    "server with TLS before it, and say so with --behind-tls-proxy",
                    a.bind));
  if (a.behind_tls_proxy && a.host.empty())
    throw InputError("--behind-tls-proxy: expected --host NAME too, the name that people open");
  ::umask(077);
  study::Study study(a.out, std::move(protocol), file, kind);
  for (const std::string& line : study.damaged()) to_stderr("LEFT OUT: {}\n", one_line(line));
  study::Server server(study, study::load_site(study.protocol()), {a.bind, a.port, a.host, a.invitation, a.begins});
  to_stdout("{} at http://{}:{}/{} (Ctrl-C stops it; the same command resumes it)\n",
            a.rehearsal ? "a rehearsal" : "the study", a.bind, server.port(),
            a.invitation.empty() ? "" : "?invitation=" + a.invitation);
  flush_stdout();
  study.tell([](const std::string& line) {
    try {
      to_stdout("{:%H:%M} {}\n", fmt::localtime(std::time(nullptr)), line);
      flush_stdout();
    } catch (const std::exception&) {  // nobody reads any more; the study continues
    }
  });
  http::until_stopped([&server] { server.run(); }, [&server] { server.stop(); });
  return ok;
}

int report_study(const StudyArguments& a) {
  const study::Report report = study::write_report(a.path);
  to_stdout("{}", document::terminal(report.document, a.path));
  to_stderr("{}\n", (a.path / report_file::page).string());
  if (report.damaged > 0) return usage;
  if (report.used > 0) return ok;
  to_stderr("{}: nobody's answers count: nothing was measured\n", a.path.string());
  return cells_failed;
}

int carry_out(const StudyArguments& a) {
  if (a.out.empty() && a.what == "serve") throw InputError(fmt::format("study {}: expected --out DIR", a.what));
  if (a.what == "new") return new_study(a);
  if (a.what == "check") return check(a);
  if (a.what == "report") return report_study(a);
  return serve(a);
}

}  // namespace

void add_study(CLI::App& app, int& exit) {
  auto a = std::make_shared<StudyArguments>();
  const std::vector<std::string> actions{"new", "check", "serve", "report"};
  Verb verb(app, "study", "Run a user study in a browser, for the rows Human and LGA-HILL");
  verb.option("what new|check|serve|report", a->what,
              "new: write a protocol into DIR, for you to fill in; check: say what is missing; serve: serve the "
              "pages of DIR's protocol; report: show the results",
              required, one_of("action", actions));
  verb.option("path DIR", a->path, "The study's directory or its protocol; for report, the directory that serve wrote",
              required);
  verb.option("--out DIR", a->out, "serve: where to store answers; a study already there is continued");
  verb.below("The protocol");
  verb.option("--protocol paper|crossover|disputed", a->protocol,
              "new: paper: the paper's study; crossover: nobody sees a command twice; disputed: people say whether "
              "commands mean the objects of disputed pairs",
              one_of("protocol", {"paper", "crossover", "disputed"}), with_default);
  verb.option("--pin", a->pin,
              "check: pin the protocol: write the hashes of what must not change into a file beside it");
  verb.below("The server");
  verb.option("--bind ADDRESS", a->bind, "serve: the address to listen on", with_default);
  verb.option("--port N", a->port, "serve: the port; 0: any free one", CLI::Range(0, 65535), with_default);
  verb.option("--behind-tls-proxy", a->behind_tls_proxy, "serve: the server runs behind a proxy that does TLS");
  verb.option("--host NAME", a->host, "serve: the host name (and port) of that proxy");
  verb.option("--invitation CODE", a->invitation,
              "serve: letters and digits of your choice; only people who open the link that contains them can begin",
              [](const std::string& text) {
                return is_word(text) ? std::string() : "expected letters and digits, got \"" + text + "\"";
              });
  verb.option("--begins N", a->begins, "serve: how many people may begin per minute", CLI::Range(1, 100000),
              with_default);
  verb.option("--rehearsal", a->rehearsal,
              "serve: try the study out, without a pin; its answers are marked, and no tool takes them for people's");
  verb->footer(
      "docs/study.md explains every step up to the first participant.\nExample: lgabench study new my_study\n         "
      "lgabench study serve my_study/protocol.json --out my_study/data");
  verb->callback([a, actions, verb = verb.get(), &exit] {
    expect_options_of(*verb, a->what, actions);
    exit = carry_out(*a);
  });
}

}  // namespace lgabench::cli
