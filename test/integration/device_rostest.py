#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The device of a station: how it is calibrated by the lines of the documents, changed together with the model, and seen
in rviz when it is another one."""
import os
import re
import subprocess
import time

import numpy
import rospy
import rostest
import yaml

from desk import ROOT, DeskTest, Newest, end, until
from ergotic.msg import EndEffector, HandTargets, Status
from ergotic.srv import ConfigureEndEffectors, LoadModel
from std_msgs.msg import String
from std_srvs.srv import Trigger

MODELS = os.path.join(ROOT, "models")
STRING, DRUM = "plucked and struck string", "drum"  # as the scenes are called
ORGAN = "devices: [{driver: virtual, settings: {slices: 24}}]\n"
MISPLACED = "end_effectors:\n  bow: {type: bow, slices: [3, 4], ports: [nowhere, nowhere_else]}\n"
MISSPELT = "end_effectors:\n  bow: {type: saw, slices: [3, 4], ports: ['', '']}\n"


def lines_of(document):
    """What a document shows of `calibrate`, without what follows `#`."""
    with open(os.path.join(ROOT, document), encoding="utf-8") as file:
        return [line.split(" #")[0].strip() for line in file if line.startswith("rosrun ergotic calibrate ")]


class DeviceTest(DeskTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        os.environ["ROS_HOME"] = os.path.join(cls.folder.name, "ros home")
        cls.status = Newest("/station/status", Status)
        cls.device = Newest("/station/robot_description", String)
        cls.hand = rospy.Publisher("/station/hand_targets", HandTargets, queue_size=10)

    def begin(self, **parameters):
        """A station with another device, in place of the one before."""
        if hasattr(type(self), "station"):
            end(self.station)
            rospy.delete_param("/station")
        self.status.message = self.device.message = None
        self.start_station(model=os.path.join(MODELS, "string.yaml"), jack="none", gamepads=False, **parameters)
        self.assertTrue(until(lambda: self.status.message and self.status.message.model == STRING and
                              self.device.message and self.hand.get_num_connections() > 0, 60), "it does not play")

    # Calibration

    def move(self, mm):
        self.hand.publish(indices=[1], targets=[1e-3 * mm])
        time.sleep(0.5)

    def let_go(self):
        self.hand.publish(indices=[1], release=True)
        time.sleep(0.5)

    def type(self, line):
        """A line as a person types it who does what it says. \return what it said"""
        for mm in re.findall(r"sample --mm (-?\d+)", line):
            self.move(float(mm))
        if "calibrate check" in line:
            self.let_go()
        process = self.start("bash", "-c", "exec " + line, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        return process.communicate(timeout=30)[0], process.returncode

    def walk(self, line):
        process = subprocess.Popen(line.split(), stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
                                   stderr=subprocess.STDOUT)
        self.addCleanup(process.stdout.close)
        said = ""
        for text in process.stdout:
            said += text
            place = re.match(r"Hold the slice still at (-?\d+) mm, and press Enter", text)
            if place:
                self.move(float(place[1]))
            elif text.startswith("Take your hands off, and press Enter"):
                self.let_go()
            else:
                continue
            process.stdin.write("\n")
            process.stdin.flush()
        process.stdin.close()
        return said, process.wait(10)

    def test_1_the_lines_of_the_documents_calibrate_a_slice(self):
        self.begin(device=os.path.join(ROOT, "config/virtual_raw.yaml"))
        self.assertTrue(until(lambda: 1 in self.status.message.uncalibrated))
        lines = lines_of("docs/ros.md")
        self.assertGreaterEqual(len(lines), 6)
        heard = ""
        for line in lines:
            said, status = self.walk(line) if "calibrate --" in line else self.type(line)
            heard += f"{line}\n{said}"
            self.assertEqual(status, 0, heard)
            if "check" in line or "calibrate --" in line:
                self.assertIn("Sign and scale of the force are right", said)
                self.assertTrue(until(lambda: 1 not in self.status.message.uncalibrated))
        with open(os.path.join(os.environ["ROS_HOME"], "ergotic/devices.yaml"), encoding="utf-8") as file:
            found = yaml.safe_load(file)["devices"][0]["calibration"][1]
        self.assertAlmostEqual(found["metres_per_volt"], -0.0042, delta=1e-4)
        self.assertAlmostEqual(found["checked"], found["metres_per_volt"] * found["volts_per_newton"], places=9)
        said, status = self.type("rosrun ergotic calibrate sample --mm 3")
        self.assertEqual((said, status), ("error: nothing is being calibrated: begin first\n", 1))

    # The model together with its end-effectors

    def load(self, model, end_effectors=""):
        return rospy.ServiceProxy("/station/load_model", LoadModel)(
            model=os.path.join(MODELS, model + ".yaml"), end_effectors=end_effectors)

    def plays(self, model, *end_effectors):
        return until(lambda: (self.status.message.model, [each.name for each in self.status.message.end_effectors]) ==
                     (model, list(end_effectors)))

    def test_2_a_model_comes_with_its_end_effectors(self):
        self.begin(autoengage=True)
        self.assertTrue(until(lambda: self.status.message.state == Status.PLAYING))
        for wrong, told in ((MISPLACED, "nowhere"), (MISSPELT, "saw"), ("no/file.yaml", "no/file.yaml")):
            answer = self.load("drum", wrong)
            self.assertFalse(answer.success)
            self.assertIn(told, answer.message)
        self.assertTrue(self.plays(STRING))
        self.assertEqual(self.status.message.state, Status.PLAYING, "force stays as it was")
        answer = self.load("drum", os.path.join(MODELS, "hands/drum.yaml"))
        self.assertTrue(answer.success, answer.message)
        self.assertTrue(self.plays(DRUM, "mallet", "fingers"), self.status.message)
        self.assertTrue(until(lambda: self.status.message.state == Status.READY), "force waits for engage")
        self.assertIn('link name="mallet"', self.device.message.data)
        self.assertEqual(rospy.get_param("/robot_description"), self.device.message.data)
        answer = self.load("string")
        self.assertFalse(answer.success, "the string has no ports of a mallet")
        self.assertTrue(self.plays(DRUM, "mallet", "fingers"))
        answer = self.load("string", "none")
        self.assertTrue(answer.success, answer.message)
        self.assertTrue(self.plays(STRING))
        self.assertTrue(until(lambda: rospy.ServiceProxy("/station/engage", Trigger)().success))

    # The device in rviz

    def start_window(self):
        """The camera stays where it is, and what stands on the device is seen by its URDF alone."""
        with open(os.path.join(ROOT, "rviz/station.rviz"), encoding="utf-8") as file:
            config = yaml.safe_load(file)
        for display in config["Visualization Manager"]["Displays"]:
            if display["Name"] in ("Device", "End-effectors", "Instrument"):
                display["Enabled"] = display["Value"] = display["Name"] == "Device"
        config["Visualization Manager"]["Tools"][0]["Frame models"] = False
        path = os.path.join(self.folder.name, "device.rviz")
        with open(path, "w", encoding="utf-8") as file:
            yaml.safe_dump(config, file)
        self.start_screen()
        self.start("rviz", "--display-config", path)
        self.wait_for_window("/station/robot_description")

    def picture(self):
        """[rows, columns, 3] beside the panel, red, green, blue."""
        shot = subprocess.run(["import", "-window", "root", "-depth", "8", "rgb:-"], check=True, capture_output=True,
                              timeout=20).stdout
        return numpy.frombuffer(shot, dtype=numpy.uint8).reshape(800, 1280, 3)[100:, 400:].astype(int)

    def wooden(self):
        red, _, blue = numpy.moveaxis(self.picture(), 2, 0)
        return numpy.count_nonzero((red - blue > 15) & (red < 70))

    def ivory(self):
        picture = self.picture()
        return numpy.count_nonzero((picture.min(axis=2) > 80) & (numpy.ptp(picture, axis=2) < 40))

    def expect(self, condition, what):
        came = until(condition, 30)
        if not came and "DEVICE_PICTURE" in os.environ:  # for who looks for the reason
            subprocess.run(["import", "-window", "root", os.environ["DEVICE_PICTURE"]], timeout=10, check=False)
        self.assertTrue(came, what)

    def test_3_rviz_shows_another_device_by_itself(self):
        self.begin()
        self.start_window()
        self.expect(lambda: self.ivory() > 500, "the keys are not seen")
        keys, wood = self.ivory(), self.wooden()
        bow = EndEffector(name="bow", type=EndEffector.BOW, slices=[3, 4], ports=["", ""])
        bow.pose.position.z, bow.pose.orientation.w = 0.15, 1.0
        answer = rospy.ServiceProxy("/station/configure_end_effectors", ConfigureEndEffectors)(end_effectors=[bow])
        self.assertTrue(answer.success, answer.message)
        self.expect(lambda: self.wooden() > wood + 100, "the bow is not seen")
        self.begin(device=ORGAN)
        self.expect(lambda: self.ivory() > 1.4 * keys, "two octaves are not seen")


if __name__ == "__main__":
    rospy.init_node("device")
    rostest.rosrun("ergotic", "device", DeviceTest)
