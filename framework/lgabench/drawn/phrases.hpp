// Parts of a command, in words and in what these hold.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include <lgabench/core/meaning.hpp>
#include <lgabench/drawn/extent.hpp>
#include <lgabench/drawn/lexicon.hpp>

namespace lgabench::drawn {

/// "a fruit that is made of wood", "fruits that are made of wood"; empty where nobody would say it so.
struct Phrase {
  std::string a, many;
  Extent holds;
  std::vector<Extent> near;  // what a careless reading of one of its parts keeps
  std::vector<std::string> why;
};

Phrase phrase(const FeatureSpace& space, const Things& things);
/// `relative`: "that is made of wood", behind words that may end in any way; else "made of wood".
Phrase with(const FeatureSpace& space, Phrase phrase, const Look& look, bool relative);

/// "a vowel", "the vowels"; or "one with stripes", "those with stripes", which is said of many things differently.
struct Exception {
  std::string a, many;
  bool is_look = false;
  Extent holds;
  std::vector<std::string> why;
};

Exception except(const FeatureSpace& space, const Things& things);
Exception except(const FeatureSpace& space, const Look& look);
/// Not those of `things`, however they look.
Exception unless(const FeatureSpace& space, Exception look, const Things& things);

/// What is left without the exceptions. The words say so at the end of a request, or before a comma (`of_many`).
Phrase without(Phrase phrase, const std::vector<Exception>& exceptions, bool of_many);

/// Which of several is meant, after "bring me".
struct Rule {
  std::string words;
  Which which;
  std::vector<std::string> undecided;  // types that may be taken for the reference
  std::vector<std::string> why;
};

Rule relation(const FeatureSpace& space, Which::Rule rule, const Things& reference);
Rule comparison(const Order& order, bool last);

}  // namespace lgabench::drawn
