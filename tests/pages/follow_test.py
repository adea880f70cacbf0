"""follow.py reports differences between a page and the output of its commands."""
import contextlib
import io
import os
import select
import tempfile
import unittest
from pathlib import Path

import follow


def page(*parts):
    """The exit code and the stderr of a page with these blocks, each of them (first line, text)."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "page.md"
        file.write_text("".join(f"Some text.\n```{first}\n{text}\n```\n" for first, text in parts))
        home = Path(folder) / "home"
        home.mkdir()
        errors = io.StringIO()
        with contextlib.redirect_stderr(errors), contextlib.redirect_stdout(io.StringIO()):
            code = follow.follow(file, "/some/build", home)
        return code, errors.getvalue()


MOVE = ("sh", "mkdir ~/game && cd ~/game && export WORD=red")


def has_ended(pid):
    """Waits for the end of a killed process that is not a child; False if it runs on for a minute."""
    try:
        end = os.pidfd_open(pid)
    except ProcessLookupError:
        return True
    try:
        return bool(select.select([end], [], [], 60)[0])
    finally:
        os.close(end)


class Pages(unittest.TestCase):
    def holds(self, *parts):
        code, errors = page(MOVE, *parts)
        self.assertEqual(code, 0, errors)

    def breaks(self, why, *parts):
        code, errors = page(MOVE, *parts)
        self.assertEqual(code, 1)
        self.assertIn(why, errors)

    def test_files_are_written_to_the_working_folder(self):
        self.holds(("lua a/b.lua", "one"), ("lua >>a/b.lua", "two"), ("sh", "cat ~/game/a/b.lua; echo $WORD"), ("text", "one\ntwo\nred"))

    def test_build_release_is_the_tested_build_tree(self):
        self.holds(("sh", "echo build/release/bin"), ("text", "/some/build/bin"))

    def test_lines_must_come_in_order_and_may_have_others_between_them(self):
        self.holds(("sh", "echo one; echo two; echo three"), ("text", "one\n...\nthree"))
        self.breaks("the page promises\none", ("sh", "echo one; echo two"), ("text", "two\none"))
        self.breaks("the page promises\ntwo", ("sh", "echo one two"), ("text", "one\ntwo"))

    def test_text_must_match_exactly(self):
        self.holds(("sh", "echo 'a (b) 12 ms'"), ("text", "a (b) ... ms"))
        self.breaks("the page promises\ntook 3 s", ("sh", "echo took 4 s"), ("text", "took 3 s"))

    def test_text_like_allows_other_numbers_and_hashes_only(self):
        self.holds(("sh", "echo 'score [3, 0] -1.5 http://127.0.0.1:80/ 0123456789abcdef'"),
                   ("text like", "score [12, 4] 0 http://127.0.0.1:40871/ fedcba9876543210"))
        self.breaks("the page promises\nwon 3", ("sh", "echo lost 3"), ("text like", "won 3"))
        self.breaks("the page promises\nscore 3", ("sh", "echo score None"), ("text like", "score 3"))

    def test_text_rising_requires_growing_bars(self):
        wanted = "1  ####......oooo  20 %\n2  ########oooo  60 %"
        self.holds(("sh", "echo '1  #######oooo  7 %'; echo '2  ##########  8 %'"), ("text rising", wanted))
        self.breaks("the last bar is not the longest", ("sh", "echo '1  #######oooo  9 %'; echo '2  ##########  8 %'"), ("text rising", wanted))

    def test_a_failing_command_ends_the_run(self):
        self.breaks("exit code 1", ("sh", "false; echo more"))
        self.breaks("exit code 1", ("sh", "false | cat"))

    def test_programs_in_the_background_run_on_until_the_page_ends(self):
        with tempfile.TemporaryDirectory() as folder:
            self.holds(("sh", f"sleep 1000 & echo $! >{folder}/pid; echo begun"), ("text", "begun"), ("sh", f"kill -0 $(cat {folder}/pid)"))
            pid = int((Path(folder) / "pid").read_text())
            self.assertTrue(has_ended(pid))

    def test_a_program_may_run_until_it_is_stopped(self):
        ends = "trap 'echo done; exit 0' INT; echo begun; while true; do sleep 0.01; done"
        self.holds(("sh until Ctrl-C", f'bash -c "{ends}"'), ("text", "begun\ndone"))
        self.breaks("ended by itself with exit code 3", ("sh until Ctrl-C", 'bash -c "exit 3"'))
        self.breaks("exit code 4 after Ctrl-C", ("sh until Ctrl-C", 'bash -c "' + ends.replace("exit 0", "exit 4") + '"'))

    def test_commands_are_skipped_with_a_reason(self):
        self.holds(("sh skip: needs two machines", "false"), ("sh", "echo one"), ("text", "one"))

    def test_a_page_without_commands_fails(self):
        code, errors = page(("lua", "one"))
        self.assertEqual(code, 1)
        self.assertIn("there are no commands", errors)

    def test_nothing_is_written_into_the_sources(self):
        code, errors = page(("lua a.lua", "one"))
        self.assertEqual(code, 1)
        self.assertIn("Spark's own folder", errors)


if __name__ == "__main__":
    unittest.main()
