"""lgabench check-plugin: every way to be unsound is found and named, and nothing else is.

LGABENCH_BUILD names the build tree. One CTest entry a class; by hand: python3 check_test.py CheckPlugin
"""
import json
import os
import subprocess
import unittest

from case import BUILD, Case, FIXTURES, command_line

PYTHON = "/usr/bin/python3"  # which has NumPy
UNSOUND, FAULTY = (FIXTURES / "faulty" / f"fixture_{name}.so" for name in ("unsound", "faulty"))

SELECTS = """
from lgabench_method import select_features


class Selects:
    options = {"known": {"default": 1, "help": "a number", "source": "test"}}

    def select(self, command, space, services):
        return select_features(command, space, services.lm)


class Undeclared(Selects):
    options = {"known": {"default": 1, "help": "a number", "source": "test"}}

    def select(self, command, space, services):
        return services.options["hiden"]


class Asks(Selects):
    asks = "accept"
    options = {"questions": {"default": 5, "min": 0, "help": "to each person", "source": "test"}}

    def revise(self, command, selected, demonstrations, services):
        things = [one["id"] for one in services.human.scene(command, 0) if one["object_type"] != "pallet"]
        services.human.takes(command, 0, things[0])
        services.human.which(command, 1)
        services.human.accepts(command, "heart", "red")
        return selected

    def learn(self, demonstrations, services):
        action = demonstrations[0].steps[0].label
        return type("Still", (), {"act": lambda self, observation, instruction: action})()


class Silent(Asks):
    asks = "accept"

    def revise(self, command, selected, demonstrations, services):
        return selected


class Unasked(Silent):
    asks = "accept"
    options = {"questions": {"default": 0, "min": 0, "help": "to each person", "source": "test"}}

    def revise(self, command, selected, demonstrations, services):
        return selected
"""


# Says at once that nothing is left to do; in one of two episodes; does not know that labels may be none.
STOPS = """
import numpy

from lgabench_method import Needs, Selection


class Stops:
    def needs(self, options):
        return Needs(targets="truth")

    def select(self, command, space, services):
        return Selection()

    def learn(self, demonstrations, services):
        assert services.layout["may_stop"] and any(len(one.steps[0].label) == 0 for one in demonstrations)
        return Acts([step.label for one in demonstrations for step in one.steps if len(step.label)][0])


class Counts(Stops):
    def learn(self, demonstrations, services):
        policy = super().learn(demonstrations, services)
        policy.counts = True
        return policy


class Blind(Stops):
    def learn(self, demonstrations, services):
        numpy.stack([step.label for one in demonstrations for step in one.steps])


class Acts:
    counts, episodes = False, 0

    def __init__(self, action):
        self.action = action

    def reset(self):
        self.episodes += 1

    def act(self, observation, instruction):
        return self.action if self.counts and self.episodes % 2 else []
"""


class CheckPlugin(Case):
    def check(self, file, *settings, expect=1):
        words = [word for setting in settings for word in ("--set", setting)]
        done = self.call("check-plugin", file, "--json", "--python", PYTHON, *words, expect=expect)
        report = json.loads(done.stdout)
        self.assertEqual(report["good"], expect == 0)
        self.assert_as_schema("check_plugin", report)
        return {finding["check"]: finding for finding in report["findings"] if finding["state"] == "problem"}

    def test_finds_what_is_unsound_and_nothing_else(self):
        found = {}
        for how, checks in {
            "sound": set(),
            "clock": {"same scenes", "same actions", "two processes"},
            "remembers": {"same scenes"},
            "process": {"processes"},
            "undeclared": {"learn"},
            "address": {"two processes"},
            "leak": {"memory of act"},
            "outside": {"Selection"},
            "thread": {"threads"},
            "descriptor": {"descriptors"},
            "unseen": {"act on an unseen command"},
            "forgets": {"saved policy"},
            "rounding": {"rounding mode"},
            "far": set(),
            "nan_loss": {"learn"},
        }.items():
            with self.subTest(how):
                problems = found[how] = self.check(UNSOUND, f"how={how}", expect=1 if checks else 0)
                if how == "address":  # two objects of one process need not lie at two addresses
                    problems.pop("same actions", None)
                self.assertEqual(set(problems), checks)
                self.assertTrue(all(problem["fix"] for problem in problems.values()))
        self.assertRegex(found["process"]["processes"]["detail"], r"left behind: \d+ lgabench-method")
        self.assertRegex(found["undeclared"]["learn"]["detail"], "key 'hiden' not found; options declared: how$")

    def test_says_what_was_found_in_words_that_help(self):
        (self.dir / "m.py").write_text(SELECTS)
        undeclared = self.check("m.py:Undeclared")["select"]["detail"]
        self.assertRegex(undeclared, r"KeyError: 'hiden' \(m.py:\d+\); options declared: known$")
        problem = self.check(FIXTURES / "refused/bad_options.so")["descriptor"]
        self.assertIn('options: /epochs: expected a member "default"', problem["detail"])
        self.assertIn("correct the options", problem["fix"])

    def test_a_method_that_selects_alone_is_good(self):
        (self.dir / "m.py").write_text(SELECTS)
        report = json.loads(self.call("check-plugin", "m.py:Selects", "--json", "--python", PYTHON).stdout)
        found = {finding["check"]: finding["detail"] for finding in report["findings"]}
        self.assertEqual(found["learn"], "none: the method only selects, as --methods selected_by:m asks")

    def test_people_are_asked_in_scenes_as_often_as_the_option_says(self):
        (self.dir / "mine.py").write_text(SELECTS)
        for method, said in (("Asks", r"asked, at the price of \d*[05] objects shown"), ("Silent", "services.human was not asked")):
            report = json.loads(self.call("check-plugin", f"mine.py:{method}", "--json", "--python", PYTHON).stdout)
            self.assertRegex({one["check"]: one["detail"] for one in report["findings"]}["person"], f"^{said}$")
            self.assertEqual([one for one in report["findings"] if one["state"] == "problem"], [])
        words = ("check-plugin", "mine.py:Unasked", "--json", "--python", PYTHON)
        person, = (one for one in json.loads(self.call(*words).stdout)["findings"] if one["check"] == "person")
        self.assertEqual((person["state"], person["detail"]), ("note", "services.human was not asked: questions=0"))
        problems = self.check("mine.py:Asks", "questions=4")
        self.assertIn("expected at most 4 questions to a person", json.dumps(problems))

    def test_tells_what_it_found_before_it_ends_and_where_it_stays(self):
        process = subprocess.Popen(command_line("check-plugin", FAULTY, "--set", "where=act", "--set", "how=sleep", "--timeout", "23"),
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=self.environment, cwd=self.dir)
        first = process.stderr.readline()  # while the plugin sleeps
        self.assertIsNone(process.poll())
        out, said = process.communicate()
        self.assertRegex(first, r"^still in act after 2\d s; it is stopped after 23 s \(--timeout\)$")
        self.assertRegex(out, r"(?s)^fixture_faulty 0.1, a method\n  ok +descriptor .*  ok +Selection .*  problem +process +stopped after 23 s in phase act: plugin fixture_faulty \(method\) did not answer\n")
        self.assertEqual(out.count("\n  ok       Selection "), 1, "each line once")
        self.assertNotIn("once more", said, "there is nothing to compare with")

    def test_a_selection_of_which_nothing_can_be_shown_ends_a_cell_and_is_no_fault(self):
        report = json.loads(self.call("check-plugin", UNSOUND, "--json", "--set", "how=unshowable").stdout)
        notes = [finding["detail"] for finding in report["findings"] if finding["check"] == "abstraction_empty"]
        self.assertIn("a run ends this cell as abstraction_empty", notes[0])

    def test_a_method_is_confined_as_in_a_run(self):
        probe = FIXTURES / "faulty/fixture_probe.so"
        detail = self.check(probe, "how=socket")["select"]["detail"]
        self.assertEqual(detail, "plugin fixture_probe: socket: EPERM")
        said = self.check(probe, "how=read", f"path={BUILD}/share/lgabench/scenarios/heart.json")["select"]["detail"]
        self.assertEqual(said, "plugin fixture_probe: read: EACCES")
        self.assertEqual(list(self.check(FIXTURES / "faulty/fixture_denormals.so")), ["rounding mode"])

    def test_outlives_what_crashes_throws_and_never_returns(self):
        for where, how, check, says in [
            ("select", "log", "select", r"services\.log\.epoch\(\) was called outside of learn\(\)"),
            ("act", "nan", "act", "expected a finite number, got nan"),
            ("act", "throw", "act", "the fixture's own failure"),
            ("learn", "throw_int", "learn", "threw int"),
            ("select", "segfault", "process", r"signal 11 \(Segmentation fault\) in phase select"),
            ("act", "spin", "process", "stopped after 3"),
            ("act", "exit", "process", r"ended its own process by exit\(\): exited with 0 in phase act"),
            ("act", "quick_exit", "process", "its process ended in the middle of a call: exited with 0 in phase act"),
            ("act", "noexcept", "process", r'"inside noexcept" was thrown where nothing may be'),
            ("learn", "recursion", "process", "its stack overflowed"),
            ("act", "close_socket", "process", "closed descriptor 3, or put another file there"),
            ("act", "messages", "process", r"does it write to descriptor 3, where lgabench talks with it\?"),
            ("destroy", "throw", "process", r"signal 6 \(Aborted\) in phase destroy the method"),
        ]:
            with self.subTest(where=where, how=how):
                words = ("--timeout", "3", "--json", "--set", f"where={where}", "--set", f"how={how}")
                report = json.loads(self.call("check-plugin", FAULTY, *words, expect=1).stdout)
                problems = {f["check"]: f["detail"] for f in report["findings"] if f["state"] == "problem"}
                self.assertRegex(problems.get(check, ""), says)

    def test_one_that_takes_all_memory_meets_a_limit(self):
        process = subprocess.Popen(command_line("check-plugin", FAULTY, "--json", "--memory", ".5", "--set", "where=learn", "--set", "how=allocate"),
                                   stdout=subprocess.PIPE, text=True, env=self.environment, cwd=self.dir)
        out = process.stdout.read()
        _, status, used = os.wait4(process.pid, 0)
        process.stdout.close()
        process.returncode = os.waitstatus_to_exitcode(status)
        self.assertEqual(process.returncode, 1)
        problems = {f["check"]: f["detail"] for f in json.loads(out)["findings"] if f["state"] == "problem"}
        self.assertEqual(problems, {"learn": "plugin fixture_faulty (method): out of memory (the limit is --memory)"})
        self.assertLess(used.ru_maxrss / (1 << 20), 1.5)

    def test_what_a_run_bears_is_a_note(self):
        for words, check, says in (((UNSOUND, "--set", "how=far"), "bounds of actions", r"outside of their bounds, the first: pose0.x = 1e\+06 m, of 0.25 to 0.75"),
                                   ((FIXTURES / "faulty/fixture_fast_math.so",), "compilation", "built with -ffast-math")):
            report = json.loads(self.call("check-plugin", *words, "--json").stdout)
            notes = {finding["check"]: finding["detail"] for finding in report["findings"] if finding["state"] == "note"}
            self.assertRegex(notes[check], says)

    def test_names_both_sides_of_a_refusal(self):
        problems = self.check(FIXTURES / "refused/wrong_strings.so")
        self.assertIn("build it without -D_GLIBCXX_USE_CXX11_ABI=0", problems["descriptor"]["detail"])
        self.assertIn("build it without -D_GLIBCXX_DEBUG", self.check(FIXTURES / "refused/wrong_iterators.so")["descriptor"]["detail"])
        self.assertRegex(problems["descriptor"]["detail"], r'string ABI "old" \(this program: "cxx11"\)')
        self.assertRegex(self.check(FIXTURES / "refused/missing_symbol.so")["process"]["detail"], "undefined symbol")
        self.assertIn("not a regular file", self.check(self.dir)["descriptor"]["detail"])
        self.assertIn("expected option=value", self.call("check-plugin", UNSOUND, "--set", "how", expect=2).stderr)

    def test_an_id_that_another_plugin_has(self):
        self.environment["LGABENCH_PLUGIN_PATH"] = str(FIXTURES / "good")
        detail = self.check(FIXTURES / "refused/duplicate.so")["id"]["detail"]
        self.assertEqual(detail, f"fixture_constant is also the id of {FIXTURES}/good/fixture_constant.so")

    def test_on_a_scenario_of_several_steps(self):
        (self.dir / "acts.py").write_text(STOPS)
        for name, problem in ("Stops", None), ("Counts", "order of scenes"), ("Blind", "learn"):
            said = json.loads(self.call("check-plugin", f"acts.py:{name}", "--python", PYTHON, "--scenario", "refusing_heart", "--json",
                                        expect=1 if problem else 0).stdout)
            problems = {f["check"]: f["detail"] for f in said["findings"] if f["state"] == "problem"}
            self.assertEqual(list(problems)[:1], [problem] if problem else [], problems)
        self.assertIn("expected a method's file", self.call("check-plugin", BUILD / "lib/lgabench/plugins/mujoco.so", "--scenario", "heart", expect=2).stderr)
        self.assertIn('no scenario "none"', self.call("check-plugin", "acts.py:Stops", "--python", PYTHON, "--scenario", "none", expect=2).stderr)

    def test_in_the_environment_that_is_named(self):
        constant = FIXTURES / "good/fixture_constant.so"
        for words, environment, unseen in ((), "tabletop", True), (("--environment", "mobile"), "mobile", False):
            report = json.loads(self.call("check-plugin", constant, "--json", *words).stdout)
            found = {finding["check"]: finding["detail"] for finding in report["findings"]}
            self.assertEqual((found["environment"], "unseen commands" in found), (environment, unseen))
        self.assertIn("8 numbers each", found["actions"])
        engine = BUILD / "lib/lgabench/plugins/kinematic.so"
        self.assertEqual(self.call("check-plugin", engine, "--environment", "mobile").stderr, "the same once more in a second process\n")
        report = json.loads(self.call("check-plugin", engine, "--json", "--environment", "mobile").stdout)
        oracles = {finding["check"] for finding in report["findings"] if finding["check"].startswith("oracle")}
        self.assertEqual(oracles, {"oracle, bring", "oracle, throw_away", "oracle, fetch"})
        self.assertIn("no environment", self.call("check-plugin", engine, "--environment", "moon", expect=2).stderr)

    def test_shipped_plugins_are_good(self):
        for name, setting in {"mujoco": (), "lga": ("epochs=5",), "gcbc_dart": ("epochs=2",), "plga_active": ("epochs=2",)}.items():
            with self.subTest(name):
                self.assertEqual(self.check(BUILD / f"lib/lgabench/plugins/{name}.so", *setting, expect=0), {})


if __name__ == "__main__":
    unittest.main()
