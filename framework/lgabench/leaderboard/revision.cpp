#include <lgabench/leaderboard/revision.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>

#include <algorithm>
#include <optional>
#include <string_view>
#include <vector>

#include <lgabench/core/descriptor.hpp>
#include <lgabench/core/error.hpp>
#include <lgabench/core/process.hpp>
#include <lgabench/core/scratch.hpp>

namespace lgabench::leaderboard {
namespace {

// What git prints in a working tree, given its input; none where it fails. Called for commands that read objects alone,
// which look at no index, attributes, filters or hooks; variables may name neither another repository nor a
// configuration, and objects that are missing are not fetched.
std::optional<std::string> git(const fs::path& tree, std::vector<std::string> words, std::string_view input = "") {
  const Scratch scratch("git");
  write_file(scratch.path / "in", input);
  const Descriptor in{::open((scratch.path / "in").c_str(), O_RDONLY | O_CLOEXEC)},
      out{::open((scratch.path / "out").c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600)},
      null{::open("/dev/null", O_WRONLY | O_CLOEXEC)};
  words.insert(words.begin(),
               {"git", "-C", tree.string(), "--no-pager", "--literal-pathspecs", "-c", "safe.bareRepository=explicit",
                "-c", "core.fsmonitor=false", "-c", "core.hooksPath=/dev/null"});
  std::vector<std::string> variables = environment_with({"LC_ALL=C"});
  variables.erase(std::remove_if(variables.begin(), variables.end(),
                                 [](const std::string& variable) { return variable.rfind("GIT_", 0) == 0; }),
                  variables.end());
  variables.emplace_back("GIT_ALLOW_PROTOCOL=");
  const int status = wait_for(start_process({words, variables, {{in.fd, 0}, {out.fd, 1}, {null.fd, 2}}}));
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) return std::nullopt;
  return read_file(scratch.path / "out");
}

// A commit cannot hold .git, so that no request brings one.
bool is_working_tree(const fs::path& directory) { return fs::exists(fs::symlink_status(directory / ".git")); }

// The board's place in the working tree that it is in.
fs::path place_in_tree(const fs::path& board) {
  const fs::path own = fs::absolute(board / "").lexically_normal().parent_path();
  fs::path tree = own;
  for (; !is_working_tree(tree); tree = tree.parent_path()) {
    if (fs::is_symlink(tree))
      throw InputError(fmt::format("{}: a symbolic link; a board is in a working tree of git", tree.string()));
    if (tree == tree.root_path())
      throw InputError(fmt::format("{}: expected a board in a working tree of git", own.string()));
  }
  if (tree == own)
    throw InputError(fmt::format("{}: a repository of its own; a board is a directory of one", own.string()));
  return own.lexically_relative(tree);
}

// What stands up to `end`, which is passed.
std::string_view taken(std::string_view& text, char end) {
  const std::size_t at = std::min(text.find(end), text.size());
  const std::string_view part = text.substr(0, at);
  text.remove_prefix(std::min(at + 1, text.size()));
  return part;
}

}  // namespace

std::map<std::string, std::string> files_at(const std::string& revision, const fs::path& board) {
  const std::string place = place_in_tree(board).string() + "/";
  fs::path here = fs::current_path();
  while (!is_working_tree(here) && here != here.root_path()) here = here.parent_path();
  if (!is_working_tree(here))
    throw InputError(fmt::format("--against {}: call it in the checkout that has this revision; {} is in none",
                                 revision, fs::current_path().string()));
  const auto expected = [&](const std::optional<std::string>& said) {
    if (!said)
      throw InputError(fmt::format("--against {}: expected a revision of git that {} has, and its history", revision,
                                   here.string()));
    return *said;
  };
  std::optional<std::string> commit;
  for (const char* kind : {"refs/heads/", "refs/remotes/", ""})
    if (!commit)
      commit = git(here, {"rev-parse", "--verify", "--quiet", "--end-of-options", kind + revision + "^{commit}"});
  const std::string hash = expected(commit).substr(0, commit->find('\n'));
  const std::string tree = expected(git(here, {"ls-tree", "-r", "-z", "--full-tree", hash, place}));
  std::vector<std::string> names;
  std::string blobs;
  for (std::string_view rest = tree; !rest.empty();) {  // MODE TYPE HASH, a tab, PATH
    const std::string_view about = taken(rest, '\t');
    names.emplace_back(taken(rest, '\0').substr(place.size()));
    blobs += std::string(about.substr(about.rfind(' ') + 1)) + "\n";
  }
  const std::string contents = expected(git(here, {"cat-file", "--batch"}, blobs));
  std::map<std::string, std::string> files;
  std::string_view rest = contents;
  for (const std::string& name : names) {  // HASH TYPE SIZE, then the bytes
    const std::string_view about = taken(rest, '\n');
    if (about.find(" blob ") == about.npos) expected({});
    const auto size = static_cast<std::size_t>(std::stoull(std::string(about.substr(about.rfind(' ') + 1))));
    files[name] = rest.substr(0, size);
    rest.remove_prefix(std::min(size + 1, rest.size()));
  }
  return files;
}

}  // namespace lgabench::leaderboard
