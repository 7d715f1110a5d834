"""scripts/support/own_races.py: which reports of the thread sanitizer are this project's own."""
import pathlib
import subprocess

SOURCE_DIR = pathlib.Path(__file__).resolve().parents[2]

REPORT = """==================
WARNING: ThreadSanitizer: data race (pid=1)
  Read of size 8 at 0x7b08 by main thread:
    #0 operator delete(void*) tsan_new_delete.cpp:126 (libtsan.so.2+0x1)
    #1 %s

  Previous write of size 8 at 0x7b08 by thread T1 (mutexes: write M1):
    #0 %s
    #1 callback /project/src/ros/loop.cpp:5 (libblem_sim_ros.so+0x5)

  Location is heap block of size 8 at 0x7b08 allocated by main thread:
    #0 malloc malloc.cpp:1 (libtsan.so.2+0x6)
    #1 make() <null> (libroscpp.so.4d+0x7)

  Thread T1 (tid=2, running) created by main thread at:
    #0 pthread_create interceptors.cpp:1 (libtsan.so.2+0x8)

SUMMARY: ThreadSanitizer: data race
==================
"""
OURS = "node::count() /project/src/ros/count.cpp:7 (libblem_sim_ros.so+0x2)"
HEADER = "std::copy() /usr/include/c++/12/bits/copy.h:3 (libblem_sim_ros.so+0x3)"
OTHERS = "ros::Publisher::write() <null> (libroscpp.so.4d+0x4)"


def verdict(tmp_path, *reports):
    (tmp_path / "race.1").write_text("".join(REPORT % report for report in reports))
    run = subprocess.run(["/usr/bin/python3", str(SOURCE_DIR / "scripts/support/own_races.py"), str(tmp_path), "/project"],
                         stdout=subprocess.PIPE, universal_newlines=True)
    return run.returncode, run.stdout.splitlines()[-1]


def test_a_race_of_two_own_stacks_is_own(tmp_path):
    assert verdict(tmp_path, (OURS, HEADER)) == (1, "1 own races, 0 reports of libraries without the sanitizer")


def test_a_stack_that_meets_another_library_first_is_not(tmp_path):
    assert verdict(tmp_path, (OURS, OTHERS), (OTHERS, OURS)) == (0, "0 own races, 2 reports of libraries without the sanitizer")


def test_own_races_are_told_beside_many_of_others(tmp_path):
    status, said = verdict(tmp_path, (OTHERS, OURS), (OURS, OURS), (OURS, OURS))
    assert status == 1
    assert said == "1 own races, 1 reports of libraries without the sanitizer"


def test_no_report_passes(tmp_path):
    assert verdict(tmp_path) == (0, "0 own races, 0 reports of libraries without the sanitizer")
