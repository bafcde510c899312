#include <lgabench/leaderboard/revision.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/socket.h>

#include <algorithm>
#include <cstdio>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include <lgabench/core/descriptor.hpp>
#include <lgabench/core/error.hpp>
#include <lgabench/core/process.hpp>
#include <lgabench/core/refused.hpp>

namespace lgabench::leaderboard {
namespace {

// Objects of a working tree's repository, by one process of git that is asked for each. Reading objects looks at no
// index, attributes, filters or hooks; variables may name neither another repository nor a configuration, and objects
// that are missing are not fetched.
class Objects {
 public:
  explicit Objects(const fs::path& tree) {
    int ends[2];
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) throw Refused("socketpair");
    socket_ = ::fdopen(ends[0], "r");
    const Descriptor its{ends[1]}, null{::open("/dev/null", O_WRONLY | O_CLOEXEC)};
    std::vector<std::string> variables = environment_with({"LC_ALL=C"});
    variables.erase(std::remove_if(variables.begin(), variables.end(),
                                   [](const std::string& variable) { return variable.rfind("GIT_", 0) == 0; }),
                    variables.end());
    variables.emplace_back("GIT_ALLOW_PROTOCOL=");
    git_ = start_process({{"git", "-C", tree.string(), "--no-pager", "-c", "safe.bareRepository=explicit", "-c",
                           "core.fsmonitor=false", "-c", "core.hooksPath=/dev/null", "cat-file", "--batch"},
                          variables,
                          {{its.fd, 0}, {its.fd, 1}, {null.fd, 2}}});
  }
  ~Objects() {
    std::fclose(socket_);
    wait_for(git_);
  }
  Objects(const Objects&) = delete;
  Objects& operator=(const Objects&) = delete;

  /// The bytes of an object, by any name that git knows; none where no such object is of this type.
  std::optional<std::string> bytes(const std::string& name, std::string_view type) {
    if (name.find('\n') != name.npos) return std::nullopt;  // git would take it for two names
    const std::string line = name + "\n";
    if (::send(::fileno(socket_), line.data(), line.size(), MSG_NOSIGNAL) != static_cast<ssize_t>(line.size()))
      return std::nullopt;
    std::string about;  // HASH TYPE SIZE, or NAME missing
    for (int c; (c = std::getc(socket_)) != '\n'; about += static_cast<char>(c))
      if (c == EOF) return std::nullopt;
    const std::size_t digits = about.rfind(' ') + 1;
    if (about.find_first_not_of("0123456789", digits) != about.npos) return std::nullopt;
    std::string bytes(static_cast<std::size_t>(std::stoull(about.substr(digits))) + 1, '\n');
    if (std::fread(bytes.data(), 1, bytes.size(), socket_) != bytes.size()) return std::nullopt;
    bytes.pop_back();
    return about.find(fmt::format(" {} ", type)) == about.npos ? std::nullopt : std::optional(bytes);
  }

 private:
  std::FILE* socket_ = nullptr;
  pid_t git_ = -1;
};

// A commit cannot hold .git, so that no request brings one.
bool is_working_tree(const fs::path& directory) { return fs::exists(fs::symlink_status(directory / ".git")); }

// The board's place in the working tree that it is in.
fs::path place_in_tree(const fs::path& board) {
  const fs::path directory = fs::absolute(board / "").lexically_normal().parent_path();
  fs::path tree = directory;
  for (; !is_working_tree(tree); tree = tree.parent_path()) {
    if (fs::is_symlink(tree))
      throw InputError(fmt::format("{}: a symbolic link; a board is in a working tree of git", tree.string()));
    if (tree == tree.root_path())
      throw InputError(fmt::format("{}: expected a board in a working tree of git", directory.string()));
  }
  if (tree == directory)
    throw InputError(fmt::format("{}: a repository of its own; a board is a directory of one", directory.string()));
  return directory.lexically_relative(tree);
}

// What stands up to `end`, which is passed.
std::string taken(std::string_view& text, char end) {
  const std::size_t at = std::min(text.find(end), text.size());
  const std::string part(text.substr(0, at));
  text.remove_prefix(std::min(at + 1, text.size()));
  return part;
}

}  // namespace

std::map<std::string, std::string> files_at(const std::string& revision, const fs::path& board) {
  const std::string place = place_in_tree(board).string() + "/";
  fs::path here = fs::current_path();
  while (!is_working_tree(here) && here != here.root_path()) here = here.parent_path();
  if (!is_working_tree(here))
    throw InputError(fmt::format("--against {}: run the command in the checkout that has this revision; {} is in none",
                                 revision, fs::current_path().string()));
  const auto expected = [&](const std::optional<std::string>& said) {
    if (!said)
      throw InputError(fmt::format("--against {}: expected a revision of git that {} has, and its history", revision,
                                   here.string()));
    return *said;
  };
  Objects objects(here);
  std::optional<std::string> commit;
  for (const char* kind : {"refs/heads/", "refs/remotes/", ""})
    if (!commit) commit = objects.bytes(kind + revision + "^{commit}", "commit");
  const std::string root = expected(commit).substr(0, commit->find('\n')).substr(std::string_view("tree ").size());
  std::map<std::string, std::string> files;
  const std::function<void(const std::string&, const std::string&)> add = [&](const std::string& tree,
                                                                              const std::string& above) {
    const std::string entries = expected(objects.bytes(tree, "tree"));
    for (std::string_view rest = entries; !rest.empty();) {  // MODE NAME, a zero, the bytes of HASH
      const bool is_tree = taken(rest, ' ') == "40000";
      const std::string path = above + taken(rest, '\0') + (is_tree ? "/" : "");
      std::string hash;
      for (; hash.size() < root.size() && !rest.empty(); rest.remove_prefix(1))
        hash += fmt::format("{:02x}", static_cast<unsigned char>(rest.front()));
      const bool is_in_board = path.rfind(place, 0) == 0;
      if (is_tree && (is_in_board || place.rfind(path, 0) == 0))
        add(hash, path);
      else if (is_in_board)
        files[path.substr(place.size())] = expected(objects.bytes(hash, "blob"));
    }
  };
  add(root, "");
  return files;
}

}  // namespace lgabench::leaderboard
