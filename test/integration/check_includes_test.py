#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""scripts/check_includes takes the program as it is, and refuses what is planted in a copy of it."""
import pathlib
import shutil
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]

# room, file in it, header that it must not include
FORBIDDEN = [
    ("rt", "include/ergotic/rt/clock.hpp", '"ergotic/scene/scene.hpp"'),
    ("scene", "include/ergotic/scene/scene.hpp", '"ergotic/scene/generate/pitch.hpp"'),
    ("scene/generate", "src/scene/generate/pitch.cpp", '"scene/yaml/yaml_map.hpp"'),
    ("physics", "include/ergotic/physics/rates.hpp", '"physics/laws/slopes.hpp"'),
    ("physics/laws", "src/physics/laws/slopes.cpp", '"physics/layout/layout.hpp"'),
    ("physics/network", "src/physics/network/chaplet.cpp", '"physics/settling/filters.hpp"'),
    ("physics/layout/blocks", "src/physics/layout/blocks/blocks.cpp", '"physics/state/arena.hpp"'),
    ("physics/layout", "src/physics/layout/groups.cpp", '"physics/state/coefficients.hpp"'),
    ("physics/state", "src/physics/state/coefficients.cpp", '"physics/engine/mechanism.hpp"'),
    ("physics/engine", "src/physics/engine/guarded.cpp",
     '"ergotic/physics/certificate/certify.hpp"'),
    ("physics/certificate", "src/physics/certificate/certify.cpp", '"physics/settling/filters.hpp"'),
    ("physics/settling", "src/physics/settling/settle.cpp", '"ergotic/advice/noise.hpp"'),
    ("physics", "src/physics/rates.cpp", '"ergotic/tgr/rig.hpp"'),
    ("tgr", "src/tgr/rig.cpp", '"ergotic/physics/rates.hpp"'),
    ("tgr/drivers/comedi", "src/tgr/drivers/comedi/comedi_driver.cpp",
     '"ergotic/audio/jack_client.hpp"'),
    ("tgr", "src/tgr/rig.cpp", "<ros/console.h>"),
    ("station", "src/station/station.cpp", "<std_msgs/Bool.h>"),
    ("station", "src/station/station.cpp", "<jack/jack.h>"),
    ("audio", "src/audio/wav.cpp", '"ergotic/station/station.hpp"'),
    ("ros/device", "src/ros/device/hands.cpp", '"ros/conversation/operator.hpp"'),
    ("ros/display", "src/ros/display/markers.cpp", '"ros/conversation/feed.hpp"'),
    ("ros", "src/ros/station_nodelet.cpp", '"tools/lib/report.hpp"'),
    ("ros", "src/ros/station_nodelet.cpp", "<jack/jack.h>"),
    ("tools/lib", "src/tools/lib/check.cpp", "<ros/console.h>"),
]


def faults(root):
    run = subprocess.run([ROOT / "scripts/check_includes", root], capture_output=True, text=True)
    return run.returncode, run.stderr.splitlines()


class CheckIncludesTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.copy = pathlib.Path(folder.name)
        for part in ("src", "include"):
            shutil.copytree(ROOT / part, self.copy / part)

    def planted(self, file, line):
        """What is said of a copy with one more line in a file."""
        path = self.copy / file
        text = path.read_text()
        path.write_text(text + line + "\n")
        said = faults(self.copy)
        path.write_text(text)
        return said

    def test_takes_the_program_as_it_is(self):
        self.assertEqual(faults(self.copy), (0, []))

    def test_refuses_what_is_above_and_what_must_not_be_known(self):
        for room, file, header in FORBIDDEN:
            with self.subTest(file=file, header=header):
                status, said = self.planted(file, f"#include {header}")
                self.assertEqual(status, 1)
                self.assertEqual(len(said), 1, said)
                self.assertIn(f"{file}: room {room} must not", said[0])
                self.assertIn(header, said[0])

    def test_takes_what_is_below(self):
        self.assertEqual(self.planted("src/station/station.cpp", '#include "ergotic/tgr/rig.hpp"'), (0, []))

    def test_refuses_what_is_not_written_with_its_full_path(self):
        status, said = self.planted("src/tgr/rig.cpp", '#include "csv.hpp"')
        self.assertEqual((status, len(said)), (1, 1))
        self.assertIn('"csv.hpp" is no path', said[0])

    def test_refuses_a_folder_that_is_no_room(self):
        (self.copy / "src/attic").mkdir()
        status, said = self.planted("src/station/station.cpp", "")
        self.assertEqual((status, said), (0, []))
        (self.copy / "src/attic/old.cpp").write_text('#include "ergotic/tgr/rig.hpp"\n')
        status, said = faults(self.copy)
        self.assertEqual((status, len(said)), (1, 1))
        self.assertIn("src/attic/old.cpp: is in no room", said[0])


if __name__ == "__main__":
    unittest.main()
