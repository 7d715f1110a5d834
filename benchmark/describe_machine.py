#!/usr/bin/python3
"""Writes what results were measured on as key,value rows: processor, what of it contact kernels use, compiler, date; no names of machines.

Usage: describe_machine.py OUT.csv BUILD_FOLDER
"""
import csv
import datetime
import os
import pathlib
import re
import subprocess
import sys

KERNEL_FLAGS = ("avx512f", "avx512dq", "avx512vl", "avx512bw", "avx2", "fma", "sse2")


def first_line(command):
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, universal_newlines=True)
    return done.stdout.splitlines()[0].strip() if done.stdout else "unknown"


def cpu_fields():
    fields = {}
    for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
        key, _, value = line.partition(":")
        fields.setdefault(key.strip(), value.strip())
    return fields


def cache_entry(build, name):
    found = re.search(r"^%s:\w+=(.*)$" % name, (build / "CMakeCache.txt").read_text(), re.MULTILINE)
    return found.group(1) if found and found.group(1) else ""


def os_name():
    found = re.search(r'^PRETTY_NAME="(.*)"$', pathlib.Path("/etc/os-release").read_text(), re.MULTILINE)
    return found.group(1) if found else "unknown"


def rows(build):
    cpu = cpu_fields()
    flags = cpu.get("flags", "").split()
    compiler = cache_entry(build, "CMAKE_CXX_COMPILER") or "c++"
    yield "processor", cpu.get("model name", "unknown")
    yield "family, model, stepping", ", ".join(cpu.get(key, "?") for key in ("cpu family", "model", "stepping"))
    yield "cores", os.cpu_count()
    yield "cache of one core", cpu.get("cache size", "unknown")
    yield "instruction sets asked for by the kernels, there", " ".join(flag for flag in KERNEL_FLAGS if flag in flags)
    yield "kernels forced", os.environ.get("BLEM_SIM_KERNELS") or "none, the fastest"
    yield "hypervisor", "yes" if "hypervisor" in flags else "no"
    yield "system", "%s, Linux %s" % (os_name(), os.uname().release.split("-")[0])
    yield "compiler", first_line([compiler, "--version"])
    yield "build type", cache_entry(build, "CMAKE_BUILD_TYPE") or "Release"
    yield "compiler flags beside the build type's", "-ffp-contract=off " + cache_entry(build, "CMAKE_CXX_FLAGS")
    yield "date", datetime.date.today().isoformat()
    yield "load average of the last minute, at the start", "%.1f" % os.getloadavg()[0]


def main(out, build):
    with open(out, "w") as stream:
        table = csv.writer(stream, lineterminator="\n")
        table.writerow(["what", "value"])
        table.writerows((key, str(value).strip()) for key, value in rows(pathlib.Path(build)))


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
