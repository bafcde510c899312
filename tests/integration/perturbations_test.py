"""The suite `perturbations`: what its record proves, and what is refused.

LGABENCH_BUILD names the build tree. One CTest entry a class; by hand: python3 perturbations_test.py Perturbations
"""
import json
import pathlib
import unittest

import case

EPISODES = 6
PARTS = ("objects", "physics", "rgb", "ids", "instances", "words", "answers", "selection", "input", "control")
CHANGES = {"distractors": {"objects", "physics", "rgb", "ids", "instances"}, "object_size": {"physics", "rgb", "ids"},
           "friction_mass": {"physics"}, "paraphrase": {"words"}, "light_intensity": {"rgb"}, "segmentation": {"ids"},
           "selection_errors": {"selection"}}
MAY_CHANGE = {"segmentation": {"instances"}, "paraphrase": {"answers", "selection"}}
NOT_SEEN = {"friction_mass"}  # all others change the policy's input


def lines(file):
    return [json.loads(line) for line in pathlib.Path(file).read_text().splitlines()]


class Perturbations(case.BesideOneRun):
    run_of_class = ("run", "perturbations", "--preset", "smoke", "--episodes", EPISODES, "--set", "*.epochs=20")

    def setUp(self):
        super().setUp()
        if self is not self.first:
            self.copy_first("run")

    def cells_of(self, *methods):
        return [path.parent for path in sorted(self.dir.glob("run/cells/*/cell.json"))
                if json.loads(path.read_text())["method"]["id"] in methods]

    def test_a_line_for_each_episode_and_a_hash_for_each_part(self):
        self.assert_matches_schemas("run")
        for cell in self.cells_of("lga", "gcbc_dart", "oracle"):
            perturbed, episodes = lines(cell / "perturbed.jsonl"), lines(cell / "episodes.jsonl")
            self.assertEqual([(e["arm"], e["index"]) for e in perturbed], [(e["arm"], e["index"]) for e in episodes])
            self.assertEqual({e["arm"] for e in perturbed},
                             {"control", *(f"{axis}_{level}" for axis in CHANGES for level in (1, 4))})
            lacks = {"lga": [], "gcbc_dart": ["answers", "selection"], "oracle": ["words", "answers", "selection"]}
            method = json.loads((cell / "cell.json").read_text())["method"]["id"]
            for e in perturbed:
                self.assertEqual([part for part in PARTS if e[part] is None], lacks[method])

    def test_an_arm_changes_what_its_axis_declares_and_nothing_else(self):
        for cell in self.cells_of("lga"):
            perturbed = lines(cell / "perturbed.jsonl")
            controls = {e["index"]: e for e in perturbed if e["axis"] is None}
            self.assertEqual(len(controls), EPISODES)
            for e in perturbed:
                if e["axis"] is None:
                    continue
                differ = {part for part in PARTS if e[part] != controls[e["index"]][part]}
                must = CHANGES[e["axis"]] | ({"input"} if e["axis"] not in NOT_SEEN else set())
                self.assertEqual(differ - MAY_CHANGE.get(e["axis"], set()), must, e["arm"])

    def test_what_is_not_seen_is_acted_on_alike_and_sizes_are_recorded(self):
        for cell in self.cells_of("lga"):
            acted = {(e["arm"], e["index"]): e["action"] for e in lines(cell / "episodes.jsonl")}
            scales = {(e["arm"], e["index"]): e["target_scale"] for e in lines(cell / "perturbed.jsonl")}
            for index in range(EPISODES):
                self.assertEqual(acted["friction_mass_4", index], acted["control", index])
                self.assertEqual(scales["control", index], 1)
                self.assertIn(scales["object_size_4", index], (.67, 1.05, 1.1, 1.25, 1.5))

    def test_status_vouches_for_the_record_and_names_its_library(self):
        for cell in self.cells_of("lga", "oracle"):
            status = json.loads((cell / "status.json").read_text())
            self.assertIn("perturbed.jsonl", status["files"])
            self.assertIn("liblgabench_perturbations.so", status["build"])
        said = self.call("verify", "run", "--sample", "2", "--seed", "1").stdout
        self.assertEqual(said.count("\nbit-identical "), 2, said)

    def test_other_suites_neither_have_the_record_nor_name_the_library(self):
        self.call("run", "q1", "--scenarios", "heart", "--methods", "lga", "--demos", "2", "--seeds", "0", "--episodes",
                  "1", "--set", "lga.epochs=2", "--out", "other")
        for _, status in self.cells("other").values():
            self.assertNotIn("perturbed.jsonl", status["files"])
            self.assertNotIn("liblgabench_perturbations.so", status["build"])

    def test_the_report_has_each_level_of_each_axis(self):
        summary = json.loads((self.dir / "run/summary.json").read_text())
        curves = {(c["method"], c["axis"]): c for c in summary["perturbations"]}
        self.assertEqual(set(curves), {(method, axis) for method in ("lga", "gcbc_dart", "oracle") for axis in CHANGES})
        for (method, axis), curve in curves.items():
            self.assertEqual([level["level"] for level in curve["levels"]], [1, 4])
            unchanged = {level["unchanged_inputs"] for level in curve["levels"]}
            if method != "oracle" and axis == "friction_mass":
                self.assertEqual(unchanged, {EPISODES}, "nobody sees it")
            elif method == "gcbc_dart" and axis == "selection_errors":
                self.assertEqual(unchanged, {EPISODES}, "it selects nothing")
            elif method != "oracle":
                self.assertEqual(unchanged, {0})
            self.assertEqual({level["inputs"] for level in curve["levels"]}, {EPISODES})
        page = (self.dir / "run/report.html").read_text()
        for axis in ("light_intensity", "segmentation"):
            self.assertIn(f"{axis}: scene 0 of heart", page, "one scene at each level")
        self.assertNotIn("selection_errors: scene", page, "which no picture shows")

    def test_some_axes_and_arms_alone_end_as_in_the_whole_suite(self):
        said = self.call(*self.run_of_class, "--axes", "object_size:4,light_intensity", "--arms", "paraphrase_1", "--tables",
                         "--out", "part").stdout
        self.assertIn("only these were played: object_size 4; light_intensity; paraphrase_1", " ".join(said.split()))
        self.assert_matches_schemas("part")
        played = {"control", "object_size_4", "light_intensity_1", "light_intensity_4", "paraphrase_1"}
        whole = {cell["method"]["name"]: key for key, (cell, _) in self.cells("run").items()}
        for key, (cell, _) in self.cells("part").items():
            self.assertNotEqual(key, whole[cell["method"]["name"]])
            for file in "episodes.jsonl", "perturbed.jsonl":
                part, all_arms = ((self.dir / run / file).read_text().splitlines()
                                  for run in (f"part/cells/{key}", f"run/cells/{whole[cell['method']['name']]}"))
                self.assertEqual({json.loads(line)["arm"] for line in part}, played)
                self.assertEqual(part, [line for line in all_arms if json.loads(line)["arm"] in played])
        summary = json.loads((self.dir / "part/summary.json").read_text())
        self.assertEqual({row["arm"] for row in summary["rows"]} - {"(mean)"}, played)
        self.call("verify", "part", "--sample", "1", "--seed", "1")
        # What is not played asks nothing of the engine.
        self.call("run", "perturbations", "--engines", "kinematic", "--axes", "camera_turn:1", "--dry-run")

    def test_demonstrations_seen_through_an_axis(self):
        small = ["run", "q1", "--scenarios", "heart", "--methods", "lga,gcbc_dart", "--demos", "4", "--seeds", "0",
                 "--episodes", "1", "--set", "*.epochs=3"]
        self.call(*small, "--out", "plain")
        said = self.call(*small, "--train-on", "segmentation:any", "--tables", "--out", "through").stdout
        self.assertIn("methods saw their demonstrations through segmentation, at a level drawn for each", said)
        self.assert_matches_schemas("through")
        plain = {(cell["method"]["name"], cell["demonstrations"]): key for key, (cell, _) in self.cells("plain").items()}
        for key, (cell, status) in self.cells("through").items():
            method = cell["method"]["kind"] == "method"
            self.assertEqual(cell.get("train_on"), {"segmentation": "any"} if method else None)
            self.assertEqual("liblgabench_perturbations.so" in status["build"], method)
            before = plain[cell["method"]["name"], cell["demonstrations"]]
            self.assertEqual(key == before, not method)
            if cell["method"]["id"] == "lga":  # which learns from masks
                self.assertNotEqual(*[(self.dir / run / "training.jsonl").read_text()
                                      for run in (f"plain/cells/{before}", f"through/cells/{key}")])
        record = json.loads((self.dir / "through/run.json").read_text())
        self.assertEqual(record["request"]["train_on"], {"segmentation": "any"})
        self.assertEqual(self.call("verify", "through", "--sample", "2", "--seed", "1").stdout.count("\nbit-identical "), 2)

    def test_what_there_is_not_is_refused_in_a_line(self):
        suite = json.loads((case.BUILD / "share/lgabench/suites/perturbations.json").read_text())

        def refusal(axis, levels):
            self.dir.joinpath("mine.json").write_text(json.dumps({**suite, "id": "mine", "presets": {},
                                                                  "perturbations": [{"axis": axis, "levels": levels}]}))
            said = self.call("run", "mine.json", "--dry-run", expect=2).stderr
            self.assertEqual(said.count("\n"), 1, said)
            return said

        self.assertIn('no axis "light_color" (did you mean "light_colour"?)', refusal("light_color", [1]))
        self.assertIn("expected a level from 1 to 4 (10 %; 20 %; 30 %; 45 %)", refusal("light_colour", [5]))
        self.assertIn("mine.json", refusal("all", [0]))


class Instructions(case.BesideOneRun):
    """The axis `instruction`: who hears the words, who does not, and who has no answer to them."""
    small = ("run", "perturbations", "--preset", "instruction", "--scenarios", "many_hearts", "--episodes", EPISODES,
             "--demos", "2", "--seeds", "0", "--engines", "kinematic", "--set", "*.epochs=20")
    run_of_class = (*small, "--methods", "lga,factorial+scenes=truth+input=object_mask")

    def setUp(self):
        super().setUp()
        if self is not self.first:
            self.copy_first("run")

    def cell_of(self, method):
        [cell] = [path.parent for path in self.dir.glob("run/cells/*/cell.json")
                  if json.loads(path.read_text())["method"]["id"] == method]
        scenario = json.loads((cell / "cell.json").read_text())["scenario"]
        return cell, scenario, {(e["arm"], e["index"]): e for e in lines(cell / "episodes.jsonl")}

    def test_scenes_are_the_controls_and_every_episode_tells_what_it_was_told_and_took(self):
        self.assert_matches_schemas("run")
        for method in ("lga", "factorial", "oracle"):
            cell, scenario, episodes = self.cell_of(method)
            controls = {e["index"]: e for e in lines(cell / "perturbed.jsonl") if e["axis"] is None}
            for e in lines(cell / "perturbed.jsonl"):
                for part in ("objects", "physics", "rgb", "ids", "instances", "control"):
                    self.assertEqual(e[part], controls[e["index"]][part])
            for (arm, _), e in episodes.items():
                told = scenario["commands"][e["told"]]
                self.assertEqual(told.get("arm"), arm if arm in ("instruction_1", "instruction_2") else None)
                self.assertEqual(e["told"] == e["command"], arm == "control")
                self.assertTrue(e["took"] == "own" if e["success"] else e["took"] in ("own", "other", "third", "none"))
            if method == "oracle":
                self.assertEqual({e["took"] for e in episodes.values()}, {"own"})

    def test_who_reads_no_words_acts_alike_and_has_exactly_no_use_of_language(self):
        _, _, episodes = self.cell_of("factorial")
        for (arm, index), e in episodes.items():
            self.assertEqual((e["action"], e["took"]), tuple(episodes["control", index][of] for of in ("action", "took")))
        summary = json.loads((self.dir / "run/summary.json").read_text())
        use = {c["method"]: c["levels"][2]["use_of_language"]["difference"] for c in summary["perturbations"]}
        self.assertEqual(use["factorial"], 0)
        self.assertGreater(use["lga"], 0)
        self.assertIn("use of language", (self.dir / "run/report.md").read_text())

    def test_lga_is_told_what_was_selected_for_the_words_that_were_given(self):
        cell, scenario, _ = self.cell_of("lga")
        perturbed = {(e["arm"], e["index"]): e for e in lines(cell / "perturbed.jsonl")}
        for index in range(EPISODES):
            for part in ("words", "answers", "selection"):
                self.assertNotEqual(perturbed["instruction_3", index][part], perturbed["control", index][part])
        self.assertEqual({arm for arm, _ in perturbed}, {"control", "instruction_1", "instruction_2", "instruction_3"})

    def test_an_answer_to_the_scenario_is_none_to_the_words_and_a_missing_one_is_refused(self):
        answers = json.loads((case.BUILD / "share/lgabench/answers/claude_instruction.json").read_text())["answers"]
        hearts = {"object_types": ["heart"], "textures": "ALL"}
        of_scenario = {"scenario": "many_hearts", "command": "Bring me the heart.", "target": hearts}

        def run(entries, out, expect=0):
            self.dir.joinpath("mine.json").write_text(json.dumps({"model": "me", "space": "tabletop", "answers": entries}))
            return self.call(*self.small, "--methods", "lga", "--no-reference", "--answers", "mine.json", "--out", out, expect=expect)

        self.assertIn('none for "" in the space tabletop', run([a for a in answers if a["command"]], "lacking", expect=2).stderr)
        run([*answers, of_scenario], "other")
        [selection] = self.dir.glob("other/cells/*/selection.json")
        said = [c["selection"]["target"] for c in json.loads(selection.read_text())["commands"]]
        self.assertGreater(len({json.dumps(one) for one in said}), 5, "and not the scenario's to all of them")


if __name__ == "__main__":
    unittest.main()
