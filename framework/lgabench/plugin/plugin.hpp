// All that a plugin's author includes. Write a class, and name it in one macro at file scope, outside any namespace:
//
//   #include <lgabench/plugin/plugin.hpp>
//   class Mine : public lgabench::Method { ... };
//   LGABENCH_METHOD("mine", "0.1", "what it does, in a line", Mine, R"({
//     "epochs": {"default": 750, "help": "passes over the demonstrations", "source": "paper, appendix"}})")
//
// An option's default fixes its type: text, number, whole number or boolean. An option may also have
// - "values": all values that it may have;
// - "min", "max": the least and the greatest number;
// - "words": texts that may stand in a number's place;
// - "needs": for one of its "values", the values that other options must have: {"value": {"other option": [its
//   values]}};
// - "framework": true, if it means what CloningMethod's option of that name does. A suite sets these options, and no
//   others, for all methods ("*").
// Any other value is refused before a cell runs.
#pragma once
#include <type_traits>

#include <lgabench/core/method.hpp>
#include <lgabench/core/observation_perturbation.hpp>
#include <lgabench/core/perceiver.hpp>
#include <lgabench/core/physics_world.hpp>
#include <lgabench/plugin/descriptor.hpp>
#include <lgabench/plugin/fingerprint.hpp>

/// Declares a method, once in a library. `Class` derives from lgabench::Method and has a default constructor.
#define LGABENCH_METHOD(id, version, summary, Class, options_json) \
  LGABENCH_METHOD_ASKING("", id, version, summary, Class, options_json)

/// Declares a method that asks more than the language model. `asks` is one of
/// - "specify", "edit": people, as HumanAnswers says. With `lgabench run --humans` the method has a cell for each
///   person; one that edits starts from the recorded answers that people were given to edit.
/// - "accept": people, who are shown objects and say whether they would take them. The truth stands in for them.
/// - "truth": Services::truth, for a diagnosis that is nobody's entry.
/// - "network": its process may open sockets. Its rows are marked, and no leaderboard ranks them.
#define LGABENCH_METHOD_ASKING(asks, id, version, summary, Class, options_json) \
  LGABENCH_PLUGIN_("method", asks, id, version, summary, ::lgabench::Method, Class, options_json)

/// Goes in front of the options of a method whose select() asks select_features()'s questions, whatever its options:
/// "{" LGABENCH_QUESTIONNAIRE R"("epochs": ...})". A run that asks a server then asks these questions beforehand, for
/// all of its cells.
#define LGABENCH_QUESTIONNAIRE R"("questionnaire": true, )"

/// The option of a method whose select() calls select_as_asked(). Methods were published before it: at its default no
/// cell's configuration mentions it.
#define LGABENCH_MEANING_OPTION                                                                                         \
  R"("meaning": {"framework": true, "added": true, "default": "flat", "values": ["flat", "structured", "named"], )"     \
  R"("help": "what the language model is asked: yes or no of each object type and texture; or, in one question, what )" \
  R"(the command means (sets, and which of several objects); named: nothing, the names in the command are taken",)"     \
  R"("source": "flat: paper, section 3.1; the others: ours"})"

/// Declares an engine, once in a library. `Class` derives from lgabench::PhysicsWorld and has a default constructor.
#define LGABENCH_ENGINE(id, version, summary, Class) \
  LGABENCH_PLUGIN_("engine", "", id, version, summary, ::lgabench::PhysicsWorld, Class, "{}")

/// Declares an engine whose bodies have neither mass nor friction. Perturbations of these are refused.
#define LGABENCH_KINEMATIC_ENGINE(id, version, summary, Class) \
  LGABENCH_PLUGIN_("engine", "", id, version, summary, ::lgabench::PhysicsWorld, Class, R"({"kinematic": true})")

/// Declares a perturbation axis that changes what is perceived, once in a library. `Class` derives from
/// lgabench::ObservationPerturbation and has a default constructor. `axis_json` has the members
/// - "levels": what each level is, in a few words, level 1 first;
/// - "changes": which of "rgb", "ids" and "instances" differ in nearly every episode;
/// - "may_change", if there are any: which of them differ in some episodes;
/// - "named": true, if levels are kinds without an order.
#define LGABENCH_PERTURBATION(id, version, summary, Class, axis_json) \
  LGABENCH_PLUGIN_("perturbation", "", id, version, summary, ::lgabench::ObservationPerturbation, Class, axis_json)

/// Declares a perceiver, which reads names from pictures, once in a library. `Class` derives from lgabench::Perceiver
/// and has a default constructor.
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
