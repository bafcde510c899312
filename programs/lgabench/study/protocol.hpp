// What a study does, as its file says (docs/formats: a study's protocol): commands, design, exclusions.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include <lgabench/core/language_model.hpp>

namespace lgabench::study {

/// The paper's two ways to specify φ̂: from empty lists, or from a language model's proposal.
enum class Condition { human, lga_hill };
inline constexpr std::array conditions{Condition::human, Condition::lga_hill};
/// The condition's place in `conditions`.
inline std::size_t index(Condition condition) { return static_cast<std::size_t>(condition); }
/// "human" or "lga_hill": the method whose rows use the answers.
std::string to_string(Condition condition);
/// @throws InputError for another word, with its place.
Condition read_condition(const JsonReader& reader);

/// An object of which people say whether the command could mean it.
struct AskedPair {
  std::string object_type, texture;
  std::optional<bool> settled;  // what the truth says of a control; none of a disputed pair
};

/// What a person is asked, and what is proposed to them in the condition lga_hill.
struct Item {
  std::string scenario;  // "" for a practice command that no scenario has
  Command command;
  std::string asked_as, hint;  // the words that are shown; a remark below them, or ""
  FeatureSpace space;
  Selection proposal;
  std::string proposed_by;
  std::optional<Selection> truth;  // the released one; none for practice
  std::vector<AskedPair> pairs;    // of a study of disputed pairs, which asks for these in place of lists
};

/// When NASA-TLX is asked: by_condition, after each of the two parts, about that part.
enum class Tlx { never, at_end, by_condition };

/// A protocol, read and checked, with everything that people are shown.
struct Protocol {
  std::string id, title;
  std::string researcher, contact, ethics, license;
  std::string consent;  // the consent file's text
  std::uint64_t seed = 0;
  int planned = 0, minutes = 0;  // people; how long the study takes
  /// One set: both conditions ask all of it, in its order. Two: each condition asks one of them, in an order from a
  /// Williams square, and nobody sees a command twice.
  std::vector<std::vector<Item>> sets;
  bool meanings = false;        // people may name several kinds, and which of several objects is meant
  std::string instruction;      // how to work, shown before practice and before each command; "" for none
  std::vector<Item> spares;     // take the place of a trial that was interrupted
  Item practice;                // once in each condition, before anything is timed
  std::string example_command;  // the worked example
  Selection example;            // and its answer
  FeatureSpace example_space;
  int fewest_trials = 1;            // in each condition; who finished fewer is left out of every test
  std::optional<double> longest_s;  // a trial that took longer is left out
  int most_controls_failed = 1000;  // who failed more is left out
  Tlx tlx = Tlx::never;
  bool free_text = false;  // asked at the end

  Json json;           // as read
  std::string sha256;  // of the file's bytes
  std::string bytes;   // the file
  std::string pin;     // see pin_of()

  bool crossover() const { return sets.size() == 2; }
  /// People judge pairs, each command once, without conditions.
  bool of_pairs() const { return !practice.pairs.empty(); }
  /// Trials that are planned for a person, in both conditions together, without practice.
  std::size_t trials() const {
    return crossover() ? sets[0].size() + sets[1].size() : sets[0].size() * (of_pairs() ? 1 : 2);
  }
};

/// Reads protocol and consent file. @throws InputError with file and place.
Protocol read_protocol(const fs::path& file);

/// What of protocol and consent the researcher has yet to fill: "protocol.json: [[YOUR NAME]]"; none when ready.
std::vector<std::string> blanks(const Protocol& protocol);

/// The file beside a protocol that holds its pin.
fs::path pin_file(const fs::path& protocol);
/// What pins a study: SHA-256 of the protocol's bytes, the consent's, and of all that people are shown and judged by
/// (spaces, wordings, proposals, truths), which lie in other files.
Json pin_of(const Protocol& protocol);
/// Why a study of people may not begin: blanks, no pin, or a pin of something else. "" if it may.
std::string not_ready(const Protocol& protocol, const fs::path& file);

}  // namespace lgabench::study
