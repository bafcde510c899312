// The installation's data (data_directory()), which does not change while a process lives: each file is read once.
#pragma once
#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include <lgabench/core/json.hpp>

namespace lgabench {

/// Values that are made once each, when they are first asked for. Several threads may ask; they wait for each other.
template <class Value, class Key = std::string>
class MadeOnce {
 public:
  /// The value of that key, made by `make` unless it is there; stays where it is. What `make` throws passes through,
  /// and the next who asks makes it again. @pre `make` asks for no other value of these.
  template <class Make>
  const Value& of(const Key& key, Make&& make) {
    const std::lock_guard lock(mutex_);
    const auto known = values_.find(key);
    return known != values_.end() ? known->second : values_.emplace(key, make()).first->second;
  }

 private:
  std::mutex mutex_;
  std::map<Key, Value> values_;
};

/// Whether a file belongs to that data.
bool is_shipped(const std::filesystem::path& file);

/// A file's JSON, as read_json() reads it; of a file that is not shipped, read anew each time. @throws InputError
Json read_shipped_json(const std::filesystem::path& file);

/// SHA-256 of a shipped file's bytes. @throws InputError
const std::string& shipped_sha256(const std::filesystem::path& file);

/// Names, without their ending, of the .json files in a folder of the data, sorted; none where there is no folder.
const std::vector<std::string>& shipped_names(const std::string& folder);
/// Names of the shipped files of recorded answers: "NAME" for those in answers/, and "FOLDER/NAME". A folder's files
/// are no part of the data of who reads answers of another.
const std::vector<std::string>& shipped_answers();

}  // namespace lgabench
