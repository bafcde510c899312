// All that a plugin's author includes. Write a class, name it in one macro at file scope, outside any namespace:
//
//   #include <lgabench/plugin/plugin.hpp>
//   class Mine : public lgabench::Method { ... };
//   LGABENCH_METHOD("mine", "0.1", "what it does, in a line", Mine, R"({
//     "epochs": {"default": 750, "help": "passes over the demonstrations", "source": "paper, appendix"}})")
//
// An option's default fixes its type (text, number, whole number, boolean); "values", if given, lists all it may be;
// "min" and "max" the least and the most that a number may be, "words" texts that may stand in its place; "needs", of
// an option with "values", which other options a value goes with:
// {"value": {"other option": [its values]}}. Anything else is refused before a cell runs. "framework": true is for
// options that mean what CloningMethod's of that name do: a suite sets them for all methods ("*"), and no others.
#pragma once
#include <type_traits>

#include <lgabench/core/method.hpp>
#include <lgabench/core/observation_perturbation.hpp>
#include <lgabench/core/perceiver.hpp>
#include <lgabench/core/physics_world.hpp>
#include <lgabench/plugin/descriptor.hpp>
#include <lgabench/plugin/fingerprint.hpp>

/// A method: `Class` derives from lgabench::Method and has a default constructor. Once in a library.
#define LGABENCH_METHOD(id, version, summary, Class, options_json) \
  LGABENCH_METHOD_ASKING("", id, version, summary, Class, options_json)

/// A method that asks more than the language model. `asks` is "specify" or "edit": people, as HumanAnswers says; with
/// `lgabench run --humans` it has a cell for each of them, and a method that edits starts from the recorded answers
/// that people were given to edit. Or "accept": people are shown objects, and say whether they would take them, for
/// whom the truth stands in. Or "truth": Services::truth, for a diagnosis that is nobody's entry. Or "network":
/// its process may open sockets; its rows are marked, and no leaderboard ranks them.
#define LGABENCH_METHOD_ASKING(asks, id, version, summary, Class, options_json) \
  LGABENCH_PLUGIN_("method", asks, id, version, summary, ::lgabench::Method, Class, options_json)

/// In front of the options of a method whose select() asks select_features()'s questions, in any case: "{"
/// LGABENCH_QUESTIONNAIRE R"("epochs": ...})". Where a run asks a server, it asks them for all of its cells beforehand.
#define LGABENCH_QUESTIONNAIRE R"("questionnaire": true, )"

/// An option of a method whose select() calls select_as_asked(). One that came after the method was published: at its
/// default no cell's configuration mentions it.
#define LGABENCH_MEANING_OPTION                                                                                         \
  R"("meaning": {"framework": true, "added": true, "default": "flat", "values": ["flat", "structured", "named"], )"     \
  R"("help": "what the language model is asked: yes or no of each object type and texture; or, in one question, what )" \
  R"(the command means (sets, and which of several objects); named: nothing, the names in the command are taken",)"     \
  R"("source": "flat: paper, section 3.1; the others: ours"})"

/// An engine: `Class` derives from lgabench::PhysicsWorld and has a default constructor. Once in a library.
#define LGABENCH_ENGINE(id, version, summary, Class) \
  LGABENCH_PLUGIN_("engine", "", id, version, summary, ::lgabench::PhysicsWorld, Class, "{}")

/// Likewise, whose bodies have neither mass nor friction: perturbations of these are refused.
#define LGABENCH_KINEMATIC_ENGINE(id, version, summary, Class) \
  LGABENCH_PLUGIN_("engine", "", id, version, summary, ::lgabench::PhysicsWorld, Class, R"({"kinematic": true})")

/// A perturbation axis that changes what is perceived: `Class` derives from lgabench::ObservationPerturbation and has a
/// default constructor. Once in a library. `axis_json`: {"levels": [what each is, in a few words, level 1 first],
/// "changes": [parts that differ in nearly every episode], "may_change": [in some]}, parts being "rgb", "ids" and
/// "instances", the last of the members only where there are any; "named": true where levels are kinds without an
/// order.
#define LGABENCH_PERTURBATION(id, version, summary, Class, axis_json) \
  LGABENCH_PLUGIN_("perturbation", "", id, version, summary, ::lgabench::ObservationPerturbation, Class, axis_json)

/// What reads names from pictures: `Class` derives from lgabench::Perceiver and has a default constructor. Once in a
/// library.
#define LGABENCH_PERCEIVER(id, version, summary, Class) \
  LGABENCH_PLUGIN_("perceiver", "", id, version, summary, ::lgabench::Perceiver, Class, "{}")

// The descriptor stands in a section of its own, so that `readelf -p .lgabench` shows it too.
// NOLINTBEGIN(bugprone-macro-parentheses): Interface and Class are types.
#define LGABENCH_PLUGIN_(kind, asks, id, version, summary, Interface, Class, options_json)                     \
  static_assert(std::is_base_of<Interface, Class>::value, #Class " must derive from " #Interface);             \
  namespace {                                                                                                  \
  [[gnu::section(".lgabench"), gnu::used]] constexpr ::lgabench::PluginDescriptor lgabench_plugin_descriptor = \
      ::lgabench::describe_plugin(kind, asks, id, version, summary, LGABENCH_FINGERPRINT, options_json);       \
  void* lgabench_plugin_create() { return static_cast<Interface*>(new Class); }                                \
  }                                                                                                            \
  extern "C" {                                                                                                 \
  [[gnu::visibility("default")]] extern const ::lgabench::PluginEntry lga_plugin_v1;                           \
  const ::lgabench::PluginEntry lga_plugin_v1{&lgabench_plugin_descriptor, &lgabench_plugin_create};           \
  }
// NOLINTEND(bugprone-macro-parentheses)
