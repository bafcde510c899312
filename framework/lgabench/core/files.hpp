// Reading and writing whole files, and where the installation keeps its own. The only place that writes results.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace lgabench {

namespace fs = std::filesystem;

/// Whether a file may be a symbolic link. A file that a person names may be one, a file of a run may not.
enum class Links { followed, refused };

/// The bytes of a regular file: no device, pipe or directory, which could block a program or have no end.
/// @throws InputError naming the file and the system's reason, also for more than `most` bytes.
std::string read_file(const fs::path& file, Links links = Links::followed,
                      std::uintmax_t most = std::uintmax_t{1} << 30);

/// @throws InputError naming the first entry of a directory that is neither a regular file nor a directory. A missing
/// directory has no entries.
void expect_plain_entries(const fs::path& directory);

/// When a file is on the disk. `later` is for a directory that gets its name only after sync_file_system(): nobody
/// reads it before.
enum class Sync { now, later };

/// Writes to a temporary beside `file`, fsyncs, renames: a reader sees the old bytes or the new, unless synced later.
/// Makes missing parent directories. @throws InputError naming the file and the system's reason (a full disk included).
void write_file(const fs::path& file, std::string_view bytes, Sync sync = Sync::now);

/// Appends to `file`, which is made if need be, and fsyncs. A failed append is taken back: the file is then as it was.
/// @throws InputError naming the file and the system's reason.
void append_file(const fs::path& file, std::string_view bytes);

/// Whether write_file() left the file behind when its process was killed. remove_temporaries() deletes such files of a
/// directory that nobody writes into.
bool is_temporary(const fs::path& file);
void remove_temporaries(const fs::path& directory);

/// Names, without their ending, of the .json files in a directory, sorted; as many as could be read where `error` is
/// set.
std::vector<std::string> json_names(const fs::path& directory, std::error_code& error);

/// fsync of a directory, so that a rename in it survives a power cut.
void sync_directory(const fs::path& directory);

/// All that was written to the directory's file system is on the disk afterwards. @throws InputError
void sync_file_system(const fs::path& directory);

/// Directory of the library that this code is in, whatever program loaded it: environments lie beside it.
fs::path library_directory();

/// Installed data (scenarios/, suites/, spaces/, answers/, embeddings/, paper/): $LGABENCH_DATA, or ../share/lgabench
/// from the library.
fs::path data_directory();

/// Plugins shipped with the library: lgabench/plugins beside it.
fs::path shipped_plugin_directory();

/// Where the sentence encoder's weights are: $LGABENCH_ENCODER, else encoder/ in the data directory. It may not exist.
fs::path encoder_directory();
/// Whether this installation has the sentence encoder's library. A release's archive and wheel lack it, with LibTorch.
bool has_encoder_library();
/// How this installation gets the sentence encoder: a message's last words.
std::string encoder_remedy();

/// Directory of the running program.
fs::path program_directory();

}  // namespace lgabench
