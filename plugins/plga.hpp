// PLGA: as LGA, with what the person leaves unsaid, as far as what they take shows it (after Peng et al., HRI 2024).
#pragma once
#include <lgabench/abstraction/preference.hpp>
#include <lgabench/abstraction/select_features.hpp>
#include <lgabench/core/contains.hpp>
#include <lgabench/drawn/persons.hpp>
#include <lgabench/learning/cloning_method.hpp>

#define PLGA_UNLISTED                                                                                              \
  R"(,"unlisted": {"default": 0.3, "min": 0, "max": 1, )"                                                          \
  R"("help": "share of the prior for rules of the grammar of persons, which the language model did not name; 1: )" \
  R"(it is not asked", "source": "ours"})"

class Plga : public lgabench::CloningMethod {
 public:
  lgabench::Needs needs(const lgabench::Json& options) const override {
    lgabench::Needs needs = CloningMethod::needs(options);
    needs.revise = true;
    return needs;
  }
  lgabench::Selection select(const lgabench::Command& command, const lgabench::FeatureSpace& space,
                             lgabench::Services& services) override {
    space_ = space;
    const double unlisted = services.options.at("unlisted");
    const auto* const words =
        grammar().words.empty() ? nullptr : lgabench::drawn::words_in(grammar(), command.utterance);
    if (unlisted < 1 || !words) return lgabench::select_as_asked(command, space, services);
    lgabench::Selection selection;  // nobody is asked: what the grammar says of the words
    selection.target = lgabench::Meaning(words->types, space.textures);
    selection.provenance = lgabench::Provenance::rule;
    return selection;
  }
  lgabench::Selection revise(const lgabench::Command& command, const lgabench::Selection& selected,
                             const std::vector<lgabench::Demonstration>& demonstrations,
                             lgabench::Services& services) override {
    lgabench::Asking asking{services.options.value("questions", 0), unlisted(selected.target),
                            services.options.at("unlisted")};
    return lgabench::preferred(command, selected, space_, demonstrations, services, asking);
  }

 private:
  const lgabench::drawn::PersonGrammar& grammar() {
    if (!grammar_) grammar_ = lgabench::drawn::person_grammar(space_);
    return *grammar_;
  }
  // Rules on what the words hold, where that is one product.
  std::vector<lgabench::Hypothesis> unlisted(const lgabench::Meaning& words) {
    std::vector<lgabench::Hypothesis> all;
    if (!words.is_product() || words.empty()) return all;
    for (const lgabench::drawn::PersonRule& rule : lgabench::drawn::rules_of(grammar(), words.product().object_types)) {
      lgabench::Meaning meaning = lgabench::drawn::meaning_of(rule, space_);
      std::vector<std::string> textures;
      for (const std::string& texture : meaning.sets.front().textures)
        if (lgabench::contains(words.product().textures, texture)) textures.push_back(texture);
      meaning.sets.front().textures = std::move(textures);
      if (!meaning.empty()) all.push_back({"a rule of the grammar", std::move(meaning), rule.prior});
    }
    return all;
  }

  lgabench::FeatureSpace space_;
  std::optional<lgabench::drawn::PersonGrammar> grammar_;
};
