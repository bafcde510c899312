"""Checks the architecture on the sources' includes and on the built files' DT_NEEDED entries.

Usage: structure_test.py SOURCE_DIR BUILD_DIR [CLASS...]
"""
import json
import pathlib
import re
import subprocess
import sys
import unittest

SOURCE, BUILD = (pathlib.Path(p) for p in sys.argv[1:3])
INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', re.M)
LIBRARY = ["abstraction", "cell", "core", "drawn", "harness", "host", "job", "learning", "plugin", "record", "statistics", "worker"]
PROGRAMS = ["cli", "document", "http", "leaderboard", "report", "study"]
# Lines that are neither blank nor a comment. Who raises one says in the commit's message what that buys.
BUDGET = {"abstraction": 3950, "cell": 3720, "core": 4815, "drawn": 1470, "harness": 3420, "host": 3705, "job": 370,
          "learning": 4210, "plugin": 1040, "record": 1290, "statistics": 5165, "worker": 400, "cli": 8165,
          "document": 1390, "http": 350, "leaderboard": 5890, "report": 3225, "study": 2390}
ENVIRONMENTS = sorted(file.parent.name for file in (SOURCE / "envs").glob("*/CMakeLists.txt")
                      if "lgabench_environment(" in file.read_text())


def includes(folder):
    """(file, included path) for every include line below the folder."""
    for file in sorted((SOURCE / folder).rglob("*.[ch]pp")):
        for path in INCLUDE.findall(file.read_text()):
            yield file.relative_to(SOURCE), path


def rooms(top):
    return sorted(folder.name for folder in (SOURCE / top / "lgabench").iterdir() if folder.is_dir())


def needed(file):
    out = subprocess.run(["readelf", "-d", file], check=True, capture_output=True, text=True).stdout
    return re.findall(r"\(NEEDED\).*\[(.*)\]", out)


class Links(unittest.TestCase):
    @unittest.skipUnless((SOURCE / ".git").exists(), "an archive has no list of what is committed")
    def test_no_committed_link_leads_out_of_the_tree(self):
        kept = subprocess.run(["git", "-C", SOURCE, "-c", f"safe.directory={SOURCE}", "ls-files", "-s"], check=True,
                              capture_output=True, text=True).stdout.splitlines()
        links = [SOURCE / line.split("\t")[1] for line in kept if line.startswith("120000")]
        self.assertEqual([str(link) for link in links if not link.resolve().is_relative_to(SOURCE)], [])


class Budget(unittest.TestCase):
    def test_a_room_has_at_most_so_many_lines(self):
        self.assertEqual(sorted(BUDGET), sorted(LIBRARY + PROGRAMS))
        for top, names in ("framework", LIBRARY), ("programs", PROGRAMS):
            for room in names:
                lines = [line.strip() for file in (SOURCE / top / "lgabench" / room).rglob("*.[ch]pp") for line in file.read_text().splitlines()]
                code = sum(line != "" and not line.startswith("//") for line in lines)
                self.assertLessEqual(code, BUDGET[room], f"{top}/lgabench/{room}")
                self.assertGreater(code, 0.9 * BUDGET[room], f"{top}/lgabench/{room}: its budget can fall")


class Registered(unittest.TestCase):
    def test_ctest_knows_every_class_of_the_integration_tests(self):
        folder = SOURCE / "tests/integration"
        known = {(file, name) for file, names in re.findall(r"integration_tests\((\S+) ([^)]+)\)", (folder / "CMakeLists.txt").read_text())
                 for name in names.split()}
        there = {(file.name, name) for file in folder.glob("*_test.py")
                 for name, body in re.findall(r"^class (\w+)\(.*?:\n(.*?)(?=^\S|\Z)", file.read_text(), re.S | re.M) if "def test_" in body}
        self.assertEqual(there - known, set())
        self.assertGreater(len(there), 50)


class FirstRun(unittest.TestCase):
    """./quickstart builds the target first_run, and then runs a preset."""

    def ninja(self, tool):
        return subprocess.run(["ninja", "-C", BUILD, "-t", tool, "first_run"], check=True, capture_output=True, text=True).stdout

    def test_the_target_has_the_plugins_of_the_preset(self):
        suite, preset = re.search(r"arguments=\((\w+) --preset (\w+)\)", (SOURCE / "quickstart").read_text()).groups()
        methods = json.loads((SOURCE / f"envs/tabletop/suites/{suite}.json").read_text())["presets"][preset]["methods"]
        self.assertEqual(set(re.findall(r"plugins/(\w+)\.so", self.ninja("query"))), {*methods, "mujoco"})

    def test_the_target_has_every_environment_and_nothing_of_libtorch(self):
        inputs = self.ninja("inputs")
        self.assertEqual(sorted(re.findall(r"liblgabench_env_(\w+)\.so", inputs)), ENVIRONMENTS)
        self.assertNotIn("torch", inputs)


class IncludeGraph(unittest.TestCase):
    def forbid(self, folder, pattern, but=()):
        found = [(str(f), p) for f, p in includes(folder) if re.match(pattern, p) and f.name not in but]
        self.assertEqual(found, [], f"{folder} must not include {pattern}")

    def test_folders_were_found(self):
        for folder in LIBRARY:
            self.assertTrue(list(includes(f"framework/lgabench/{folder}")), folder)
        for folder in PROGRAMS:
            self.assertTrue(list(includes(f"programs/lgabench/{folder}")), folder)
        self.assertEqual(rooms("framework"), LIBRARY)
        self.assertEqual(rooms("programs"), PROGRAMS)

    def test_the_library_knows_no_program(self):
        for folder in ("framework", "envs", "plugins", "baselines", "examples", "python"):
            self.forbid(folder, rf"lgabench/({'|'.join(PROGRAMS)})/")

    def test_a_namespace_is_a_folder(self):
        """Rooms whose values are everybody's are in lgabench itself."""
        found = set()
        for top in ("framework", "programs"):
            for file in sorted((SOURCE / top).rglob("*.[ch]pp")):
                for name in re.findall(r"^namespace lgabench::(\w+)", file.read_text(), re.M):
                    found.add((file.parent.name, name))
        self.assertIn(("statistics", "statistics"), found)
        self.assertEqual({(folder, name) for folder, name in found if folder != name}, set())

    def test_core_knows_nothing_above_it(self):
        self.forbid("framework/lgabench/core", r"lgabench/(?!core/)|torch|ATen|opencv|boost|mujoco")

    def test_abstraction_knows_only_core(self):
        self.forbid("framework/lgabench/abstraction", r"lgabench/(?!core/|abstraction/)|torch|ATen|opencv|mujoco")

    def test_learning_knows_core_and_abstraction(self):
        self.forbid("framework/lgabench/learning", r"lgabench/(?!core/|abstraction/|learning/|plugin/)|mujoco")

    def test_host_knows_core_and_plugin(self):
        self.forbid("framework/lgabench/host", r"lgabench/(?!core/|plugin/|host/)|torch|ATen|opencv|mujoco")

    def test_torch_only_in_learning_sources(self):
        for folder in ("framework/lgabench/core", "framework/lgabench/plugin", "framework/lgabench/abstraction",
                       "framework/lgabench/job", "framework/lgabench/cell", "framework/lgabench/harness", "framework/lgabench/worker", "programs", "envs"):
            self.forbid(folder, r"torch|ATen|c10")
        headers = [(str(f), p) for f, p in includes("framework/lgabench/learning")
                   if f.suffix == ".hpp" and re.match(r"torch/torch\.h", p)]
        torch_learner = "framework/lgabench/learning/torch_learner.hpp"  # for authors of networks, who link LibTorch themselves
        self.assertEqual(headers, [(torch_learner, "torch/torch.h")], "torch.h takes 13 s a file: sources only")
        for top in ("framework", "programs"):
            self.forbid(top, r"lgabench/learning/torch_learner")

    def test_a_reader_of_names_knows_core_and_abstraction(self):
        self.forbid("plugins/readers", r"lgabench/(?!core/|abstraction/)|torch|mujoco")
        for folder in ("job", "cell", "harness", "worker", "host"):
            self.forbid(f"framework/lgabench/{folder}", r"readers/|opencv")
        self.forbid("programs", r"readers/|opencv")

    def test_engines_stay_in_their_plugins(self):
        for folder in ("framework", "programs", "envs/common", *(f"envs/{id}" for id in ENVIRONMENTS), "plugins", "baselines"):
            self.forbid(folder, r"mujoco/|bullet/|btBullet")
        self.forbid("envs/bullet", r"mujoco/")
        self.forbid("envs/mujoco", r"bullet/|btBullet")
        self.forbid("examples", rf"mujoco/|bullet/|btBullet|({'|'.join(ENVIRONMENTS)}|common)/")

    def test_framework_and_programs_name_no_environment(self):
        names = re.compile(rf"\b({'|'.join(ENVIRONMENTS)})\b")
        for top in ("framework", "programs"):
            self.forbid(top, rf"({'|'.join(ENVIRONMENTS)}|common)/")
            self.assertEqual([str(file.relative_to(SOURCE)) for file in sorted((SOURCE / top).rglob("*.cpp"))
                              if names.search(file.read_text())], [])

    def test_the_framework_knows_no_word_of_the_tabletops(self):
        words = re.compile(r"^[^/\n]*\b(Workspace|TwoPoses|angle_rad|pose[01])\b", re.M)
        found = [(str(file.relative_to(SOURCE)), words.findall(file.read_text()))
                 for top in ("framework", "programs") for file in sorted((SOURCE / top).rglob("*.[ch]pp"))]
        self.assertEqual([(file, all_of_it) for file, all_of_it in found if all_of_it], [])

    def test_environments_share_the_common_parts_alone(self):
        self.assertIn("mobile", ENVIRONMENTS)
        self.forbid("envs/common", rf"({'|'.join(ENVIRONMENTS)})/")
        for environment in ENVIRONMENTS:
            others = [other for other in ENVIRONMENTS if other != environment]
            self.forbid(f"envs/{environment}", rf"({'|'.join(others)})/")

    def test_a_run_and_its_cells_share_jobs_alone(self):
        self.forbid("framework/lgabench/job", r"lgabench/(?!core/|plugin/|abstraction/|record/|job/)")
        self.forbid("framework/lgabench/harness", r"lgabench/(cell|statistics|worker)/")
        self.forbid("programs/lgabench/leaderboard", r"lgabench/(cell|report|cli)/")
        self.forbid("framework/lgabench/cell", r"lgabench/(harness|statistics|worker)/")

    def test_records_know_core_and_abstraction(self):
        self.forbid("framework/lgabench/record", r"lgabench/(?!core/|abstraction/|record/)|torch|opencv")

    def test_a_file_of_a_run_is_named_in_its_record_alone(self):
        names = re.compile(r'"(run\.json|cell\.json|selection\.json|training\.jsonl|episodes\.jsonl|timing\.json|status\.json|log\.txt)"')
        found = {str(file.relative_to(SOURCE)): names.findall(file.read_text())
                 for top in ("framework", "programs") for file in sorted((SOURCE / top).rglob("*.[ch]pp")) if file.parent.name != "record"}
        self.assertEqual({file: all_of_it for file, all_of_it in found.items() if all_of_it}, {})

    def test_numbers_know_no_document_and_documents_no_number(self):
        self.forbid("framework/lgabench/statistics", r"lgabench/(?!core/|plugin/|abstraction/|record/|job/|statistics/)|torch|ATen|c10|opencv")
        self.forbid("programs/lgabench/document", r"lgabench/(?!core/|record/layout|statistics/names|document/)|torch|ATen|c10|opencv|boost")
        self.forbid("programs/lgabench/report", r"lgabench/(?!core/|plugin/|abstraction/|record/|job/|statistics/|document/|report/)|torch|ATen|c10|opencv|boost")

    def test_the_study_knows_core_abstraction_records_numbers_and_documents(self):
        self.forbid("programs/lgabench/study", r"lgabench/(?!core/|abstraction/|record/|statistics/|document/|http/|study/)|torch|opencv")

    def test_a_server_knows_core_alone(self):
        self.forbid("programs/lgabench/http", r"lgabench/(?!core/|http/)|torch|opencv")

    def test_httplib_is_where_its_limits_are(self):
        found = {path.parts[2] for path, included in includes("programs") if included == "httplib.h"}
        self.assertEqual(found - {"study"}, {"http"})

    def test_drawn_commands_know_core_and_abstraction(self):
        self.forbid("framework/lgabench/drawn", r"lgabench/(?!core/|abstraction/|drawn/)|torch|opencv")

    def test_words_of_a_record_stand_in_one_file(self):
        """The grammar of answers, whose test scenes, and names of what a report writes."""
        for words, file in ((r'"cassette:"|"openai:?"', "answer_source"), (r'"per_seed"', "test_scenes"),
                            (r'"(?:summary\.(?:json|csv)|report\.(?:md|html)|episodes\.csv)"', "layout")):
            found = {pathlib.Path(*path.relative_to(SOURCE).with_suffix("").parts[2:]) for top in ("framework", "programs")
                     for path in (SOURCE / top).rglob("*.[ch]pp") if re.search(words, path.read_text())}
            self.assertEqual(found, {pathlib.Path("record", file)}, words)


class Needed(unittest.TestCase):
    def forbid(self, file, pattern):
        self.assertEqual([n for n in needed(BUILD / file) if re.search(pattern, n)], [], f"{file} must not need {pattern}")

    def test_programs_do_not_link_torch(self):
        for program in ("bin/lgabench", "bin/lgabench-worker", "bin/lgabench-method"):
            self.forbid(program, r"torch|c10|opencv_videoio|mujoco|Bullet|liblgabench_learning|liblgabench_env")

    def test_command_line_loads_no_engine_and_no_pictures(self):
        self.forbid("bin/lgabench", rf"{'|'.join(ENVIRONMENTS)}|embree|opencv|hdf5")

    def test_names_are_read_without_what_grew_their_reader(self):
        self.forbid("lib/liblgabench_seeing.so", r"opencv_ml")

    def test_core_is_light(self):
        self.forbid("lib/liblgabench_core.so", r"torch|c10|opencv|embree|hdf5")

    def test_plugins_take_the_framework_as_a_shared_library(self):
        plugins = sorted((BUILD / "lib/lgabench/plugins").glob("*.so"))
        self.assertGreaterEqual(len(plugins), 3)
        for plugin in plugins:
            # gcbc_dart calls nothing of the core itself: the linker then keeps the learning library alone, which needs it.
            self.assertTrue({"liblgabench_core.so", "liblgabench_learning.so"} & set(needed(plugin)), plugin.name)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
