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
    ("scene/generate", "src/scene/generate/pitch.cpp", '"scene/tree/yaml_map.hpp"'),
    ("physics", "include/ergotic/physics/rates.hpp", '"physics/laws/oscillator.hpp"'),
    ("physics/laws", "src/physics/laws/oscillator.cpp", '"physics/layout/layout.hpp"'),
    ("scene/laws", "src/scene/laws/bow.cpp", '"physics/step_units.hpp"'),
    ("physics/network", "src/physics/network/network.cpp", '"physics/settling/steps.hpp"'),
    ("physics/layout/blocks", "src/physics/layout/blocks/blocks.cpp", '"physics/state/arena.hpp"'),
    ("physics/layout", "src/physics/layout/groups.cpp", '"physics/state/coefficients.hpp"'),
    ("physics/state", "src/physics/state/coefficients.cpp", '"physics/engine/mechanism.hpp"'),
    ("physics/engine", "src/physics/engine/energy_stable.cpp",
     '"ergotic/physics/certificate/certify.hpp"'),
    ("physics/certificate", "src/physics/certificate/certify.cpp", '"physics/settling/steps.hpp"'),
    ("physics/settling", "src/physics/settling/settle.cpp", '"ergotic/advice/noise.hpp"'),
    ("physics", "src/physics/rates.cpp", '"ergotic/tgr/rig.hpp"'),
    ("tgr", "src/tgr/rig.cpp", '"ergotic/physics/rates.hpp"'),
    ("tgr/drivers/comedi", "src/tgr/drivers/comedi/comedi_driver.cpp",
     '"ergotic/audio/jack_client.hpp"'),
    ("tgr", "src/tgr/rig.cpp", "<ros/console.h>"),
    ("station", "src/station/station.cpp", "<std_msgs/Bool.h>"),
    ("physics", "src/physics/rates.cpp", "<tf2/LinearMath/Quaternion.h>"),
    ("physics", "src/physics/rates.cpp", "</usr/include/jack/jack.h>"),
    ("tgr", "src/tgr/rig.cpp", "<comedilib.h>"),
    ("station", "src/station/station.cpp", "<jack/jack.h>"),
    ("audio", "src/audio/wav.cpp", '"ergotic/station/station.hpp"'),
    ("ros/device", "src/ros/device/hands.cpp", '"ros/interface/command_thread.hpp"'),
    ("ros/display", "src/ros/display/markers.cpp", '"ros/interface/publishers.hpp"'),
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
        for part in ("src", "include", "lab"):
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

    def test_refuses_includes_that_are_not_written_plainly(self):
        for line in ('#include "physics/laws/../engine/stepper.hpp"', '#define H "x"\n#include H',
                     '%:include "physics/engine/stepper.hpp"', '#include_next <ros/ros.h>',
                     '#import "physics/engine/stepper.hpp"', '#include "./x.hpp"'):
            with self.subTest(line=line):
                status, said = self.planted("src/physics/laws/oscillator.cpp", line)
                self.assertEqual((status, len(said)), (1, 1), said)
                self.assertIn("oscillator.cpp: write it plainly", said[0])

    def test_sees_includes_through_comments_and_continuations(self):
        header = '"physics/engine/stepper.hpp"'
        for line in (f"/* x */ #include {header}", f"#include /* x */ {header}",
                     f"#include \\\n{header}", f"#inc\\\nlude {header}", f"\f#include {header}"):
            with self.subTest(line=line):
                status, said = self.planted("src/physics/laws/oscillator.cpp", line)
                self.assertEqual((status, len(said)), (1, 1), said)
                self.assertIn("room physics/laws must not", said[0])

    def test_takes_no_comment_for_an_include(self):
        header = '#include "physics/engine/stepper.hpp"'
        for line in (f"// {header}", f"/*\n{header}\n*/", f'const char* const kText = R"(\n{header}\n)";'):
            with self.subTest(line=line):
                self.assertEqual(self.planted("src/physics/laws/oscillator.cpp", line), (0, []))

    def test_refuses_links_other_files_and_other_folders(self):
        (self.copy / "src/physics/laws/way").symlink_to("../engine")
        (self.copy / "src/physics/laws/more.inc").write_text("int a;")
        status, said = faults(self.copy)
        self.assertEqual(status, 1)
        self.assertIn("include gate: src/physics/laws/way is a link", said)
        self.assertIn("include gate: src/physics/laws/more.inc is neither .cpp nor .hpp", said)
        self.assertEqual(faults(self.copy / "src")[0], 1)

    def test_takes_what_is_below(self):
        self.assertEqual(self.planted("src/station/station.cpp", '#include "ergotic/tgr/rig.hpp"'), (0, []))

    def test_refuses_what_is_not_written_with_its_full_path(self):
        status, said = self.planted("src/tgr/rig.cpp", '#include "csv.hpp"')
        self.assertEqual((status, len(said)), (1, 1))
        self.assertIn('"csv.hpp" is no path', said[0])

    def test_refuses_a_room_that_nothing_includes_any_more(self):
        for path in (self.copy / "src/station", self.copy / "include/ergotic/station"):
            for file in path.glob("*pp"):
                file.write_text(file.read_text().replace('#include "ergotic/tgr/', "// "))
        self.assertEqual(faults(self.copy), (1, [
            "include gate: scripts/rooms.py: station may include tgr, but does not"]))

    def test_refuses_a_folder_that_is_no_room(self):
        (self.copy / "src/attic").mkdir()
        (self.copy / "src/attic/old.cpp").write_text('#include "ergotic/tgr/rig.hpp"\n')
        status, said = faults(self.copy)
        self.assertEqual((status, len(said)), (1, 1), said)
        self.assertIn("src/attic/old.cpp: is in no room", said[0])


if __name__ == "__main__":
    unittest.main()
