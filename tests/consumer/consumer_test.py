"""The plugin author's road: an installed lgabench in a clean prefix, plugins built from it alone, checked and run.

LGABENCH_BUILD and LGABENCH_SOURCE name the build tree and the sources; what is built here sees neither, where the system
lets a process hide them. LGABENCH_FULL=1 builds every example, and with Clang too. By hand: consumer_test.py Examples
"""
import json
import os
import pathlib
import re
import runpy
import shutil
import socket
import subprocess
import tempfile
import unittest
import unittest.mock

BUILD, SOURCE = (pathlib.Path(os.environ[name]) for name in ("LGABENCH_BUILD", "LGABENCH_SOURCE"))
FULL = os.environ.get("LGABENCH_FULL") == "1"
COMPILERS = ["g++"] + (["clang++"] if FULL and shutil.which("clang++") else [])
# An empty file system over the sources, for one command; it needs a user namespace or root.
HIDE = ["unshare", "--user", "--map-root-user", "--mount", "sh", "-c", 'mount -t tmpfs none "$0" && exec "$@"', SOURCE]
SMALL_MOBILE = ["run", "mobile", "--scenarios", "bring_fruit", "--engines", "kinematic", "--demos", "1", "--seeds", "0",
                "--episodes", "3", "--no-reference"]
SMALL = ["run", "q1", "--scenarios", "heart", "--demos", "10", "--seeds", "0", "--episodes", "3", "--no-reference"]


def hides():
    if not BUILD.is_relative_to(SOURCE):
        return False
    for hide in (HIDE, ["unshare", "--mount", *HIDE[4:]]):
        if subprocess.run([*hide, "true"], capture_output=True).returncode == 0:
            HIDE[:] = hide
            return True
    return False


class Consumer(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.dir = pathlib.Path(tempfile.mkdtemp(prefix="lgabench-consumer-"))
        cls.addClassCleanup(shutil.rmtree, cls.dir, ignore_errors=True)
        # Installed in one place, used from another.
        subprocess.run(["cmake", "--install", BUILD, "--prefix", cls.dir / "installed"], check=True, capture_output=True)
        cls.prefix = (cls.dir / "installed").rename(cls.dir / "prefix")
        cls.hide = HIDE if hides() else []
        if not cls.hide:
            print("the sources cannot be hidden here: only looked for in what was built")

    def call(self, *words, expect=0, cwd=None, typed=None, **environment):
        done = subprocess.run([*self.hide, *map(str, words)], capture_output=True, text=True, cwd=cwd or self.dir,
                              input=typed, timeout=900,
                              env=dict(os.environ, LGABENCH_CACHE=str(self.dir / "cache"), **environment))
        self.assertEqual(done.returncode, expect, done.stdout[-3000:] + done.stderr[-3000:])
        return done

    def lgabench(self, *words, **more):
        return self.call(self.prefix / "bin/lgabench", *words, **more)

    def assert_no_path_of_the_sources(self, directory):
        found = [str(file) for file in directory.rglob("*")
                 if file.is_file() and any(str(path).encode() in file.read_bytes() for path in (SOURCE, BUILD))]
        self.assertEqual(found, [])

    def check(self, plugin, *options, **environment):
        report = json.loads(self.lgabench("check-plugin", plugin, "--json", *options, **environment).stdout)
        self.assertTrue(report["good"])
        return {finding["check"]: finding["state"] for finding in report["findings"]}

    def runs(self, method, directory, *options, **environment):
        """In both environments."""
        for small, scenario, arms in (SMALL, "heart", 1), (SMALL_MOBILE, "bring_fruit", 5):
            out = self.dir / f"run-{method}"
            self.lgabench(*small, "--methods", method, "--plugin-path", directory, "--out", out, *options, **environment)
            rows = json.loads((out / "summary.json").read_text())["rows"]
            shutil.rmtree(out)
            self.assertEqual([(row["method"].split("+")[0], row["episodes"], row["n_error"], row["failures"].get("method_error", 0))
                              for row in rows if row["scenario"] == scenario], [(method, 3, 0, 0)] * arms)


class Package(Consumer):
    def test_holds_no_path_of_where_it_was_built(self):
        self.assert_no_path_of_the_sources(self.prefix)

    def test_holds_a_manual_and_completions(self):
        for file in "man/man1/lgabench.1", "bash-completion/completions/lgabench", "zsh/site-functions/_lgabench", \
                "fish/vendor_completions.d/lgabench.fish":
            text = (self.prefix / "share" / file).read_text().replace("\\-", "-")
            for word in "check-plugin", "-l demos" if file.endswith(".fish") else "--demos":
                self.assertIn(word, text, file)

    def test_holds_the_pages_and_the_examples(self):
        pages = self.prefix / "share/doc/lgabench"
        for file in "README.md", "docs/tutorial.md", "docs/pictures/scene.png", "examples/select_only/select_only.cpp":
            self.assertTrue((pages / file).is_file(), file)
        self.assertEqual([*self.prefix.rglob("__pycache__")], [])

    def test_works_where_it_was_moved_to(self):
        self.assertIn("mujoco", self.lgabench("list").stdout)
        self.runs("lga", self.prefix, "--set", "lga.epochs=2")

    def test_a_command_of_ones_own_is_read_by_policies(self):
        """README, "Your own task", with nothing but the installation."""
        self.lgabench("new-scenario", "round", "--command", "Bring me something round.", "--types", "round,ring")
        self.assertRegex(self.lgabench("check-scenario", "round.json", "--scenes", "2").stdout, "ok +sentences")
        out = self.dir / "round"
        self.lgabench("run", "q1", "--scenarios", "round", "--scenario-path", ".", "--answers", "none", "--methods",
                      "human,gcbc_seg", "--demos", "2", "--seeds", "0", "--episodes", "2", "--set", "*.epochs=2", "--out", out)
        self.assertEqual({row["n_error"] for row in json.loads((out / "summary.json").read_text())["rows"]}, {0})

    def test_every_public_header_compiles(self):
        headers = sorted(path.relative_to(self.prefix / "include") for path in self.prefix.glob("include/**/*.hpp"))
        headers.remove(pathlib.Path("lgabench/learning/torch_learner.hpp"))  # needs LibTorch; --full builds own_network with it
        of_environments = re.compile("environment|core/(sampling|scenario|scene|view)[.]hpp")
        self.assertLessEqual(len([header for header in headers if not of_environments.search(str(header))]), 31,
                             "what the author of another plugin has to know")
        self.assertIn("method.hpp", [header.name for header in headers])
        self.assertEqual([header for header in headers if "Private to" in (self.prefix / "include" / header).read_text()], [])
        alone = [[header] for header in headers]
        for standard, parts in [("-std=c++17", alone if FULL else [headers[::-1]]), ("-std=c++20", [headers])]:
            for part in parts:
                source = self.dir / "header.cpp"
                source.write_text("".join(f"#include <{header}>\n" for header in part))
                self.call("g++", standard, "-Wall", "-Wextra", "-Werror", "-fsyntax-only", f"-I{self.prefix}/include", source)


class NewPlugin(Consumer):
    def build(self, *arguments):
        name = arguments[0]
        self.lgabench("new-plugin", *arguments)
        self.call("cmake", "--workflow", "--preset", "release", cwd=self.dir / name, CXXFLAGS="-Werror")
        self.assert_no_path_of_the_sources(self.dir / name)
        return self.dir / name / "build" / f"{name}.so"

    def test_a_method(self):
        plugin = self.build("my_method")
        self.assertIn("any_texture", self.lgabench("info", "my_method", "--plugin-path", plugin.parent).stdout)
        checks = self.check(plugin, "--set", "epochs=5")
        self.assertEqual(checks.pop("bounds of actions"), "note", "after five epochs")
        self.assertEqual(set(checks.values()), {"ok"})
        self.runs("my_method", plugin.parent, "--set", "my_method.epochs=2")
        said = self.lgabench("new-plugin", "my_method", expect=2).stderr
        self.assertIn("exists already; nothing was written", said)

    @unittest.skipUnless(shutil.which("bwrap"), "bubblewrap is not installed")
    def test_a_strangers_source_is_built_confined(self):
        """By results/accept: no file of ours, variable or port is there, and only the plugin is taken."""
        here = self.dir / "request"
        here.mkdir()
        self.lgabench("new-plugin", "stranger")
        (self.dir / "stranger").rename(here / "source")
        (self.dir / "key").write_text("our key")
        with socket.create_server(("127.0.0.1", 0)) as server, unittest.mock.patch.dict(os.environ, KEY="our key"):
            with open(here / "source/CMakeLists.txt", "a") as file:
                file.write(f"""execute_process(COMMAND bash -c "cat {self.dir}/key; echo $KEY; ls /home /root {SOURCE}; touch /source/x;
                    (echo > /dev/tcp/127.0.0.1/{server.getsockname()[1]}) && echo connected" OUTPUT_FILE /built/found)
                    execute_process(COMMAND ln -s /etc/passwd /built/taken.so)\n""")
            runpy.run_path(str(SOURCE / "results/accept"))["build_confined"](here / "source", self.prefix, here / "built", here / "plugin")
        self.assertEqual((here / "built/found").read_text(), "\n")
        self.assertEqual([file.name for file in (here / "plugin").iterdir()], ["stranger.so"])
        self.assertIn("any_texture", self.lgabench("info", "stranger", "--plugin-path", here / "plugin").stdout)

    @unittest.skipUnless(shutil.which("gdb"), "gdb is not installed")
    def test_stepping_through_a_method(self):
        self.lgabench("new-plugin", "stepped")
        self.call("cmake", "--workflow", "--preset", "debug", cwd=self.dir / "stepped")
        run = [*SMALL, "--methods", "stepped", "--plugin-path", self.dir / "stepped/build-debug", "--debug"]
        key = self.lgabench(*run, "list", expect=2).stderr.splitlines()[-1].split()[0]
        typed = "break Stepped::select\nrun\nprint command.utterance\nkill\nquit\n"
        said = self.lgabench(*run, key, typed=typed, expect=3)
        if "ptrace" in said.stdout + said.stderr:
            self.skipTest("no process may be traced here")
        self.assertRegex(said.stdout, r"(?s)Breakpoint 1, .*stepped.cpp:\d+.*\"Bring me the heart.\"")

    def test_opencv_beside(self):
        """Debian's parts of OpenCV come without its CMake package."""
        self.lgabench("new-plugin", "with_opencv", "--with", "opencv")
        with open(self.dir / "with_opencv/with_opencv.cpp", "a") as source:
            source.write("#include <opencv2/imgproc.hpp>\ndouble area() { return cv::contourArea(cv::Mat(4, 1, CV_32SC2, cv::Scalar(0))); }\n")
        self.call("cmake", "--workflow", "--preset", "release", cwd=self.dir / "with_opencv")
        self.assertIn("libopencv_imgproc", self.call("readelf", "-d", self.dir / "with_opencv/build/with_opencv.so").stdout)

    def test_a_network_of_ones_own(self):
        if FULL:
            checks = self.check(self.build("my_network", "--with", "torch"), "--set", "epochs=50")  # after 5 its actions leave their bounds
            self.assertEqual(set(checks.values()), {"ok"})
        else:
            self.lgabench("new-plugin", "my_network", "--with", "torch")
        source, build = ((self.dir / "my_network" / name).read_text() for name in ("my_network.cpp", "CMakeLists.txt"))
        self.assertIn("target_precompile_headers(${PROJECT_NAME} PRIVATE <lgabench/plugin/plugin.hpp> <lgabench/learning/torch_learner.hpp>)", build)
        self.assertIn("class MyNetwork : public CloningMethod", source)
        self.assertNotIn("own_network", source.lower())
        said = self.lgabench("new-plugin", "wrong", "--with", "torch", "--language", "python", expect=2).stderr
        self.assertIn("--with torch: expected a method in C++", said)

    def test_an_engine(self):
        plugin = self.build("my_engine", "--kind", "engine")
        checks = self.check(plugin)
        self.assertEqual(set(checks.values()), {"ok"})
        self.assertIn("oracle, sweep", checks)
        self.call(self.prefix / "bin/lgabench-engine-conformance", plugin, "--gtest_filter=World.*:Types/*")

    def test_a_perturbation(self):
        plugin = self.build("my_axis", "--kind", "perturbation")
        self.assertEqual(set(self.check(plugin).values()), {"ok"})
        self.lgabench("run", "my_axis_suite.json", "--plugin-path", "build", "--episodes", "3", "--set", "*.epochs=2", "--out", "run",
                      cwd=self.dir / "my_axis")
        curves = json.loads((self.dir / "my_axis/run/summary.json").read_text())["perturbations"]
        self.assertEqual({(curve["axis"], len(curve["levels"])) for curve in curves}, {("my_axis", 4)})

    def test_a_perceiver(self):
        plugin = self.build("my_eyes", "--kind", "perceiver")
        others = {check: state for check, state in self.check(plugin).items() if state != "ok"}
        self.assertEqual(others, {f"names, {environment}": "note" for environment in ("tabletop", "mobile")}, "it gives all objects one name")
        self.lgabench("run", "pictures", "--preset", "smoke", "--names", "simulator,my_eyes", "--plugin-path", "build", "--scenarios",
                      "heart", "--methods", "human", "--episodes", "2", "--set", "*.policy=centroid", "--out", "run", cwd=self.dir / "my_eyes")
        rows = json.loads((self.dir / "my_eyes/run/summary.json").read_text())["rows"]
        self.assertIn("human+names=my_eyes", {row["method"] for row in rows})
        self.assertEqual({row["n_error"] for row in rows}, {0})

    def test_an_environment(self):
        plugin = self.build("my_world", "--kind", "environment")
        found = {"LGABENCH_PLUGIN_PATH": str(plugin.parent), "LGABENCH_SCENARIO_PATH": str(self.dir / "my_world")}
        checks = self.check(plugin, **found)
        self.assertEqual(checks.pop("heat maps"), "note", "its actions have no place in the picture")
        self.assertEqual(set(checks.values()), {"ok"})
        self.assertIn("scenes, reach_blind", checks)
        out = self.dir / "my_world/run"
        self.lgabench("run", "my_world_suite.json", "--answers", "none", "--demos", "2", "--episodes", "3", "--set", "*.epochs=2",
                      "--out", out, cwd=self.dir / "my_world", **found)
        oracle, = (row for row in json.loads((out / "summary.json").read_text())["rows"]
                   if (row["method"], row["scenario"]) == ("oracle", "(mean)"))
        self.assertEqual((oracle["success"], oracle["n_error"]), (1, 0))
        self.assertIn("identical", self.lgabench("verify", out, **found).stdout)

    def test_bad_names_are_refused(self):
        for name in ("My", "../outside", "1st", "a-b"):
            self.assertIn("expected at most 63 lower-case letters", self.lgabench("new-plugin", name, expect=2).stderr)
            self.assertFalse((self.dir / name).exists())


class Examples(Consumer):
    def test_each(self):
        shutil.copytree(SOURCE / "examples", self.dir / "examples")
        for compiler in COMPILERS:
            # The sources of the others are compiled and tested in the build tree.
            for name in ("select_only", "nearest_neighbour") + (("noisy_copies", "tinted_light", "own_network") if FULL else ()):
                with self.subTest(name, compiler=compiler):
                    build = self.dir / f"build-{compiler}-{name}"
                    self.call("cmake", "-S", self.dir / "examples" / name, "-B", build, "-G", "Ninja",
                              f"-DCMAKE_PREFIX_PATH={self.prefix}", f"-DCMAKE_CXX_COMPILER={compiler}",
                              "-DLGABENCH_WERROR=ON")
                    self.call("cmake", "--build", build)
                    self.assert_no_path_of_the_sources(build)
                    getattr(self, name)(build)

    def select_only(self, build):
        self.assertEqual(self.check(build / "select_only.so", "--set", "epochs=5")["sweep"], "note")
        self.runs("select_only", build, "--set", "select_only.epochs=2")

    def nearest_neighbour(self, build):
        needed = subprocess.run(["readelf", "-d", build / "nearest_neighbour.so"], capture_output=True, text=True).stdout
        self.assertNotRegex(needed, "torch|learning")
        self.assertEqual(self.check(build / "nearest_neighbour.so")["cost"], "ok")
        self.runs("nearest_neighbour", build)

    def noisy_copies(self, build):
        self.assertEqual(self.check(build / "noisy_copies.so", "--set", "epochs=5")["sweep"], "ok")
        self.runs("noisy_copies", build, "--set", "noisy_copies.epochs=2")

    def tinted_light(self, build):
        self.assertEqual(set(self.check(build / "tinted_light.so").values()), {"ok"})

    def own_network(self, build):
        self.assertEqual(set(self.check(build / "own_network.so", "--set", "epochs=20").values()), {"ok"})
        self.runs("own_network", build, "--set", "own_network.epochs=5")


if __name__ == "__main__":
    unittest.main()
