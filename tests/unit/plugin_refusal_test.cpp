// Plugins that are wrong in one way each: refused with the cause and both sides named, and the others still there.
#include <fmt/format.h>
#include <sys/stat.h>

#include <lgabench/core/version.hpp>
#include <lgabench/plugin/loader.hpp>

#include "plugin_fixtures.hpp"

namespace lgabench {
namespace {

struct Case {
  const char* name;
  std::vector<std::string> named;
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }
const auto name_of = [](const auto& info) { return std::string(info.param.name); };

const std::string ours = fmt::format("(this program: {})", LGABENCH_PLUGIN_ABI);

// What a plugin's author reads: the page that leads to this version's series, or to the one that comes.
const std::string page_of_this_version = "-to-0.5.md)";

class RefusedByBytes : public testing::TestWithParam<Case> {};

TEST_P(RefusedByBytes, NamesTheCauseAndKeepsTheOthers) {
  const std::string name = std::string("refused/") + GetParam().name;
  if (!fs::exists(fixture(name))) GTEST_SKIP() << "not built: Clang with libc++ is not installed here";
  const Directory directory;
  const fs::path file = directory.copy(name);
  directory.copy("good/fixture_constant");
  const Catalogue catalogue = scan_plugins({directory.path});

  ASSERT_EQ(catalogue.plugins.size(), 1u);
  EXPECT_EQ(catalogue.plugins[0].id, "fixture_constant");
  EXPECT_NE(load_method(catalogue.find("method", "fixture_constant")), nullptr);
  ASSERT_EQ(catalogue.refused.size(), 1u);
  EXPECT_EQ(catalogue.refused[0].file, file);
  for (const auto& part : GetParam().named) EXPECT_SAYS(catalogue.refused[0].reason, part);

  const std::string alone = message_of<PluginError>([&] { read_plugin(file); });
  EXPECT_EQ(alone, file.string() + ": " + catalogue.refused[0].reason);
  const std::string asked = message_of<PluginError>([&] { catalogue.find("method", GetParam().name); });
  EXPECT_SAYS(asked, "expected one of: fixture_constant; " + file.string() + " was refused: ");
  EXPECT_SAYS(asked, catalogue.refused[0].reason);
}

INSTANTIATE_TEST_SUITE_P(
    Plugin, RefusedByBytes,
    testing::Values(
        Case{"wrong_sdk", {"SDK \"0.0.9\"", "(this program: \"" LGABENCH_VERSION "\")", page_of_this_version}},
        Case{"wrong_torch", {"LibTorch \"9.9.9\"", "(this program: \""}},
        Case{"wrong_strings", {"string ABI \"old\"", "(this program: \"cxx11\")"}},
        Case{"wrong_iterators", {"iterators \"debug\"", "(this program: \"plain\")"}},
        Case{"wrong_library", {"standard library \"libc++ ", "(this program: \"libstdc++ "}},
        Case{"wrong_sanitizer", {"sanitizer \"", "(this program: \""}},
        Case{"wrong_kind",
             {"kind \"sampler\"", "expected one of: method, engine, perturbation, perceiver, environment"}},
        Case{"short_descriptor", {"descriptor of 104 bytes", "(this program: 4664)"}},
        Case{"newer_interface", {"plugin interface 1000", ours}},
        Case{"older_interface", {"plugin interface 3", ours + ": build it with this lgabench's package"}},
        Case{"two_descriptors", {"2 lgabench descriptors, expected one"}},
        Case{"no_descriptor", {"no lgabench descriptor"}},
        Case{"bad_options", {"options: /epochs: expected a member \"default\""}},
        Case{"bad_asks",
             {"asks \"everybody\"", "expected \"specify\", \"edit\", \"accept\", \"truth\" or \"network\""}},
        Case{"bad_needs", {"options: /way/needs/plain/see/0: expected a value of option see, got \"rgb\""}},
        Case{"bad_axis", {"axis: /changes/0: expected rgb, ids or instances"}},
        Case{"bad_id", {"id \"../bad id\"", "expected lower-case letters"}}),
    name_of);

class RefusedWhenOpened : public testing::TestWithParam<Case> {};

TEST_P(RefusedWhenOpened, IsListedAndThenRefusedByName) {
  const Directory directory;
  const fs::path file = directory.copy(std::string("refused/") + GetParam().name);
  directory.copy("good/fixture_constant");
  const Catalogue catalogue = scan_plugins({directory.path});
  EXPECT_TRUE(catalogue.refused.empty());
  const PluginInfo& plugin = catalogue.find("method", GetParam().name);

  const std::string message = message_of<PluginError>([&] { load_method(plugin); });
  EXPECT_SAYS(message, fmt::format("plugin {} ({}): ", GetParam().name, file.string()));
  for (const auto& part : GetParam().named) EXPECT_SAYS(message, part);
  EXPECT_SILENT(message, "\n");
  EXPECT_NE(load_method(catalogue.find("method", "fixture_constant")), nullptr);
}

INSTANTIATE_TEST_SUITE_P(Plugin, RefusedWhenOpened,
                         testing::Values(Case{"missing_symbol", {"undefined symbol: lgabench::not_in_this_sdk(int)"}},
                                         Case{"throwing_factory", {"its factory failed: no licence for this method"}},
                                         Case{"odd_factory", {"its factory failed: threw int"}},
                                         Case{"null_factory", {"its factory returned nothing"}},
                                         Case{"no_entry", {"exports no lga_plugin_v1"}},
                                         Case{"changing_descriptor", {"differs from the one in the file"}}),
                         name_of);

TEST(Refusal, ConstructorThatAbortsRunsOnlyWhenOpened) {
  const Directory directory;
  directory.copy("refused/aborting_constructor");
  const Catalogue catalogue = scan_plugins({directory.path});
  const PluginInfo& plugin = catalogue.find("method", "aborting_constructor");
  EXPECT_EQ(plugin.summary, "aborts when it is opened");
  EXPECT_EXIT(
      load_method(plugin), [](int status) { return status != 0; }, "");
}

TEST(Refusal, LaterOfTwoWithOneIdNamesBothFiles) {
  const Directory first, second;
  const fs::path kept = first.copy("good/fixture_constant"), later = second.copy("refused/duplicate");
  const Catalogue catalogue = scan_plugins({first.path, second.path});
  EXPECT_EQ(catalogue.find("method", "fixture_constant").version, "0.1");
  ASSERT_EQ(catalogue.refused.size(), 1u);
  EXPECT_EQ(catalogue.refused[0].file, later);
  EXPECT_SAYS(catalogue.refused[0].reason, kept.string());
}

TEST(Refusal, DirectoryNamedTwiceIsReadOnce) {
  const Directory directory;
  directory.copy("good/fixture_constant");
  const Catalogue catalogue = scan_plugins({directory.path, directory.path / "." / ""});
  EXPECT_EQ(catalogue.plugins.size(), 1u);
  EXPECT_TRUE(catalogue.refused.empty());
}

TEST(Refusal, NotALibrary) {
  const Directory directory;
  directory.copy("good/fixture_constant");
  directory.write("a_text.so", std::string(200, 'x'));
  directory.write("an_empty_one.so", "");
  directory.write("ignored.txt", "not looked at");
  fs::create_directory(directory.path / "directory.so");
  ASSERT_EQ(::mkfifo((directory.path / "fifo.so").c_str(), 0600), 0);
  fs::create_symlink("nowhere", directory.path / "link.so");
  const Catalogue catalogue = scan_plugins({directory.path});
  EXPECT_EQ(catalogue.plugins.size(), 1u);
  ASSERT_EQ(catalogue.refused.size(), 5u);
  const char* reasons[] = {"not a shared library: no ELF header", "not a shared library: the file is empty",
                           "not a regular file", "not a regular file", "not a regular file"};
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(catalogue.refused[i].reason, reasons[i]);
}

TEST(Refusal, DirectoryThatIsNotThere) {
  const Directory directory;
  directory.copy("good/fixture_constant");
  const Catalogue catalogue = scan_plugins({directory.path / "missing", directory.path});
  EXPECT_EQ(catalogue.plugins.size(), 1u);
  ASSERT_EQ(catalogue.refused.size(), 1u);
  EXPECT_SAYS(catalogue.refused[0].reason, "No such file or directory");
}

TEST(Refusal, FileThatChangedSinceItWasRead) {
  const Directory directory;
  const fs::path file = directory.copy("good/fixture_constant");
  const PluginInfo plugin = read_plugin(file);
  fs::remove(file);
  fs::copy_file(fixture("refused/duplicate"), file);
  EXPECT_SAYS(message_of<PluginError>([&] { load_method(plugin); }), "changed since it was read");
  fs::remove(file);
  EXPECT_SAYS(message_of<PluginError>([&] { load_method(plugin); }), "cannot be read");
}

TEST(Refusal, WrongKind) {
  const PluginInfo plugin = read_plugin(fixture("good/fixture_constant"));
  EXPECT_SAYS(message_of<PluginError>([&] { load_engine(plugin); }), "kind method, expected engine");
}

}  // namespace
}  // namespace lgabench
