"""What blem_sim_run tells of long loads, on the standard error stream."""
import array
import pathlib
import re
import sys
import unittest

sys.path.insert(0, __file__.rsplit("/", 1)[0])
from run_scene import RunCase  # noqa: E402

TRIANGLES = 3000000  # longer than a second on any machine
SCENE = "contact: {mend_meshes: false}\nenvironments:\n  - {name: strip, uri: strip.ply}\n"


def strip_ply(width):
    """A strip of triangles, each with the two vertices before it; of no area for width 0."""
    vertices = array.array("f", bytes(12 * (TRIANGLES + 2)))
    vertices[0::3] = array.array("f", (0.01 * k for k in range(TRIANGLES + 2)))
    vertices[1::3] = array.array("f", [0, width]) * (TRIANGLES // 2 + 1)
    faces = array.array("i", [3]) * (4 * TRIANGLES)
    for corner in range(3):
        faces[corner + 1::4] = array.array("i", range(corner, corner + TRIANGLES))
    header = ("ply\nformat binary_%s_endian 1.0\nelement vertex %d\nproperty float x\nproperty float y\nproperty float z\n"
              "element face %d\nproperty list int int vertex_indices\nend_header\n")
    return (header % (sys.byteorder, TRIANGLES + 2, TRIANGLES)).encode() + vertices.tobytes() + faces.tobytes()


class LoadProgressTest(RunCase):

    def lines_of(self, width, returncode, *arguments):
        pathlib.Path(self.folder, "strip.ply").write_bytes(strip_ply(width))
        done = self.run_program(self.write("long.yaml", SCENE), "--duration", 0.001, *arguments)
        self.assertEqual(done.returncode, returncode, done.stderr)
        return done.stderr.splitlines()

    def test_a_long_load_tells_its_stages_and_its_size(self):
        lines = self.lines_of(0.01, 0)
        progress = r"blem_sim_run: loading strip: (reading|cleaning|topology and tree of) strip\S*, \d+ % done, \d+\.\d s so far"
        self.assertGreaterEqual(len(lines), 2)
        for line in lines[:-1]:
            self.assertRegex(line, progress)
        told = re.fullmatch(r"blem_sim_run: loaded strip: 3000000 triangles, (\d+\.\d) MB, (\d+\.\d) s", lines[-1])
        self.assertTrue(told, lines[-1])
        # A strip has as many vertices as triangles, and two edges to each.
        self.assertLess(float(told.group(1)) * 1e6 / TRIANGLES, 105)
        self.assertGreaterEqual(float(told.group(2)), 1)

    def test_the_runs_of_a_batch_load_once(self):
        self.write("runs.jsonl", "{}\n" + '{"config": "none.yaml"}\n' + "{}\n")
        lines = self.lines_of(0.01, 2, "--batch", "runs.jsonl")
        self.assertEqual(len([line for line in lines if line.startswith("blem_sim_run: loaded strip: ")]), 1, lines)

    def test_one_that_fails_ends_with_the_reason(self):
        lines = self.lines_of(0, 2)
        for line in lines[:-1]:
            self.assertRegex(line, "blem_sim_run: loading strip: ")
        self.assertRegex(lines[-1], r"blem_sim_run: environments: strip: .*strip\.ply: .*without area")


if __name__ == "__main__":
    unittest.main()
