"""What whoever hosts the repository finds: workflows, forms of issues, a container, hooks of pre-commit, and what makes a release.

Usage: hosting_test.py SOURCE_DIR [CLASS...]
"""
import json
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(sys.argv[1]).resolve()
ACTIONLINT = SOURCE / ".deps/actionlint/actionlint"
WORKFLOWS = sorted((SOURCE / ".github/workflows").glob("*.yml"))
FORMS = sorted(file for file in (SOURCE / ".github/ISSUE_TEMPLATE").glob("*.yml") if file.name != "config.yml")
try:
    import yaml
except ImportError:
    yaml = None


def programs(command):
    """Of this repository, which the command starts or tells Python to."""
    return [word for word in shlex.split(command, comments=True) if re.fullmatch(r"(?:\./)?[.\w-]+(?:/[\w.-]+)*", word)
            and word.startswith(("./", ".ci/", "cmake/", "docs/", "tests/"))]


@unittest.skipUnless(yaml, "not installed: python3-yaml")
class Files(unittest.TestCase):
    def workflows(self):
        self.assertEqual([file.stem for file in WORKFLOWS], ["ci", "entry", "release", "site"])
        return {file.stem: yaml.load(file.read_text(), yaml.BaseLoader) for file in WORKFLOWS}  # "on" stays a word

    def test_programs_that_are_started_are_there(self):
        started = [step["run"] for flow in self.workflows().values() for job in flow["jobs"].values() for step in job["steps"] if "run" in step]
        hooks, = yaml.safe_load((SOURCE / ".pre-commit-config.yaml").read_text())["repos"]
        started += [hook["entry"] for hook in hooks["hooks"]]
        started.append(json.loads((SOURCE / ".devcontainer/devcontainer.json").read_text())["postCreateCommand"])
        named = {word for command in started for word in programs(command)}
        self.assertLessEqual({".ci/run", ".ci/release", "docs/site", "cmake/setup", "tests/structure/docs_test.py"}, named)
        self.assertEqual([name for name in named if not (SOURCE / name).is_file() or
                          not (name.endswith(".py") or os.access(SOURCE / name, os.X_OK))], [])

    def test_a_workflow_reads_and_a_job_that_writes_says_what(self):
        writes = {(name, job): sorted(of for of, how in rights.get("permissions", {}).items() if how == "write")
                  for name, flow in self.workflows().items() for job, rights in flow["jobs"].items()}
        self.assertEqual({job: of for job, of in writes.items() if of}, {
            ("site", "deploy"): ["id-token", "pages"], ("release", "image"): ["packages"], ("release", "draft"): ["contents"]})
        for name, flow in self.workflows().items():
            self.assertEqual(flow["permissions"], {"contents": "read"}, name)
            self.assertEqual([job for job, of in flow["jobs"].items() if "timeout-minutes" not in of], [], name)

    def test_nothing_is_published_before_a_host_says_so(self):
        for name in "site", "release":
            jobs = self.workflows()[name]["jobs"]
            self.assertEqual([job for job, of in jobs.items() if of.get("if") != "${{ vars.PUBLISH == 'true' }}" and not of.get("needs")], [])
        self.assertIn("`PUBLISH`", (SOURCE / "docs/maintaining.md").read_text())

    def test_a_request_to_the_board_is_never_run(self):
        steps = self.workflows()["entry"]["jobs"]["check"]["steps"]
        self.assertEqual([step["with"]["path"] for step in steps if "uses" in step], ["trusted", "request"])
        self.assertEqual([step["run"] for step in steps if "cmake" in step.get("run", "") and step.get("working-directory") != "trusted"], [])
        self.assertEqual([step for step in steps if step.get("working-directory", "trusted") != "trusted"], [])
        self.assertEqual([step for step in steps if "${{" in step.get("run", "")], [])

    def test_forms(self):
        """Members and kinds of fields are those that GitHub documents: it shows no form that has others."""
        self.assertEqual([file.stem for file in FORMS], ["entry", "method", "wrong_number"])
        for file in FORMS:
            form = yaml.safe_load(file.read_text())
            self.assertLessEqual(set(form), {"name", "description", "title", "labels", "body"}, file.name)
            ids = [field["id"] for field in form["body"] if field["type"] != "markdown"]
            self.assertEqual(len(ids), len(set(ids)), file.name)
            for field in form["body"]:
                members = {"markdown": {"value"}, "input": {"label", "description", "placeholder"}, "dropdown": {"label", "description", "options"},
                           "textarea": {"label", "description", "placeholder", "render"}}[field["type"]]
                self.assertLessEqual(set(field["attributes"]), members, file.name)
                self.assertIn("value" if field["type"] == "markdown" else "label", field["attributes"], file.name)
                self.assertLessEqual(set(field) - {"type", "id", "attributes"}, {"validations"}, file.name)
            for page in re.findall(r"\b(?:docs/[\w/-]+|[A-Z]+)\.md\b", file.read_text()):
                self.assertTrue((SOURCE / page).is_file(), f"{file.name}: {page}")


class Text(unittest.TestCase):
    def test_what_others_wrote_is_named_by_its_commit(self):
        used = [line.strip("- \n") for file in WORKFLOWS for line in file.read_text().splitlines() if "uses:" in line]
        self.assertGreater(len(used), 6)
        self.assertEqual([line for line in used if not re.fullmatch(r"uses: [\w-]+/[\w-]+@[0-9a-f]{40}  # v[\d.]+", line)], [])

    def test_no_address_is_invented(self):
        files = [*WORKFLOWS, *FORMS, SOURCE / ".devcontainer/devcontainer.json", SOURCE / ".pre-commit-config.yaml", SOURCE / ".ci/release"]
        self.assertEqual([file.name for file in files if re.search(r"https?://", file.read_text())], [])

    @unittest.skipUnless(ACTIONLINT.exists(), "not installed: actionlint (cmake/fetch/actionlint .deps/actionlint)")
    def test_actionlint_finds_nothing(self):
        done = subprocess.run([ACTIONLINT, "-no-color", *WORKFLOWS], capture_output=True, text=True)
        self.assertEqual((done.stdout + done.stderr, done.returncode), ("", 0))


class Release(unittest.TestCase):
    def release(self, *arguments):
        return subprocess.run([SOURCE / ".ci/release", *arguments], capture_output=True, text=True)

    version = re.search(r'LGABENCH_VERSION "(.*)"', (SOURCE / "framework/lgabench/core/version.hpp").read_text())[1]

    def test_a_tag_is_the_version_that_the_sources_state(self):
        for tag in [], ["v0.0.1"], [self.version]:
            done = self.release(*tag)
            self.assertEqual((done.returncode, done.stdout), (2, ""))
            self.assertIn(f"expected the tag v{self.version}, as framework/lgabench/core/version.hpp says", done.stderr)

    @unittest.skipIf("-" in version, "a version under development has no section yet")
    def test_notes_are_the_changelogs_section(self):
        done = self.release(f"v{self.version}")
        self.assertEqual(done.returncode, 0, done.stderr)
        section = re.search(rf"^## {re.escape(self.version)} .*?$(.*?)^## ", (SOURCE / "CHANGELOG.md").read_text(), re.M | re.S)[1]
        self.assertEqual(done.stdout.strip(), section.strip())

    def test_a_release_installs_what_packing_asks_for(self):
        asked = re.findall(r'tool\("([\w-]+)"\)', (SOURCE / "cmake/bundle.py").read_text())
        [installs] = re.findall(r"^cmake/setup.*$", (SOURCE / ".ci/release").read_text(), re.M)
        self.assertTrue(asked)
        for name in asked:
            self.assertIn(name, installs.split())

    @unittest.skipIf("-" in version, "a version under development has no section yet")
    def test_a_directory_with_something_in_it_is_refused(self):
        with tempfile.TemporaryDirectory() as directory:
            (pathlib.Path(directory) / "kept").touch()
            done = self.release(f"v{self.version}", directory)
            self.assertEqual((done.returncode, os.listdir(directory)), (2, ["kept"]))
        self.assertIn("expected an empty directory", done.stderr)

    def test_what_is_released_is_a_commit(self):
        with tempfile.TemporaryDirectory() as directory:
            copy = pathlib.Path(directory) / "copy"
            for name in ".ci/release", "framework/lgabench/core/version.hpp", "CHANGELOG.md":
                (copy / name).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(SOURCE / name, copy / name)

            def refused():
                done = subprocess.run([copy / ".ci/release", f"v{self.version}", "out"], capture_output=True, text=True, cwd=directory,
                                      env={**os.environ, "GIT_CEILING_DIRECTORIES": directory})
                self.assertEqual((done.returncode, done.stdout), (2, ""))
                return done.stderr
            self.assertIn("expected a clone, whose commit is released", refused())
            git = ["git", "-C", copy, "-c", "user.name=a", "-c", "user.email=a@example.org"]
            for words in (["init", "-q"], ["add", "."], ["commit", "-q", "-m", "all"]):
                subprocess.run([*git, *words], check=True)
            (copy / "CHANGELOG.md").write_text((copy / "CHANGELOG.md").read_text() + "more\n")
            self.assertIn("expected no change since the last commit, got  M CHANGELOG.md", refused())
            self.assertEqual(os.listdir(directory + "/out"), [], "a relative directory is the caller's")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[2:])
