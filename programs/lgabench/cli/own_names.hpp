// Names of what the commands new-... and draw-commands write, so that what they print works as it is.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>

namespace lgabench::cli {

/// @throws InputError unless the name is at most 63 lower-case letters, digits and underscores, a letter first.
void expect_plain_name(std::string_view verb, const std::string& name);

/// @throws InputError where a scenario that is found has the id: a second file of it would stop all commands that look
/// beside it.
void expect_free_scenario(std::string_view verb, const std::string& id);

/// @throws InputError where a shipped suite has the id, for which a run of this one would be taken.
void expect_free_suite(std::string_view verb, const std::string& id);

/// The path as a word of a shell, which no program takes for an option.
std::string path_word(const std::filesystem::path& path);

}  // namespace lgabench::cli
