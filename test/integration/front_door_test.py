#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What scripts/station understands, and how it chooses among settings of the sound."""
import datetime
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import threading
import unittest
import xmlrpc.server

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
import front_door  # noqa: E402
import sound_setting  # noqa: E402
from sound_setting import Result  # noqa: E402


def station(*words, root=ROOT):
    done = subprocess.run([root / "scripts/station", *words], text=True, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL, check=False)
    return done.returncode, done.stdout


class WithFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(suffix=" it's a folder")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def write(self, name, text=""):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
        return str(path)


class NameTest(unittest.TestCase):
    """A master that knows one node, and that node, which may be gone."""

    def serve(self, **calls):
        server = xmlrpc.server.SimpleXMLRPCServer(("127.0.0.1", 0), logRequests=False)
        self.addCleanup(server.server_close)
        for name, call in calls.items():
            server.register_function(call, name)
        threading.Thread(target=server.serve_forever, daemon=True).start()
        self.addCleanup(server.shutdown)
        return f"http://127.0.0.1:{server.server_address[1]}"

    def master(self, node, address):
        return self.serve(lookupNode=lambda _, name: (1, "", address) if name == node else (-1, "unknown", ""))

    def test_of_a_station_that_runs_is_refused(self):
        node = self.serve(getPid=lambda _: (1, "", 42))
        environment = {"ROS_MASTER_URI": self.master("/station", node)}
        with self.assertRaises(front_door.Refusal) as refused:
            front_door.expect_free("station", environment)
        self.assertIn("a station called station runs already", str(refused.exception))
        self.assertIn("name:=second", str(refused.exception))
        front_door.expect_free("second", environment)
        front_door.expect_free("station", {**environment, "ROS_NAMESPACE": "hall"})
        self.assertRaises(front_door.Refusal, front_door.expect_free, "station",
                          {"ROS_MASTER_URI": self.master("/hall/station", node), "ROS_NAMESPACE": "/hall/"})

    def test_is_free_where_the_node_or_the_master_is_gone(self):
        gone = "http://127.0.0.1:9"  # nobody listens there
        front_door.expect_free("station", {"ROS_MASTER_URI": self.master("/station", gone)})
        front_door.expect_free("station", {"ROS_MASTER_URI": gone})


class InstrumentsTest(WithFolder):
    def test_the_list_has_a_line_for_each_instrument(self):
        (self.folder / "scripts").mkdir()  # a clone of which nothing else is needed
        for name in ("station", "lib.sh", "front_door.py"):
            shutil.copy(ROOT / "scripts" / name, self.folder / "scripts")
        shutil.copytree(ROOT / "models", self.folder / "models")
        status, said = station("--list", root=self.folder)
        self.assertEqual(status, 0)
        lines = said.splitlines()
        self.assertEqual([line.split()[0] for line in lines], list(front_door.instruments()))
        self.assertIn("string          The default instrument: one string at 110 Hz under two keys", lines)
        for line in lines:
            self.assertGreater(len(line.split()), 3, line)
            self.assertLessEqual(len(line), 100)

    def test_scenes_for_measurements_are_no_instruments(self):
        self.assertNotIn("lib_truths", front_door.instruments())

    def test_a_description_is_what_the_scene_says_of_itself(self):
        for about, told in (('about: {title: A gong, description: "It glides: up. Then down."}', "It glides: up"),
                            ("about:\n  title: A gong\n\n  licence: MIT\nsections: {a: {}}", "A gong"),
                            ("about: {description: >-\n  no YAML", "A comment: of\n# two lines")):
            scene = f"# SPDX-License-Identifier: MIT\n# A comment: of\n# two lines. More.\n{about}\nmats: [broken"
            self.assertEqual(front_door.description(scene), " ".join(told.replace("#", "").split()), about)

    def test_else_it_is_the_first_sentence_of_its_comment(self):
        for scene, told in (("# SPDX-License-Identifier: MIT\n# One at 1.5 kHz. Two.\nergotic: 1\n", "One at 1.5 kHz"),
                            ("# yaml-language-server: $schema=x\n\n# One\n# line\n\n# Other\n", "One line"),
                            ("ergotic: 1\n# A remark.\n", ""), ("", "")):
            self.assertEqual(front_door.description(scene), told)

    def test_a_misspelt_name_is_answered_with_the_nearest(self):
        for name, meant in (("drumm", "drum"), ("Strnig", "string"), ("fretted-string", "fretted_string")):
            status, said = station(name)
            self.assertEqual(status, 1)
            self.assertIn(f"there is no instrument {name}, did you mean {meant}?", said)
            self.assertIn("scripts/station --list", said)
        status, said = station("xyzzy")
        self.assertEqual(status, 1)
        self.assertNotIn("did you mean", said)
        self.assertIn("scripts/station --list", said)


class ArgumentsTest(WithFolder):
    known = front_door.known_arguments()

    def meant(self, *words, **environment):
        return front_door.arguments_of(words, str(self.folder), environment, front_door.instruments(), self.known)

    def refusal(self, *words):
        with self.assertRaises(front_door.Refusal) as refused:
            self.meant(*words)
        return str(refused.exception)

    def test_a_name_means_the_shipped_scene(self):
        self.write("drum", "a file of the same name")
        self.assertEqual(self.meant("drum")[0]["model"], str(ROOT / "models/drum.yaml"))
        self.assertEqual(self.meant("drum#soft")[0]["model"], str(ROOT / "models/drum.yaml#soft"))
        self.assertNotIn("model", self.meant()[0])

    def test_paths_start_where_they_are_typed(self):
        scene = self.write("sub folder/my 'own'.yaml")
        for word in ("sub folder/my 'own'.yaml", scene):
            self.assertEqual(self.meant(word)[0]["model"], scene)
            self.assertEqual(self.meant(f"model:={word}")[0]["model"], scene)
            self.assertEqual(self.meant(f"{word}#variant")[0]["model"], f"{scene}#variant")
        for name in ("device", "gesture", "end_effectors"):
            self.assertEqual(self.meant(f"{name}:=sub folder/my 'own'.yaml")[0][name], scene)
        self.assertEqual(self.meant("record:=a take")[0]["record"], f"{self.folder}/a take")
        settings = self.meant("driver:=replay", "driver_settings:={file: a 'b'.csv, rate: 1e-3}")[0]
        self.assertEqual(settings["driver_settings"],
                         "{file: '" + f"{self.folder}/a 'b'.csv".replace("'", "''") + "', rate: 1e-3}")
        self.assertIn(f"{self.folder}/x.yaml".replace("'", "''"),
                      self.meant("parameters:={model: x.yaml, frozen: 0}")[0]["parameters"])

    def test_the_home_folder_is_known(self):
        self.assertEqual(front_door.absolute("~/x", "/y"), os.path.expanduser("~/x"))

    def test_texts_are_no_paths(self):
        text = "devices:\n- {driver: comedi}\n"
        self.assertEqual(self.meant(f"device:={text}")[0]["device"], text)

    def test_empty_values_stay_empty(self):
        self.assertEqual(self.meant("model:=", "record:=")[0]["model"], "")

    def test_what_is_not_there_is_said_before_anything_starts(self):
        for words, told in ((["x.yaml"], f"there is no scene file {self.folder}/x.yaml"),
                            (["drum.yaml"], "`scripts/station drum` plays the shipped one"),
                            (["gesture:=g.csv"], f"gesture: there is no file {self.folder}/g.csv"),
                            (["record:=no/take"], f"record: there is no folder {self.folder}/no")):
            self.assertIn(told, self.refusal(*words))

    def test_misspelt_arguments_are_answered_with_what_to_write(self):
        for words, told in ((["force_limt:=5"], "did you mean force_limit?"),
                            (["force_limit=5"], "force_limit:=5"), (["gestur:x.csv"], "gesture:=x.csv"),
                            (["--lst"], "did you mean --list?"), (["drum", "--tune"], "--tune stands first"),
                            (["drum", "string"], "two instruments, drum and string"),
                            (["drum", "model:=string"], "allowed: one of them"),
                            (["xyzzyxyzzy:=1"], "it has: model, device"),
                            (["name:=2nd"], "name is 2nd, allowed: letters, digits and _, a letter first"),
                            (["name:=a/b"], "name is a/b"), (["name:="], "name is ")):
            self.assertIn(told, self.refusal(*words))

    def test_a_shell_reads_them_as_they_are(self):
        for text in ("it's \"a\" take", "$(false) `false` \\ * #", "two\nlines", "ends with a blank "):
            line = front_door.in_shell({"record": text, "jack": "none"}, True)
            script = 'eval "$1"; printf "%s\\0" "${arguments[@]}" "$is_simulated"'
            read = subprocess.run(["bash", "-c", script, "-", line], stdout=subprocess.PIPE, text=True,
                                  check=True).stdout.split("\0")[:-1]
            self.assertEqual(read, [f"record:={text}", "jack:=none", "true"])
        self.assertTrue(front_door.in_shell({}, True).endswith(" name=station"))
        self.assertTrue(front_door.in_shell({"name": "left"}, True).endswith(" name=left"))

    def test_force_comes_by_itself_only_where_no_hand_is(self):
        virtual = self.write("virtual.yaml", "devices: [{driver: virtual}, {driver: virtual}]")
        mixed = self.write("mixed.yaml", "devices: [{driver: virtual}, {driver: comedi}]")
        silent = self.write("silent.yaml", "devices: [{settings: {}}]")
        broken = self.write("broken.yaml", "devices: [")
        for words, simulated in (((), True), (("drum",), True), (("driver:=virtual",), True),
                                 ((f"device:={virtual}",), True), (("parameters:={frozen: 0}",), True),
                                 (("driver:=comedi",), False), (("driver:=my/driver",), False),
                                 ((f"device:={mixed}",), False), ((f"device:={silent}",), False),
                                 ((f"device:={broken}",), False), (("parameters:={driver: jack}",), False),
                                 ((f"parameters:={{device: '{mixed}'}}".replace("it's", "it''s"),), False),
                                 ((f"device:={virtual}", "parameters:={device: '', driver: jack}"), False),
                                 (("parameters:=[",), False), (("device:=devices:\n- {driver: jack}\n",), False)):
            given, told = self.meant(*words)
            self.assertEqual((told, given.get("autoengage")), (simulated, "true" if simulated else None), words)
            self.assertEqual(given.get("force_after_swap"), "always" if simulated else None, words)
        self.assertEqual(self.meant("autoengage:=false")[0]["autoengage"], "false")

    def test_a_scene_with_hands_of_its_own_gets_them_at_a_simulated_device(self):
        meant = self.meant("drum")[0]
        self.assertTrue(meant["end_effectors"].endswith("models/hands/drum.yaml"))
        self.assertNotIn("end_effectors", self.meant("string")[0])
        self.assertNotIn("end_effectors", self.meant("drum", "driver:=comedi")[0])
        self.write("mine.yaml")
        self.assertTrue(self.meant("drum", "end_effectors:=mine.yaml")[0]["end_effectors"].endswith("mine.yaml"))

    def test_there_is_a_window_where_there_is_a_display(self):
        self.assertEqual(self.meant(DISPLAY=":0")[0]["rviz"], "true")
        self.assertEqual(self.meant()[0]["rviz"], "false")
        self.assertEqual(self.meant("rviz:=false", DISPLAY=":0")[0]["rviz"], "false")

    def test_the_greeting_says_what_to_do(self):
        self.assertIn("Drag", front_door.greeting("drum", True, True, True))
        self.assertIn("gesture:=", front_door.greeting("drum", False, True, True))
        for simulated in (True, False):
            self.assertIn("/station/engage", front_door.greeting("drum", True, simulated, False))
        self.assertIn("/left/engage", front_door.greeting("drum", True, True, False, "left"))
        self.assertIn("ergotic_left:midi_in", front_door.greeting("drum", False, True, True, "left"))


class SoundSettingTest(WithFolder):
    def results(self, *lost):
        """Of the first steps; `lost` are their underruns, None where the card refuses the period"""
        return [Result(period, ring) if underruns is None else Result(period, ring, 3 * period, 48000, underruns)
                for (period, ring), underruns in zip(sound_setting.steps(), lost)]

    def test_each_step_has_less_latency_than_the_one_before(self):
        for buffers in (0, 1, 2, 3):  # periods that JACK keeps
            latencies = [Result(period, ring, buffers * period, 48000).latency_ms
                         for period, ring in sound_setting.steps()]
            self.assertEqual(latencies, sorted(set(latencies), reverse=True))
        self.assertEqual(sound_setting.steps(["64", "128"]), [(128, 384), (128, 256), (64, 192), (64, 144)])
        self.assertEqual(sound_setting.steps(["128:300", "128:500"]), [(128, 500), (128, 300)])
        for word in ("8", "wide", "64:0", "64:99999", "64:wide", "-64"):
            self.assertRaises(SystemExit, sound_setting.steps, [word])

    def test_latency_is_of_the_ring_and_the_card(self):
        self.assertAlmostEqual(Result(256, 768, 768, 48000).latency_ms, 32.0)

    def test_the_last_clean_step_but_one_is_chosen(self):
        steps = sound_setting.steps()
        for lost, chosen in (([0, 0, 0, 0, 2, 5], steps[2]), ([0, 1, 1], steps[0]), ([0, 3, 0, 0, 1, 1], steps[2]),
                             ([0, None, None, 0, 9, 9], steps[0]), ([0] * 11, steps[9]), ([1, 0, 1, 1], steps[1])):
            result = sound_setting.choose(self.results(*lost))
            self.assertEqual((result.period, result.ring_depth), chosen, lost)
        for lost in ([], [1, 1], [None, None]):
            self.assertIsNone(sound_setting.choose(self.results(*lost)))

    def test_xruns_are_gaps_and_late_ticks_are_not(self):
        self.assertFalse(Result(64, 192, 0, 48000, xruns=1).is_clean)
        self.assertTrue(Result(64, 192, 0, 48000, late=7).is_clean)

    def test_it_ends_after_two_steps_that_are_not_clean(self):
        for lost, ends in (([], False), ([1], False), ([0, 1], False), ([0, 1, 0, 1], False), ([0, 1, None, 1], True),
                           ([None, None], False), ([0, 1, 1], True)):
            self.assertEqual(sound_setting.has_ended(self.results(*lost)), ends, lost)

    def test_the_table_has_a_row_for_each_step(self):
        self.assertRegex(sound_setting.row(Result(256, 768, 768, 48000, 1, 2, 3)),
                         r"^ +256 +768 +32\.0 ms +1 +2 +3 +not clean$")
        self.assertIn("refuses", sound_setting.row(Result(32, 112)))
        self.assertEqual(sound_setting.results_of("256 768 512 48000 1 2 3\n32 112\n"),
                         [Result(256, 768, 512, 48000, 1, 2, 3), Result(32, 112)])

    def file(self):
        return sound_setting.setting_file({"XDG_CONFIG_HOME": str(self.folder)})

    def test_what_was_written_is_read_again(self):
        for sound in ("alsa:PCH", 'alsa:a "card" \\', "dummy"):
            text = sound_setting.text_of(Result(128, 256, 384, 48000), sound, datetime.datetime(2026, 1, 2))
            sound_setting.write(self.file(), text)
            self.assertEqual(sound_setting.read(self.file(), sound), (128, 256, 48000, 13.3))
            self.assertIsNone(sound_setting.read(self.file(), "pipewire"))
        self.assertEqual([path.name for path in self.file().parent.iterdir()], ["sound.yaml"])

    def test_without_a_file_there_is_no_setting(self):
        self.assertIsNone(sound_setting.read(self.file(), "dummy"))
        self.assertEqual(sound_setting.setting_file({}), pathlib.Path.home() / ".config/ergotic/sound.yaml")

    def test_a_file_that_is_spoilt_is_passed_over_with_a_warning(self):
        good = sound_setting.text_of(Result(128, 256, 384, 48000), "dummy", datetime.datetime(2026, 1, 2))
        for text in ("[", "", good.replace("128", "wide"), good.replace("256", "true"), good.replace("48000", "1")):
            sound_setting.write(self.file(), text)
            done = subprocess.run([ROOT / "scripts/sound_setting.py", "read", "dummy"], text=True, check=True,
                                  capture_output=True, env={**os.environ, "XDG_CONFIG_HOME": str(self.folder)})
            self.assertEqual(done.stdout, "")
            self.assertIn("is passed over", done.stderr)

    def test_nothing_is_written_where_nothing_was_clean(self):
        with self.assertRaises(SystemExit):
            sound_setting.say_choice(self.results(1, 1), "dummy", {"XDG_CONFIG_HOME": str(self.folder)})
        self.assertFalse(self.file().exists())


class SoundTest(WithFolder):
    """scripts/sound.sh, with a sound card, JACK and PipeWire that are played by functions."""

    PLAYED = """
set -euo pipefail
source "$1/scripts/lib.sh"; source "$1/scripts/processes.sh"; trap 'rm -rf "$logs"' EXIT
source "$1/scripts/sound.sh"
spawned=0
stop_group() { :; }
playback_card() { say "$CARD"; }
pipewire_runs() { [ "$PIPEWIRE" = yes ]; }
pipewire_plays() { say "tried ${through[*]}" && [ "$PIPEWIRE" = yes ]; }
start_jack() { say "tried $*" && [[ "$*" == $TAKEN ]]; }
start_some_sound 2>&1
say "ring_depth $ring_depth, clients: ${through[*]}"
"""

    def start(self, card="", taken="*", pipewire="no", tuned=None):
        folder = self.folder / "bin"
        folder.mkdir(exist_ok=True)
        if pipewire == "yes":
            (folder / "pw-jack").write_text("#!/bin/sh\n")
            (folder / "pw-jack").chmod(0o755)
        if tuned:
            text = sound_setting.text_of(Result(128, 256, 384, 48000), tuned, datetime.datetime(2026, 1, 2))
            sound_setting.write(self.folder / "ergotic/sound.yaml", text)
        environment = {**os.environ, "CARD": card, "TAKEN": taken, "PIPEWIRE": pipewire,
                       "XDG_CONFIG_HOME": str(self.folder), "PATH": f"{folder}:{os.environ['PATH']}"}
        return subprocess.run(["bash", "-c", self.PLAYED, "-", ROOT], text=True, check=True, stdout=subprocess.PIPE,
                              env=environment).stdout

    def test_without_a_card_jack_runs_and_nothing_is_heard(self):
        said = self.start()
        self.assertIn("no sound will be heard", said)
        self.assertIn("tried dummy --rate 44100 --period 256", said)
        self.assertIn("ring_depth 768, clients: \n", said)

    def test_a_card_is_safe_until_it_is_tuned(self):
        said = self.start(card="7")
        self.assertIn("tried alsa --device hw:7 --rate 44100 --period 256 --nperiods 3", said)
        self.assertIn("sound card hw:7; scripts/station --tune", said)
        self.assertIn("ring_depth 768", said)
        said = self.start(card="7", tuned="alsa:7")
        self.assertIn("tried alsa --device hw:7 --rate 48000 --period 128 --nperiods 3", said)
        self.assertIn("sound card hw:7; 13.3 ms", said)
        self.assertIn("ring_depth 256", said)
        self.assertIn("ring_depth 768", self.start(card="8", tuned="alsa:7"))

    def test_a_card_that_refuses_what_was_tuned_gets_the_safe_setting(self):
        said = self.start(card="7", taken="*period 256*", tuned="alsa:7")
        self.assertIn("tried alsa --device hw:7 --rate 44100 --period 256", said)
        self.assertIn("ring_depth 768", said)

    def test_a_card_that_does_not_start_is_told(self):
        said = self.start(card="7", taken="dummy*")
        self.assertIn("sound card hw:7 did not start", said)
        self.assertIn("no sound will be heard", said)

    def test_pipewire_keeps_its_card(self):
        said = self.start(card="7", pipewire="yes")
        self.assertEqual(said.count("tried"), 1)
        self.assertIn("sound through PipeWire (pw-jack)", said)
        self.assertIn("ring_depth 768, clients: pw-jack -s 48000 -p 256", said)
        self.assertIn("ring_depth 256, clients: pw-jack -s 48000 -p 128",
                      self.start(card="7", pipewire="yes", tuned="pipewire"))


if __name__ == "__main__":
    unittest.main()
