"""The pages for plugin authors: code in them is code that is built, and Doxygen has nothing to complain of.

Usage: docs_test.py SOURCE_DIR DOXYFILE
"""
import pathlib
import re
import shutil
import subprocess
import sys
import unittest

SOURCE, DOXYFILE = (pathlib.Path(p) for p in sys.argv[1:3])


class Pages(unittest.TestCase):
    page = (SOURCE / "docs/add-a-method.md").read_text()

    def test_shown_code_is_the_example(self):
        example = SOURCE / "examples/select_only"
        for language, file in ("cpp", "select_only.cpp"), ("cmake", "CMakeLists.txt"):
            shown = re.search(rf"```{language}\n(.*?)```", self.page, re.S)[1]
            self.assertEqual(shown, (example / file).read_text())
        self.assertLessEqual(len((example / "select_only.cpp").read_text().splitlines()), 25)

    def test_every_example_is_listed(self):
        for example in (SOURCE / "examples").glob("*/*.cpp"):
            if "LGABENCH_METHOD(" in example.read_text():
                self.assertIn(f"`{example.stem}`", self.page)
        in_python = (SOURCE / "docs/add-a-method-in-python.md").read_text()
        for example in (SOURCE / "examples/python").glob("*.py"):
            self.assertIn(f"`examples/python/{example.name}`", in_python)


@unittest.skipUnless(shutil.which("doxygen"), "doxygen is not installed")
class Doxygen(unittest.TestCase):
    def complaints(self, more=""):
        done = subprocess.run(["doxygen", "-"], input=DOXYFILE.read_text() + more, capture_output=True, text=True)
        return [line for line in done.stderr.splitlines() if re.search(r"(warning|error):", line)]

    def test_no_warnings(self):
        self.assertEqual(self.complaints(), [])

    def test_every_public_class_and_function_is_documented(self):
        missing = [line for line in self.complaints("\nWARN_IF_UNDOCUMENTED = YES\nGENERATE_HTML = NO\nGENERATE_XML = YES\n")
                   if "(variable)" not in line]
        self.assertEqual(missing, [])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
