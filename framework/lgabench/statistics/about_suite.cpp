#include <lgabench/statistics/about_suite.hpp>

#include <algorithm>
#include <cctype>

#include <lgabench/plugin/loader.hpp>

namespace lgabench::statistics {

std::string AboutSuite::arm(const std::string& name) const {
  if (const auto found = arms.find(name); found != arms.end()) return found->second;
  std::string text, longest;
  for (const auto& [arm, words] : arms)
    if (name.rfind(arm + "_", 0) == 0 && arm.size() > longest.size()) longest = arm, text = words;
  return text;
}

std::string AboutSuite::arm_title(const std::string& name) const {
  if (const auto found = arm_titles.find(name); found != arm_titles.end()) return found->second;
  std::string text = name, longest;
  for (const auto& [arm, ignored] : arms) {
    if (name.rfind(arm + "_", 0) != 0 || arm.size() <= longest.size()) continue;
    longest = arm;
    text = arm_title(arm) + ", " + arm_title(name.substr(arm.size() + 1));
  }
  return text;
}

std::string AboutSuite::row(const std::string& method) const {
  const auto found = rows.find(method);
  return found == rows.end() ? "" : found->second;
}

fs::path installed_suite(const std::string& id) {
  const bool is_name = !id.empty() && std::all_of(id.begin(), id.end(), [](unsigned char c) {
    return std::isalnum(c) || c == '_' || c == '-';
  });
  const fs::path file = data_directory() / "suites" / (id + ".json");
  return is_name && fs::exists(file) ? file : fs::path();
}

AboutSuite about_suite(const std::string& id, const Json& of_run) {
  AboutSuite about;
  about.title = id;
  const fs::path file = installed_suite(id);
  Json json = file.empty() ? Json::object() : read_json(file);
  if (!of_run.is_null()) json["about"] = of_run;
  const JsonReader suite(json, of_run.is_null() ? file.string() : "the suite of the run");
  if (suite.has("options")) about.options = suite.at("options").json();
  if (!suite.has("about")) return about;
  const JsonReader words = suite.at("about");
  if (words.has("title")) about.title = words.at("title").string();
  about.question = words.at("question").string();
  if (words.has("main_arm")) about.main_arm = words.at("main_arm").string();
  if (words.has("main_demonstrations"))
    about.main_demonstrations = static_cast<int>(words.at("main_demonstrations").integer(1, 1'000'000));
  for (const auto& [name, all] : {std::pair("arms", &about.arms),
                                  {"arm_titles", &about.arm_titles},
                                  {"rows", &about.rows},
                                  {"presets", &about.presets}})
    if (words.has(name))
      for (const auto& one : words.at(name).json().items()) (*all)[one.key()] = words.at(name).at(one.key()).string();
  return about;
}

}  // namespace lgabench::statistics
