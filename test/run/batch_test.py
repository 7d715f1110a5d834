"""--batch: many runs in one process, each as if it were alone."""
import json
import os
import pathlib
import random
import re
import signal
import subprocess
import sys
import time
import unittest

sys.path.insert(0, __file__.rsplit("/", 1)[0])
from run_scene import RunCase, arm_urdf  # noqa: E402

NOT_FINITE = {"set": {"time_step": 1e8}, "duration": 1e9}
REFUSED = {"set": {"contact.frction": 1}, "duration": 0.01}
# Steps of which depend on ODE's random numbers.
QUICK = {"set": {"solver.stepper": "quick_step", "objects.0.pose.xyz": [0.1, 0, 0.16]}, "duration": 0.1}


LINE = '{"name": "\\u00e4", "seed": 2, "duration": 0.0, "set": {"gravity": [0, 0, -1.5e0]}, "stop": ["a=1"]}'
PARTS = ["{", "}", "[", "]", ",", ":", '"', "\\", "\\u", "null", "true", "NaN", "1e9", "-", "0", ".", "\u00e9", "\t", "\r", "\0", " "]


def damaged(line, dice):
    letters = list(line)
    for _ in range(dice.randint(0, 4)):
        place = dice.randrange(len(letters) + 1)
        letters[place:place + dice.randint(0, 2)] = dice.choice(PARTS)
    return "".join(letters)


def is_json(line):
    """Whether Python reads it, keys given twice refused as well."""
    def pairs(members):
        if len({key for key, _ in members}) < len(members):
            raise ValueError("twice")
        return dict(members)

    def constant(word):
        raise ValueError(word)

    try:
        json.loads(line, object_pairs_hook=pairs, parse_constant=constant)
    except ValueError:
        return False
    return True


class BatchCase(RunCase):

    def batch(self, lines, *arguments, config=("world.yaml",)):
        """Exit status, results and lines of the error stream of runs; text stands in the file as it is."""
        text = lines if isinstance(lines, str) else "".join(json.dumps(line) + "\n" for line in lines)
        (self.folder / "runs.jsonl").write_bytes(text.encode())
        done = self.run_program(*config, "--batch", "runs.jsonl", *arguments)
        return done.returncode, self.results(done.stdout), done.stderr.splitlines()

    def results(self, text):
        self.assertTrue(text.endswith("\n") or not text)
        return [json.loads(line, parse_constant=lambda word: self.fail("%s in a result" % word)) for line in text.splitlines()]

    def errors(self, lines, *arguments, config=("world.yaml",)):
        """Errors of the runs of which there are any; all of them are told on the error stream, too."""
        status, results, told = self.batch(lines, "--duration", 0.002, *arguments, config=config)
        errors = [result for result in results if "error" in result]
        self.assertEqual(told, ["blem_sim_run: %s: %s" % (result["name"], result["error"]) for result in errors])
        self.assertEqual(status, 2)
        return [result["error"] for result in errors]

    def alone(self, line, name="alone"):
        """Report of the same run in a process of its own."""
        arguments = []
        for key, value in line.items():
            if key in ("set", "stop"):
                for pair in value.items():
                    arguments += ["--" + key, "%s=%s" % (pair[0], pair[1] if isinstance(pair[1], str) else json.dumps(pair[1]))]
            elif key not in ("name", "config"):
                arguments += ["--" + key.replace("_", "-"), value]
        done = self.run_program(line.get("config", "world.yaml"), *arguments, "--report", "%s.json" % name)
        self.assertIn(done.returncode, (0, 3), done.stderr)
        return json.loads((self.folder / ("%s.json" % name)).read_text())


class BatchTest(BatchCase):

    def test_each_run_has_the_bits_that_it_has_alone(self):
        self.write("light.yaml", (self.folder / "world.yaml").read_text().replace("mass: 1,", "mass: 0.25,"))
        lines = [QUICK, {"duration": 0.1, "seed": 3}, NOT_FINITE, {"duration": 0.1, "seed": 3}, REFUSED, QUICK,
                 {"config": "light.yaml", "duration": 0.1}, {"duration": 0.1, "trajectory": "motion.csv", "save_state": "half.state"},
                 {"duration": 0.1, "load_state": "half.state"}, {"duration": 9, "stop": {"late": "time > 0.03", "soon": "cube::link.z < 0.079"}},
                 {"duration": 0.1, "set": {"contact.mend_meshes": False, "objects": []}}, {"duration": 0.1, "seed": 3}, QUICK]
        status, results, _ = self.batch(lines)
        self.assertEqual((status, len(results)), (2, len(lines)))
        for number, (line, result) in enumerate(zip(lines, results), 1):
            self.assertEqual(result["name"], "run_%d" % number)
            if line is REFUSED:
                self.assertEqual(set(result), {"name", "error"})
                continue
            alone = self.alone(line)
            for key in set(alone) - {"cpu_s", "wall_s", "real_time_factor", "profile_ms"}:
                self.assertEqual(result[key], alone[key], "%s of line %d" % (key, number))
            self.assertEqual(set(result) - set(alone), {"name"})
        self.assertEqual(results[9]["stopped"]["name"], "soon")
        self.assertNotEqual(results[0]["state_hash"], results[1]["state_hash"])

    def test_options_hold_for_all_runs_and_lines_are_stronger(self):
        status, results, told = self.batch(
            [{}, {"name": "b", "duration": 0.02, "set": {"objects.0.mass": 3}, "seed": 5}, {"stop": ["first=time > 0.005"]}],
            "--duration", 0.03, "--set", "objects.0.mass=2", "--seed", 4, "--stop", "never=time > 9")
        self.assertEqual((status, told), (0, []))
        self.assertEqual([(run["name"], run["steps"]) for run in results], [("run_1", 30), ("b", 20), ("run_3", 6)])
        self.assertEqual(results[0]["state_hash"], self.alone({"duration": 0.03, "set": {"objects.0.mass": 2}, "seed": 4})["state_hash"])
        self.assertEqual(results[1]["state_hash"], self.alone({"duration": 0.02, "set": {"objects.0.mass": 3}, "seed": 5})["state_hash"])
        self.assertEqual(results[2]["stopped"]["name"], "first")
        status, results, _ = self.batch([{"config": "world.yaml", "duration": 0.01}], config=())
        self.assertEqual((status, results[0]["steps"]), (0, 10))

    def test_exit_status(self):
        short = {"duration": 0.001}
        self.assertEqual(self.batch([short, short])[0], 0)
        status, results, told = self.batch([short, NOT_FINITE, short])
        self.assertEqual((status, results[1]["status"]["STATE_NOT_FINITE"], len(told)), (3, 1, 1))
        self.assertRegex(told[0], "^blem_sim_run: run_2: the state stopped being finite at t = ")
        self.assertEqual(self.batch([NOT_FINITE, REFUSED, short])[0], 2)
        self.assertEqual(self.batch([REFUSED, NOT_FINITE])[0], 2)

    def test_tables_and_reports(self):
        run = {"duration": 0.05, "csv": "a.csv", "csv_rate": 200, "stats_from": 0.02}
        status, results, told = self.batch([dict(run, report="a.json"), {"duration": 0.001, "csv": "/dev/null"},
                                            {"duration": 0.001, "csv": "/dev/null"}])
        self.assertEqual((status, told), (0, []))
        report = json.loads((self.folder / "a.json").read_text())
        self.assertEqual(report, results[0])
        table = (self.folder / "a.csv").read_text()
        alone = self.alone(run)
        self.assertEqual((table, report["sensors"]), ((self.folder / "a.csv").read_text(), alone["sensors"]))
        self.assertEqual(len(table.splitlines()), 11)

    def test_results_go_to_a_file(self):
        status, results, told = self.batch([{"duration": 0.001}, REFUSED], "--report", "all.jsonl")
        self.assertEqual((status, results, len(told)), (2, [], 1))
        self.assertEqual([len(result) > 2 for result in self.results((self.folder / "all.jsonl").read_text())], [True, False])
        self.assertIn("nowhere/r", self.whole_refusal("{}", "--report", "nowhere/r"))
        self.assertIn("/dev/full: results could not all be written", self.whole_refusal("{}", "--duration", 0.001, "--report", "/dev/full"))

    def whole_refusal(self, text, *arguments):
        self.write("runs.jsonl", text)
        return self.refusal("world.yaml", "--batch", "runs.jsonl", *arguments)


class BatchFileTest(BatchCase):

    def test_lines_as_editors_and_programs_write_them(self):
        text = '\ufeff{"name": "a"}\r\n\t{ "name" :"\\u00fc\\ud83d\\ude00\\"\\/\\n" , "seed":1 } \r\n{"name": "c", "set": {"gravity": [0, 0, -1.62E+0]}}'
        status, results, told = self.batch(text, "--duration", 0.001)
        self.assertEqual((status, told), (0, []))
        self.assertEqual([run["name"] for run in results], ["a", "\u00fc\U0001f600\"/\n", "c"])
        self.assertEqual(results[2]["state_hash"], self.alone({"duration": 0.001, "set": {"gravity": [0, 0, -1.62]}})["state_hash"])

    def test_malformed_lines_are_refused_and_the_others_run(self):
        for line, words in (
            ('{"seed": 1,}', "a comma before '}'; take it out"),
            ('{"set": {"a": [1, 2,]}}', "a comma before ']'; take it out"),
            ('{"seed": 1, "seed": 2}', "the key 'seed' is given twice; keep one"),
            ('{"set": {"a": 1, "a": 2}}', "the key 'a' is given twice"),
            ("{'seed': 1}", "a key in double quotes is expected, not '''"),
            ('{seed: 1}', "a key in double quotes is expected, not 's'"),
            ('{"seed" 1}', "':' behind the key 'seed' is expected, not '1'"),
            ('{"seed": 1 "name": "a"}', "',' or '}' is expected, not '\"'"),
            ('{"seed": }', "a value is expected, not '}'"),
            ('{"seed": 1', "the line ends where ',' or '}' is expected"),
            ('{"name": "a', "the line ends inside a string"),
            ('{"seed": 1} {"seed": 2}', "more than one value; give each a line of its own"),
            ('{"duration": NaN}', "'NaN' is no JSON"),
            ('{"seed": None}', "'None' is no JSON"),
            ('{"seed": 01}', "'01' is no JSON"),
            ('{"duration": .5}', "'.5' is no JSON"),
            ('{"duration": 1.}', "'1.' is no JSON"),
            ('{"duration": 1e}', "'1e' is no JSON"),
            ('{"seed": 1} # first', "more than one value"),
            ('{"name": "\\x"}', "a backslash that escapes nothing"),
            ('{"name": "\\u12"}', "four hexadecimal digits"),
            ('{"name": "\\ud800"}', "half a character"),
            ('{"name": "\\u0000"}', "take it out"),
            ('{"name": "a\tb"}', "a control character in a string"),
            ('{"set": {"a": ' + "[" * 200000, "nested more than 100 deep"),
            ("", "is empty; take the line out, or write {}"),
            ("  ", "is empty; take the line out, or write {}"),
            ("[1]", "is a list; write an object"),
            ("null", "is null; write an object"),
        ):
            errors = self.errors('{}\n%s\n{}\n' % line)
            self.assertEqual(len(errors), 1, line)
            self.assertIn("runs.jsonl:2: ", errors[0])
            self.assertIn(words, errors[0])

    def test_damaged_lines_are_read_as_json_is(self):
        dice = random.Random(3)
        lines = [damaged(LINE, dice) for _ in range(1000)]
        _, results, told = self.batch("".join(line + "\n" for line in lines), "--duration", 0)
        self.assertEqual(len(results), len(lines))
        self.assertEqual(len(told), len([result for result in results if "error" in result]))
        for line, result in zip(lines, results):
            self.assertEqual(re.match(r"runs\.jsonl:\d+: letter", result.get("error", "")) is None, is_json(line), (line, result.get("error")))
        self.assertGreater(len([line for line in lines if is_json(line)]), 100)

    def test_fields(self):
        for line, words in (
            ({"duraton": 1}, "'duraton' is unknown; the nearest known key is 'duration'"),
            ({"duration": "1"}, "duration: must be a number, not a string"),
            ({"duration": -1}, "duration: '-1' is not a number of at least 0"),
            ({"seed": 1.5}, "seed: '1.5' is not a whole number"),
            ({"seed": True}, "seed: must be a number, not true or false"),
            ({"csv": None}, "csv: must be a string, not null; leave the key out"),
            ({"csv": ""}, "csv: its value is empty"),
            ({"name": ""}, "name: its value is empty"),
            ({"name": 1}, "name: must be a string, not a number"),
            ({"set": ["a=1"]}, "set: must be an object, not a list"),
            ({"set": {"": 1}}, "set: a key is empty"),
            ({"stop": "a=1"}, "stop: must be an object, not a string"),
            ({"stop": {"a": 1}}, "stop: a: must be a string, not a number"),
            ({"stop": [1]}, "stop: must be a string, not a number"),
            ({"stop": ["time"]}, "stop: 'time' is not NAME=VALUE"),
            ({"name": "taken"}, "name: 'taken' is the name of line 1"),
            ({"csv": "./taken.csv"}, "csv: ./taken.csv is written by line 1; give another file"),
            ({"report": "../%s/taken.csv" % self.folder.name}, "is written by line 1; give another file"),
            ({"csv": "x", "save_state": "x"}, "save_state: x is written by line 2; give another file"),
            ({"report": "runs.jsonl"}, "report: runs.jsonl is the batch itself; give another file"),
            ({"csv": "all.jsonl"}, "csv: all.jsonl is where the results go; give another file"),
        ):
            status, results, told = self.batch([{"name": "taken", "csv": "taken.csv"}, line], "--duration", 0.001, "--report", "all.jsonl")
            self.assertEqual((status, results, len(told)), (2, [], 1), line)
            self.assertIn(": runs.jsonl:2: ", told[0])
            self.assertIn(words, told[0])
        self.assertEqual(self.errors([{}], config=()), ["runs.jsonl:1: config is missing; give it here, or CONFIG.yaml on the command line"])

    def test_a_run_is_refused_in_the_words_of_a_single_one(self):
        self.write("broken.urdf", arm_urdf(mass=-1))
        for line, arguments in (
            (REFUSED, ["--set", "contact.frction=1"]),
            ({"set": {"robots.0.urdf": "broken.urdf"}}, ["--set", "robots.0.urdf=broken.urdf"]),
            ({"set": {"objects.0.uri": "none.off"}}, ["--set", "objects.0.uri=none.off"]),
            ({"stop": {"a": "cube.z"}}, ["--stop", "a=cube.z"]),
            ({"trajectory": "none.csv"}, ["--trajectory", "none.csv"]),
            ({"load_state": "none.state"}, ["--load-state", "none.state"]),
            ({"csv": "nowhere/a.csv"}, ["--csv", "nowhere/a.csv"]),
        ):
            self.assertEqual(["blem_sim_run: " + error for error in self.errors([{}, line, {}])],
                             [self.refusal("world.yaml", "--duration", 0.01, *arguments)])

    def test_bytes_that_are_no_utf8(self):
        (self.folder / "latin.yaml").write_bytes(b"gravit\xe4t: 1\n")
        (self.folder / "runs.jsonl").write_bytes(b'{"config": "latin.yaml"}\n{"name": "\xff"}\n')
        done = subprocess.run([self.program, "--batch", "runs.jsonl"], cwd=str(self.folder), stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        errors = [result["error"] for result in self.results(done.stdout.decode())]
        self.assertIn("gravit\ufffdt: unknown key", errors[0])
        self.assertIn("runs.jsonl:2: letter 11: a byte that is no UTF-8", errors[1])

    def test_files_that_are_no_batch_are_refused_as_a_whole(self):
        for name, words in (("none.jsonl", "none.jsonl: cannot be read; check the path"), (".", ".: is a folder"),
                            ("empty.jsonl", "empty.jsonl: is empty; write a JSON object for each run on a line"),
                            ("world.yaml", "world.yaml:1: is empty; "), ("cube.off", "cube.off:1: letter 1: 'OFF' is no JSON"),
                            ("list.jsonl", "list.jsonl:1: is a list"), ("/dev/zero", "has more than 64 MB")):
            self.write("empty.jsonl", "")
            self.write("list.jsonl", '[{"seed": 1}]')
            self.assertIn(words, self.refusal("world.yaml", "--batch", name))
        self.assertIn("each line of a batch is a JSON object", self.refusal("world.yaml", "--batch", "cube.off"))
        self.write("runs.jsonl", "{}")
        self.assertIn("--report: ./runs.jsonl is the batch itself", self.refusal("world.yaml", "--batch", "runs.jsonl", "--report", "./runs.jsonl"))
        self.assertEqual((self.folder / "runs.jsonl").read_text(), "{}")
        for option, key in (("--csv", "csv"), ("--save-state", "save_state")):
            self.assertIn("give %s in the lines of runs.jsonl" % key, self.refusal("world.yaml", "--batch", "runs.jsonl", option, "x"))


class InterruptionTest(BatchCase):

    def interrupted(self, number):
        """Results of three runs, the first refused, of which the second one gets a signal, and its table."""
        self.write("runs.jsonl", json.dumps(REFUSED) + '\n{"duration": 1e6, "csv": "long.csv", "save_state": "long.state"}\n{"csv": "third.csv"}\n')
        process = subprocess.Popen([self.program, "world.yaml", "--batch", "runs.jsonl", "--report", "all.jsonl"], cwd=str(self.folder),
                                   stderr=subprocess.PIPE, universal_newlines=True,
                                   preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.kill)
        table = pathlib.Path(self.folder, "long.csv")
        end = time.time() + 60
        while not (table.exists() and table.stat().st_size > 100000) and time.time() < end:
            time.sleep(0.01)
        self.assertIn("error", self.results((self.folder / "all.jsonl").read_text())[0], "the first result is there while the second run goes on")
        process.send_signal(number)
        self.assertEqual((process.wait(60), process.stderr.read().count("\n")), (-number, 1))
        return self.results((self.folder / "all.jsonl").read_text()), table.read_text()

    def test_a_signal_ends_the_run_after_its_step_and_then_the_batch(self):
        for number in (signal.SIGTERM, signal.SIGINT):
            results, table = self.interrupted(number)
            self.assertEqual([(run["name"], run.get("interrupted")) for run in results], [("run_1", None), ("run_2", number.name)])
            rows = table.splitlines()
            self.assertEqual((len(rows) - 1, table[-1]), (results[1]["steps"] // 10, "\n"))
            self.assertEqual({row.count(",") for row in rows}, {rows[0].count(",")})
            self.assertEqual([os.path.exists(str(self.folder / name)) for name in ("long.state", "third.csv")], [False, False])
            (self.folder / "long.csv").unlink()


if __name__ == "__main__":
    unittest.main()
