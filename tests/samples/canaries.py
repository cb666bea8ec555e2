#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What docs/site must refuse, each fault alone: the checks of links, options and samples see it."""

import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
MAKE = ROOT / "docs/site_make"
sys.path.insert(0, str(MAKE))
import options  # noqa: E402
import samples  # noqa: E402


def fence(language, text, behind=""):
    return samples.Fence("docs/canary.md", 1, language, text, behind)


class Canaries(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = Path(scratch.name)
        samples.WORK = self.folder

    def links(self, body):
        (self.folder / "other.html").write_text('<h1 id="there">x</h1>')
        (self.folder / "index.html").write_text(f'<a href="other.html#there">x</a>{body}')
        run = subprocess.run([sys.executable, MAKE / "links.py", self.folder], text=True,
                             capture_output=True)
        return run.returncode, run.stdout

    def test_good_links_pass(self):
        self.assertEqual(self.links('<a href="https://example.org">x</a>')[0], 0)

    def test_bad_links_do_not(self):
        for body, why in {'<a href="none.html">x</a>': "does not exist",
                          '<a href="other.html#none">x</a>': "no such place",
                          '<a href="#none">x</a>': "no such place",
                          '<a href="/other.html">x</a>': "top of a server",
                          '<img src="none.png">': "does not exist",
                          '<script src="https://example.org/x.js"></script>': "from elsewhere",
                          '<link rel="stylesheet" href="https://example.org/x.css">':
                              "from elsewhere"}.items():
            status, said = self.links(body)
            self.assertEqual(status, 1, body)
            self.assertIn(why, said)

    def test_a_program_must_compile_and_print_what_stands_there(self):
        program = '#include <cstdio>\nint main() { std::puts("one"); }\n'
        self.assertEqual(samples.check_program(fence("cpp", program, "\nIt prints\n\n    one\n")), "")
        self.assertIn("not, as the page says", samples.check_program(
            fence("cpp", program, "\nIt prints\n\n    two\n")))
        self.assertIn("docs/canary.md", samples.check_program(
            fence("cpp", "int main() { return none; }\n")))

    def test_a_fragment_needs_what_it_leaves_out(self):
        self.assertIn("tests/samples/docs.canary.hpp does not exist",
                      samples.check_fragments("docs/canary.md", [fence("cpp", "f();\n")]))

    def test_python_uses_names_that_exist(self):
        self.assertEqual(samples.check_python(fence("python", "import repel\nrepel.Shape\n")), "")
        self.assertIn("repel.Nothing does not exist", samples.check_python(
            fence("python", "import repel\nrepel.Nothing\n")))
        self.assertIn("syntax", samples.check_python(fence("python", "a b\n")))

    def test_a_fragment_of_a_scene_must_be_one_in_its_frame(self):
        if not (ROOT / "build/release/bin/teleop").is_file():
            self.skipTest("teleop is not built")
        law = "laws:\n  wall: {range: 20 mm, surface_force: 100 N%s}\n"
        self.assertEqual(samples.check_scene(fence("yaml", law % ", damping: 100 N s/m")), "")
        self.assertIn("colour", samples.check_scene(fence("yaml", law % ", colour: red")))
        network = "network:\n  - {module: %s}\n  - ...\n"
        self.assertEqual(samples.check_scene(fence("yaml", network % "six_axes")), "")
        self.assertIn("seven_axes", samples.check_scene(fence("yaml", network % "seven_axes")))

    def test_commands_have_options_that_exist(self):
        known = samples.known_options()
        self.assertIn("--view", known["teleop run"])
        self.assertIn("--rate", known["qualify"])
        self.assertEqual(samples.check_commands(known)[0], [])
        known["teleop run"].remove("--view")
        self.assertTrue(any("no option --view" in text
                            for text in samples.check_commands(known)[0]))

    def test_options_that_a_page_lacks(self):
        program = self.folder / "qualify"
        program.write_text("#!/bin/sh\nprintf 'Says so.\\nUsage: qualify [OPTIONS]\\n\\nOptions:\\n"
                           "  --new FLOAT:1 to 2=1        Is new\\n'\n")
        os.chmod(program, 0o755)
        self.assertEqual(options.main(["--check", str(self.folder)]), 1)
        text = options.section("qualify", options.help_of(self.folder, "qualify"))
        self.assertIn("| `--new` | 1 to 2 | `1` | Is new |", text)


if __name__ == "__main__":
    unittest.main()
