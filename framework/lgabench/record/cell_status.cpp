#include <lgabench/record/cell_status.hpp>

#include <fmt/format.h>

#include <array>
#include <string_view>

#include <lgabench/core/fields.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/record/layout.hpp>

namespace lgabench {
namespace {

fs::path file_of(const fs::path& cell) { return cell / cell_file::status; }

}  // namespace

bool has_status(const fs::path& cell) {
  std::error_code not_there;
  return fs::exists(file_of(cell), not_there);
}

void fields(CellStatus& status, Fields& field) {
  static constexpr std::array states{"ok", "failed"};
  std::string state = states.at(status.failed ? 1 : 0);
  field("state", state, one_of(states));
  status.failed = state == states[1];
  field("build", status.build, object());
  const JsonReader* const reader = field.reading();
  if (Json files(status.files); !reader || !status.failed) field("files", files, object());
  if (!status.failed) {
    std::vector<std::string> names{cell_files.begin(), cell_files.end()};
    names.emplace_back(cell_file::perturbed);
    if (reader) reader->at("files").only(names);
    for (const std::string& name : names)
      if (reader && reader->at("files").has(name)) status.files[name] = reader->at("files").at(name).string();
    field("method_error", status.method_error, when(!status.method_error.empty()));
    return;
  }
  field("reason", status.reason, may_lack());
  field("fault", status.fault, may_lack());
  field("signal", status.signal, or_null(status.signal == 0, at_least(1, may_lack())));
  field("log_tail", status.log_tail, may_lack());
}

CellStatus read_cell_status(const fs::path& cell) {
  const Json json = read_json(file_of(cell), Links::refused);
  return value_of<CellStatus>(JsonReader(json, file_of(cell).string()), false);
}

void write_cell_status(const fs::path& cell, const CellStatus& status) {
  write_file(file_of(cell), canonical(json_of(status)) + '\n');
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
    state.why = fmt::format("{} changed since it was written", file.string());
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
