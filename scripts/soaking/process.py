# SPDX-License-Identifier: BSD-3-Clause
"""What a process is like: memory, descriptors, threads, processor time; and pauses of the machine."""
import json
import os
import pathlib
import time

PERIOD_S = 1.0


def look(pid):
    """One look at /proc. Memory in bytes, processor time in s."""
    folder = pathlib.Path(f"/proc/{pid}")
    status = dict(line.split(":", 1) for line in (folder / "status").read_text().splitlines())
    fields = (folder / "stat").read_text().rsplit(")", 1)[1].split()
    return {"time_ns": time.monotonic_ns(),
            "memory": 1024 * int(status["VmRSS"].split()[0]),
            "descriptors": len(os.listdir(folder / "fd")),
            "threads": int(status["Threads"]),
            "cpu_s": (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")}


def watch(pid, path, end):
    """Writes a look each second until `end` (time.monotonic, s), or until the process is gone and when that was seen."""
    with open(path, "w", encoding="utf-8") as file:
        while time.monotonic() < end:
            try:
                file.write(json.dumps(look(pid)) + "\n")
            except (FileNotFoundError, ProcessLookupError):
                file.write(json.dumps({"gone_ns": time.monotonic_ns()}) + "\n")
                return
            time.sleep(PERIOD_S)
