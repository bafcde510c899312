// The man page and the completions of shells, from the words of --help.
#pragma once
#include <CLI/CLI.hpp>
#include <string>

namespace lgabench::cli {

/// A page for man(1), and what bash, zsh and fish complete by, of an app with all its commands.
std::string man_page(const CLI::App& app);
std::string bash_completion(const CLI::App& app);
std::string zsh_completion(const CLI::App& app);
std::string fish_completion(const CLI::App& app);

}  // namespace lgabench::cli
