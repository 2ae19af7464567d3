"""Tests of scripts/mutate: mutants that are known to live or to be killed, wrong entries, judges that hang or crash."""

import contextlib
import csv
import io
import json
import os
import stat
import tempfile
import unittest
from pathlib import Path

from mutation import campaign, equivalents, judges, texts
from mutation.instrument import Instrumenter, Mutant

BUILD = Path(os.environ["SELFTEST_BUILD"])
SOURCE = Path(__file__).with_name("selftest_counter.sv")

# All mutants that no test can see: unused signals, and a state whose exit equals that of the right one.
LIVING = {
    ("unseen_q <= count_o + 4'd1", ""),
    ("unseen_q <= count_o + 4'd1", "unseen_q <= count_o - 4'd1"),
    ("unseen_q <= count_o + 4'd1", "unseen_q <= count_o"),
    ("unseen_q <= count_o + 4'd1", "unseen_q <= 4'd1"),
    ("unseen_q <= count_o + 4'd1", "unseen_q <= count_o + 4'd0"),
    ("unseen_q <= count_o + 4'd1", "unseen_q <= count_o + 4'd2"),
    ("state_q <= EVEN", "state_q <= REST"),
}


class Folder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def script(self, name, text):
        path = self.folder / name
        path.write_text("#!/bin/sh\n" + text)
        path.chmod(path.stat().st_mode | stat.S_IXUSR)
        return str(path)


class Texts(unittest.TestCase):
    def mutated(self, original, nth):
        mutant = Mutant("id", 1, "m", "m.sv", 1, "operator", original, "a_q <= b - c", nth)
        return texts.mutated("x <= 1;\na_q  <= b +\n  c;\na_q <= b + c;\n", mutant)

    def test_only_the_place_that_is_meant_changes(self):
        self.assertEqual(self.mutated("a_q <= b + c", 1), "x <= 1;\na_q <= b - c;\na_q <= b + c;\n")
        self.assertEqual(self.mutated("a_q <= b + c", 2), "x <= 1;\na_q  <= b +\n  c;\na_q <= b - c;\n")

    def test_a_slip_that_is_no_text_is_none(self):
        self.assertIsNone(self.mutated("case label IDLE", 1))
        self.assertIsNone(self.mutated("a_q <= b + c", 3))


class Campaign(Folder):
    def run_with(self, entries, *options):
        equivalents_folder = self.folder / "equivalents"
        equivalents_folder.mkdir(exist_ok=True)
        (equivalents_folder / "selftest.toml").write_text(entries)
        self.output = io.StringIO()
        with contextlib.redirect_stdout(self.output), contextlib.redirect_stderr(io.StringIO()):
            return campaign.main(["--mutants", str(BUILD / "mutants.json"), "--judges", str(BUILD / "judges.json"),
                                  "--equivalents", str(equivalents_folder),
                                  "--out", str(self.folder), "--jobs", "2", *options])

    def results(self):
        with (self.folder / "results.csv").open(newline="") as file:
            return list(csv.DictReader(file))

    def entries(self, texts):
        return "".join(f'[[equivalent]]\nmodule = "selftest_counter"\noriginal = "{original}"\nmutated = "{mutated}"\n'
                       f'reason = "known"\n' for original, mutated in sorted(texts))

    def test_tells_the_living_from_the_killed(self):
        self.assertEqual(self.run_with(""), 1)
        rows = self.results()
        self.assertEqual({(row["original"], row["mutated"]) for row in rows if row["how"] == "lived"}, LIVING)
        self.assertEqual(len(rows), len(json.loads((BUILD / "mutants.json").read_text())))
        self.assertIn("selftest_counter.sv:27", self.output.getvalue())

    def test_listed_ones_may_live(self):
        self.assertEqual(self.run_with(self.entries(LIVING)), 0)

    def test_a_part_lists_a_family(self):
        def family(modules):
            return f'[[equivalent]]\nmodule = {modules}\npart = "unseen_q <= count_o - "\nreason = "known"\n'

        rest = {(original, mutated) for original, mutated in LIVING if "unseen_q <= count_o - " not in mutated}
        self.assertEqual(len(rest), len(LIVING) - 1)
        self.assertEqual(self.run_with(family(["selftest_counter"]) + self.entries(rest)), 0)
        with self.assertRaisesRegex(SystemExit, "no such mutant of m:"):
            self.run_with(family(["selftest_counter", "m"]) + self.entries(rest))

    def test_one_that_is_not_listed_may_not(self):
        self.assertEqual(self.run_with(self.entries(sorted(LIVING)[1:])), 1)

    def test_a_listed_one_that_is_killed_is_an_error(self):
        self.assertEqual(self.run_with(self.entries(LIVING | {("count_o <= '0", "count_o <= '1")})), 1)
        self.assertIn("KILLED, though listed", self.output.getvalue())

    def test_an_entry_that_matches_nothing_is_an_error(self):
        with self.assertRaisesRegex(SystemExit, "no such mutant"):
            self.run_with(self.entries(LIVING | {("count_o <= 4'd7", "count_o <= 4'd8")}))

    def test_an_entry_without_a_reason_is_an_error(self):
        with self.assertRaisesRegex(SystemExit, "reason"):
            self.run_with('[[equivalent]]\nmodule = "m"\noriginal = "a"\nmutated = "b"\nreason = " "\n')

    def test_a_sample_is_the_same_for_the_same_seed(self):
        chosen = []
        for seed in ("1", "1", "2"):
            self.run_with("", "--sample", "5", "--seed", seed)
            chosen.append({row["id"] for row in self.results()})
        self.assertEqual([len(ids) for ids in chosen], [5, 5, 5])
        self.assertEqual(chosen[0], chosen[1])
        self.assertNotEqual(chosen[0], chosen[2])

    def test_shards_are_the_whole_and_no_more(self):
        ids = []
        for number in (1, 2, 3):
            self.run_with("", "--shard", f"{number}/3")
            self.assertGreater(len(self.results()), 0)
            ids += [row["id"] for row in self.results()]
        self.assertEqual(sorted(ids), sorted(mutant["id"] for mutant in json.loads((BUILD / "mutants.json").read_text())))

    def test_a_shard_that_is_none_is_refused(self):
        for shard in ("0/3", "4/3", "1", "a/b"):
            with self.assertRaises(SystemExit):
                self.run_with("", "--shard", shard)

    def test_a_sample_has_none_that_is_listed(self):
        whole = len(json.loads((BUILD / "mutants.json").read_text()))
        self.assertEqual(self.run_with(self.entries(LIVING), "--sample", str(whole - 1)), 0)
        self.assertEqual(len(self.results()), whole - len(LIVING))

    def test_resumes_behind_what_is_there(self):
        self.run_with("")
        lines = (self.folder / "results.csv").read_text().splitlines(True)
        changed = lines[1].replace("mismatch", "crashed")
        self.assertNotEqual(changed, lines[1])
        (self.folder / "results.csv").write_text("".join([lines[0], changed]))
        self.run_with("", "--resume")
        rows = self.results()
        self.assertEqual(rows[0]["how"], "crashed")
        self.assertEqual(len(rows), len(lines) - 1)
        (self.folder / "results.build").write_text("another build")
        self.run_with("", "--resume")
        self.assertNotIn("crashed", {row["how"] for row in self.results()})


class Verdicts(Folder):
    def how(self, text, limit=2):
        return judges.run(judges.Judge("fake", self.script("judge", text), []), 1, limit).how

    def test_kinds(self):
        self.assertEqual(self.how("echo '[  PASSED  ] 1 test.'"), "lived")
        self.assertEqual(self.how("echo 'repeat with TRAMMEL_SEED=1'; exit 1"), "mismatch")
        self.assertEqual(self.how("echo 'another failure'; exit 1"), "failed")
        self.assertEqual(self.how("kill -ABRT $$"), "crashed")

    def test_no_test_is_no_pass(self):
        self.assertEqual(self.how("exit 0"), "failed")
        entry = json.loads((BUILD / "judges.json").read_text())[0]
        judge = judges.Judge(**{**entry, "arguments": ["--gtest_filter=NoSuchTest.*"]})
        with self.assertRaises(judges.SoundDesignRefused):
            judges.try_sound_design(judge)

    def test_a_hanging_run_ends(self):
        self.assertEqual(self.how("while :; do :; done", limit=1), "timed out")

    def test_the_mutant_is_chosen_by_its_number(self):
        self.assertEqual(self.how("[ $TRAMMEL_MUTANT = 1 ] && echo '[  PASSED  ] 1 test.'"), "lived")

    def test_the_limit_follows_the_sound_run(self):
        judge = judges.Judge("fake", self.script("judge", "echo '[  PASSED  ] 1 test.'"), [])
        judges.try_sound_design(judge)
        self.assertEqual(judge.limit(), 3)
        judge.seconds = 10
        self.assertEqual(judge.limit(), 52)

    def test_a_last_resort_runs_the_sound_design_when_it_is_asked(self):
        text = "[ $TRAMMEL_MUTANT = 0 ] && echo '[  PASSED  ] 1 test.'"
        sound = judges.Judge("sound", self.script("sound", text), ["a.sv"], last_resort=True)
        self.assertEqual(judges.try_mutant([sound], 1, "b.sv", False).how, "lived")
        self.assertIsNone(sound.seconds)
        self.assertEqual(judges.try_mutant([sound], 1, "a.sv", False).how, "failed")
        self.assertIsNotNone(sound.seconds)
        refuses = judges.Judge("refuses", self.script("refuses", "exit 1"), ["a.sv"], last_resort=True)
        with self.assertRaises(judges.SoundDesignRefused):
            judges.try_mutant([refuses], 1, "a.sv", False)

    def test_a_judge_that_refuses_the_sound_design_is_an_error(self):
        with self.assertRaises(judges.SoundDesignRefused):
            judges.try_sound_design(judges.Judge("fake", self.script("judge", "exit 1"), []))

    def test_only_judges_of_the_file_are_asked(self):
        never = judges.Judge("never", self.script("never", "exit 1"), ["b.sv"], seconds=0.0)
        own = judges.Judge("own", self.script("own", "exit 1"), ["a.sv"], seconds=0.0)
        self.assertEqual(judges.try_mutant([never, own], 1, "a.sv", False).judge, "own")
        self.assertEqual(judges.try_mutant([never, own], 1, "c.sv", False).how, "lived")
        own.last_resort = True
        self.assertEqual(judges.try_mutant([never, own], 1, "a.sv", False).judge, "own")
        self.assertEqual(judges.try_mutant([never, own], 1, "a.sv", True).how, "lived")


class Instrument(unittest.TestCase):
    def mutants(self, text):
        instrumenter = Instrumenter(text, "m.sv", 1)
        self.copy = instrumenter.run()
        return instrumenter.mutants

    def texts(self, body, declarations=""):
        return {m.mutated for m in self.mutants(f"module m;\n{declarations}\nalways_comb {body}\nendmodule\n")}

    def test_names_stay_when_lines_move(self):
        text = SOURCE.read_text()
        before, after = self.mutants(text), self.mutants("// a line\n" + text)
        self.assertEqual([m.id for m in before], [m.id for m in after])
        self.assertEqual([m.line + 1 for m in before], [m.line for m in after])
        self.assertEqual(len({m.id for m in before}), len(before))
        self.assertEqual(len({m.number for m in before}), len(before))

    def test_text_beyond_ascii_moves_nothing(self):
        self.mutants("// \u00b5s \u2265\n".encode().decode("latin-1") + "module m;\nassign a = b;\nendmodule\n")
        self.assertIn("? (~b) : (b)", self.copy)

    def test_operators(self):
        self.assertEqual(self.texts("x = a & b;"), {"", "x = a | b", "x = a", "x = b"})
        self.assertEqual(self.texts("x = a < b;"), {"", "x = a <= b", "x = a >= b"})
        self.assertEqual(self.texts("x = 4'd15;"), {"", "x = 4'd0", "x = 4'd14"})
        self.assertEqual(self.texts("x = 1'b1;"), {"", "x = 1'b0"})
        self.assertEqual(self.texts("x = '0;"), {"", "x = '1"})
        self.assertEqual(self.texts("x = ~a;"), {"", "x = a"})
        self.assertEqual(self.texts("x = v[1];", "logic [2:0] v;"), {"", "x = ~v[1]", "x = v[2]", "x = v[0]"})
        self.assertEqual(self.texts("x = v[2:1];", "logic [2:0] v;"), {"", "x = ~v[2:1]", "x = v[1:0]"})
        self.assertEqual(self.texts("if (a) x = y;"), {"", "x = ~y", "if (!(a))", "if (1'b0)", "if (1'b1)"})
        self.assertEqual(self.texts("x = c ? a : b;"),
                         {"", "x = !(c) ? a : b", "x = 1'b0 ? a : b", "x = 1'b1 ? a : b", "x = c ? ~a : b", "x = c ? a : ~b"})

    def test_labels_and_states(self):
        declarations = "typedef enum logic {A, B} e;\ne s;"
        self.assertEqual(self.texts("case (s) A: s = B; B: s = A; default: s = t; endcase", declarations),
                         {"", "s = A", "s = B", "s = ~t", "case label B, and A for B"})

    def test_connections(self):
        text = "module m;\nn u (.clk_i, .rst_i, .a_i(x), .q_o(y));\nendmodule\n"
        self.assertEqual({m.mutated for m in self.mutants(text)},
                         {"u: .rst_i('0)", "u: .rst_i('1)", "u: .a_i('0)", "u: .a_i('1)"})

    def test_a_registers_address_changes_by_a_word(self):
        self.assertEqual(self.texts("x = N + ADDR_TIME;", "localparam N = 2, ADDR_TIME = 12'h40;"),
                         {"", "x = N - ADDR_TIME", "x = N", "x = ADDR_TIME", "x = (N ^ 1'b1) + ADDR_TIME",
                          "x = N + (ADDR_TIME ^ 12'd4)"})
        self.assertEqual(self.texts("x = p::ADDR_TIME;"), {"", "x = (p::ADDR_TIME ^ 12'd4)"})
        self.assertEqual(self.texts("x = p::ADDR_TIME[11:2];"), {"", "x = (p::ADDR_TIME[11:2] ^ 1'b1)"})

    def test_constants_of_the_build_stay(self):
        self.assertEqual(self.texts("x = {2{a}};"), {"", "x = {2{~a}}"})
        self.assertEqual(self.texts("x = 4'(a);"), {"", "x = 4'(~a)"})
        text = ("module m #(parameter int N = f(3));\nfunction automatic int f(input int n); f = n + 1; endfunction\n"
                "logic [N-1:0] v;\nendmodule\n")
        self.assertEqual(self.mutants(text), [])


if __name__ == "__main__":
    unittest.main(verbosity=2)
