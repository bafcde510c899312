// Writes and reads what frames and shared memory hold, by the same code at both ends (docs/formats/method-protocol.md).
// A reader throws InputError for a value of another kind; its caller knows whose fault that is.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include <lgabench/core/method.hpp>
#include <lgabench/host/frames.hpp>
#include <lgabench/host/process_state.hpp>

namespace lgabench::host {

/// Returns call(); an InputError becomes Malformed.
template <class Call>
auto read_or_malformed(Call&& call) {
  try {
    return call();
  } catch (const InputError& e) {
    throw Malformed(e.what());
  }
}

Json to_json(const Command& command);
Command read_command(const JsonReader& reader);

Json to_json(const FeatureSpace& space);
FeatureSpace read_space(const JsonReader& reader);

/// A Selection as a method is told of it: with provenance, source and wording, and without cost.
Json selection_for_method(const Selection& selection);
/// Reads that, or what a method returns: {"target", a second set?}. Names as they are.
Selection read_selection(const JsonReader& reader);

Json to_json(const Instruction& instruction);
Instruction read_instruction(const JsonReader& reader);

Json to_json(const Needs& needs);
Needs read_needs(const JsonReader& reader);

/// A question about a command's second set bears the name of its role.
Json to_json(const Question& question, const Command& command);
Question read_question(const JsonReader& reader, const Command& command);

Json to_json(const std::vector<Hypothesis>& hypotheses);
Json to_json(const std::vector<Placed>& objects);
std::vector<Placed> read_placed(const JsonReader& reader);
std::vector<Hypothesis> read_hypotheses(const JsonReader& reader);

Json to_json(const SelectionCost& cost);
SelectionCost read_cost(const JsonReader& reader);

Json to_json(const ProcessState& state);
ProcessState read_state(const JsonReader& reader);

/// What a method said of one pass over its data.
struct LogEntry {
  int epochs = 0;
  long long steps = 0;
  double loss = 0;
  std::vector<std::pair<std::string, double>> curves{};
};
/// "log": NaN and infinite values included.
Frame log_frame(const std::vector<LogEntry>& entries);
std::vector<LogEntry> read_log(const Frame& frame);

/// "shown": colours in the payload, picture by picture. @throws MethodError as expect_shown()
Frame shown_frame(const Shown& shown);
Shown read_shown(const Frame& frame);

/// A double for each number; NaN and infinity included.
std::string to_bytes(const Action& action);
/// @throws InputError for bytes of another number of them.
Action read_action(const std::string& bytes, std::size_t numbers);

/// What observations and actions of an environment are, as the worker says it in "hello".
struct Layout {
  PictureSize picture;
  ActionSpace actions;
  std::vector<StateNumber> state = {};
  bool may_stop = false;  // as in Services
};
Json to_json(const Layout& layout);
Layout read_layout(const JsonReader& hello);
/// The first of them alone.
PictureSize read_picture_size(const JsonReader& hello);

/// A file in memory, mapped. It is freed with the last of its maps and descriptors.
class SharedMemory {
 public:
  /// Makes a file of this size, filled with 0. It is writable here; a receiver can neither write to it nor change its
  /// size.
  explicit SharedMemory(std::size_t size);
  /// Maps one that was sent, to be read. @throws InputError where it is smaller than `size`.
  SharedMemory(const Descriptor& file, std::size_t size);
  ~SharedMemory();
  SharedMemory(const SharedMemory&) = delete;
  SharedMemory& operator=(const SharedMemory&) = delete;

  std::uint8_t* data() { return static_cast<std::uint8_t*>(data_); }
  const std::uint8_t* data() const { return static_cast<const std::uint8_t*>(data_); }
  std::size_t size() const { return size_; }
  const Descriptor& file() const { return file_; }

 private:
  Descriptor file_;
  void* data_ = nullptr;
  std::size_t size_ = 0;
};

/// rgb, ids, then shadows, which are read only where the frame says that they are there.
inline std::size_t observation_bytes(PictureSize picture) { return 6 * picture.pixels(); }
/// Copies the pictures; instances are instances_json(). @throws Error for an observation of another size than the
/// memory's.
void write(const Observation& observation, SharedMemory& memory);
Json instances_json(const Observation& observation);
/// What an observation has beside pictures and instances, members of a frame: "state" and "brought" where there are
/// any.
Json beside_pictures(const Observation& observation);
/// Into `observation`. @throws InputError for a state of another length.
void read_beside_pictures(const JsonReader& frame, const Layout& layout, Observation& observation);
/// Into `observation`, whose memory it uses again. `shadows`: whether they are there.
void read_observation(const SharedMemory& memory, PictureSize picture, const JsonReader& instances, bool shadows,
                      Observation& observation);

/// What a perturbation made of an observation: rgb in the payload, and before it a frame "ids" with these.
Frame ids_frame(const Observation& perceived);
Frame perceived_frame(const Observation& perceived);
Observation read_perceived(const Frame& ids, const Frame& perceived, PictureSize picture);

/// All demonstrations as arrays in one sealed file, and the JSON that says where each lies.
struct DemonstrationFile {
  Json header;
  Descriptor file;
  std::size_t size = 0;  // bytes
};
DemonstrationFile pack(const Layout& layout, const std::vector<Demonstration>& demonstrations);
std::vector<Demonstration> unpack(const Layout& layout, const JsonReader& header, const Descriptor& file);

}  // namespace lgabench::host
