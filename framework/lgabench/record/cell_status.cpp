#include <lgabench/record/cell_status.hpp>

#include <fmt/format.h>

#include <limits>
#include <string_view>

#include <lgabench/core/hash.hpp>
#include <lgabench/record/cell.hpp>
#include <lgabench/record/layout.hpp>

namespace lgabench {
namespace {

fs::path file_of(const fs::path& cell) { return cell / cell_file::status; }

}  // namespace

bool has_status(const fs::path& cell) {
  std::error_code not_there;
  return fs::exists(file_of(cell), not_there);
}

CellStatus read_cell_status(const fs::path& cell) {
  const Json json = read_json(file_of(cell), Links::refused);
  const JsonReader reader(json, file_of(cell).string());
  CellStatus status;
  const std::string state = reader.at("state").string();
  if (state != "ok" && state != "failed") reader.at("state").fail("ok or failed");
  status.failed = state == "failed";
  if (!reader.at("build").json().is_object()) reader.at("build").fail("an object");
  status.build = reader.at("build").json();
  if (!status.failed) {
    const JsonReader files = reader.at("files");
    std::vector<std::string> names{cell_files.begin(), cell_files.end()};
    names.emplace_back(cell_file::perturbed);
    files.only(names);
    for (const auto& file : files.json().items()) status.files[file.key()] = files.at(file.key()).string();
    if (reader.has("method_error")) status.method_error = reader.at("method_error").string();
    return status;
  }
  const auto text = [&](const char* member) { return reader.has(member) ? reader.at(member).string() : std::string(); };
  status.reason = text("reason");
  status.fault = text("fault");
  if (reader.has("signal") && !reader.at("signal").json().is_null())
    status.signal = static_cast<int>(reader.at("signal").integer(1, std::numeric_limits<int>::max()));
  if (reader.has("log_tail")) status.log_tail = reader.at("log_tail").strings();
  return status;
}

void write_cell_status(const fs::path& cell, const CellStatus& status) {
  Json json{{"state", status.failed ? "failed" : "ok"}, {"build", status.build}, {"files", Json::object()}};
  for (const auto& [name, hash] : status.files) json["files"][name] = hash;
  if (status.failed)
    json.update({{"reason", status.reason},
                 {"fault", status.fault},
                 {"signal", status.signal ? Json(status.signal) : Json()},
                 {"log_tail", status.log_tail}});
  else if (!status.method_error.empty())
    json["method_error"] = status.method_error;
  write_file(file_of(cell), canonical(json) + '\n');
}

fs::path changed_file(const fs::path& cell, const CellStatus& status) {
  for (const auto& [name, hash] : status.files)
    if (hash != sha256_file(cell / name)) return cell / name;
  return {};
}

CellState cell_state(const fs::path& cell, const std::string& key, const Json& build) {
  CellState state;
  std::error_code not_there;
  if (!fs::exists(cell, not_there)) return state;
  const auto not_its_own = [&](const fs::path& file) {
    state.why = fmt::format("{} does not have the bytes that were written", file.string());
    return state;
  };
  try {
    expect_plain_entries(cell);
    const CellStatus status = read_cell_status(cell);
    if (status.failed) {
      state.failed = true;
      state.why = "failed: " + status.reason;
      return state;
    }
    for (const char* name : cell_files)
      if (std::string_view(name) != cell_file::log && status.files.count(name) == 0)
        throw InputError(fmt::format("{}: /files: expected a member \"{}\"", file_of(cell).string(), name));
    if (const fs::path changed = changed_file(cell, status); !changed.empty()) return not_its_own(changed);
    if (sha256(canonical(read_json(cell / cell_file::configuration))).substr(0, key.size()) != key)
      return not_its_own(cell / cell_file::configuration);
    for (const auto& [program, hash] : build.items())
      if (status.build.value(program, Json()) != hash) {
        state.other_build = true;
        state.why = fmt::format("computed by another build ({} differs)", program);
        return state;
      }
    state.build = status.build;
    state.complete = true;
  } catch (const InputError& e) {
    state.why = e.what();
  }
  return state;
}

}  // namespace lgabench
