"""tools/evolve breeds drivers that are no worse in the end, and the same again with the same seed."""
import csv
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SOURCES = Path(__file__).resolve().parents[2]


class Evolve(unittest.TestCase):
    def run_in(self, folder):
        return subprocess.run([SOURCES / "tools/evolve", "--generations", "3", "--population", "4", "--seconds", "40", "--batch",
                               Path(sys.argv[1]) / "bin/sparkbatch", "--out", folder], capture_output=True, text=True)

    def test_it_breeds(self):
        with tempfile.TemporaryDirectory() as one, tempfile.TemporaryDirectory() as other:
            first, second = self.run_in(one), self.run_in(other)
            self.assertEqual(first.returncode, 0, first.stdout + first.stderr)
            self.assertEqual(first.stdout, second.stdout)
            rows = list(csv.DictReader((Path(one) / "drivers.csv").open()))
            self.assertEqual(len(rows), 12)
            best = [max(float(r["laps"]) for r in rows if int(r["generation"]) == g) for g in (1, 2, 3)]
            self.assertEqual(best, sorted(best))
            self.assertIn("<svg", (Path(one) / "drivers.html").read_text())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
