# SPDX-License-Identifier: BSD-3-Clause
"""The mouse in rviz: where on the screen is what hands move."""
import math
import os
import re
import subprocess

import numpy

from desk import ROOT, Newest, until
from ergotic.msg import Handles, ModelState, ModelStructure, Status


class Camera:
    """That of rviz/station.rviz, which looks at a model from a place on a sphere, so that all of it is in the picture;
    or from where the scene wants it: `shot`, the camera and what it looks at."""

    def __init__(self, points, width, height, shot=()):
        with open(os.path.join(ROOT, "rviz/station.rviz"), encoding="utf-8") as file:
            view = file.read().split("Views:")[1]

        def number(name):
            return float(re.search(rf"\b{name}: ([-\d.e]+)", view).group(1))
        pitch, yaw = number("Pitch"), number("Yaw")
        if shot:
            away = shot[0] - shot[1]
            pitch, yaw = math.asin(away[2] / numpy.linalg.norm(away)), math.atan2(away[1], away[0])
        out = numpy.array([math.cos(yaw) * math.cos(pitch), math.sin(yaw) * math.cos(pitch), math.sin(pitch)])
        self.right = numpy.array([-math.sin(yaw), math.cos(yaw), 0.0])
        self.up = numpy.cross(out, self.right)
        self.half_height = math.tan(0.5 * number("Field of View"))
        self.forward = -out
        self.size = width, height
        if shot:
            self.eye = shot[0]
            return
        focus = 0.5 * (numpy.min(points, axis=0) + numpy.max(points, axis=0))
        margin = 1.15
        half = numpy.array([self.half_height * width / height, self.half_height]) / margin
        around = points - focus
        across = numpy.abs(numpy.stack([around @ self.right, around @ self.up], axis=1)) / half
        self.eye = focus + max(0.1, numpy.max(around @ out + numpy.max(across, axis=1))) * out

    def pixel(self, point):
        """Where a point of the fixed frame is in the picture."""
        width, height = self.size
        way = point - self.eye
        scale = 0.5 * height / (self.half_height * (way @ self.forward))
        return 0.5 * width + scale * (way @ self.right), 0.5 * height - scale * (way @ self.up)


def xdotool(*words):
    return subprocess.run(["xdotool", *map(str, words)], check=True, timeout=10, capture_output=True, text=True).stdout


def turned(angles):
    """The matrix of turns about the fixed axes x, y, z."""
    (a, b, c), (x, y, z) = numpy.cos(angles), numpy.sin(angles)
    about_x = numpy.array([[1, 0, 0], [0, a, -x], [0, x, a]])
    about_y = numpy.array([[b, 0, y], [0, 1, 0], [-y, 0, b]])
    about_z = numpy.array([[c, -z, 0], [z, c, 0], [0, 0, 1]])
    return about_z @ about_y @ about_x


def rotate(q, v):
    """By a quaternion of geometry_msgs."""
    u = numpy.array([q.x, q.y, q.z])
    return v + 2 * numpy.cross(u, numpy.cross(u, v) + q.w * v)


class Pointer:
    """For a DeskTest whose station is shown by rviz."""

    @classmethod
    def start_desk(cls, **parameters):
        """JACK, a station that plays the default instrument, and rviz."""
        cls.start_screen()
        cls.start_jack()
        cls.status = Newest("/station/status", Status)
        cls.handles = Newest("/station/handles", Handles)
        cls.structure = Newest("/station/model_structure", ModelStructure)
        cls.state = Newest("/station/model_state", ModelState)
        with open(os.path.join(ROOT, "urdf/tgr.urdf"), encoding="utf-8") as file:
            cls.urdf = file.read()
        cls.start_station(model=os.path.join(ROOT, "models/string.yaml"), autoengage=True, **parameters)
        cls.rviz = cls.start_rviz()
        assert until(lambda: cls.status.message and cls.status.message.state == Status.PLAYING, 60), "no force"

    def picture(self):
        """Corner, width and height of the picture on the screen: the largest window inside that of rviz."""
        window = xdotool("search", "--onlyvisible", "--name", "RViz").split()[-1]
        tree = subprocess.run(["xwininfo", "-tree", "-id", window], check=True, timeout=10, capture_output=True,
                              text=True).stdout
        found = [tuple(map(int, numbers)) for numbers in
                 re.findall(r"(\d+)x(\d+)\+-?\d+\+-?\d+  \+(-?\d+)\+(-?\d+)", tree.split("children")[1])]
        width, height, left, top = max(found, key=lambda box: box[0] * box[1])
        return left, top, width, height

    def place(self, module, moved):
        """Where a module of one axis is drawn, in the fixed frame; all sections have one dimension."""
        structure = self.structure.message
        at = numpy.array(structure.rest_positions[3 * module:3 * module + 3])
        section = structure.section_poses[structure.module_sections[module]]
        origin = numpy.array([section.position.x, section.position.y, section.position.z])
        axis = rotate(section.orientation, numpy.array([1.0, 0.0, 0.0]))
        along = (at - origin) @ axis
        drawn = at + (self.handles.message.display_zoom * (along + moved) - along) * axis
        return self.mounted(drawn)

    def mounted(self, point):
        """Where a point of the frame of the model is in the fixed frame."""
        mount = re.search(r'<child link="model"/>\s*<origin xyz="([^"]*)" rpy="([^"]*)"', self.urdf)
        place, turn = (numpy.array(list(map(float, numbers.split()))) for numbers in mount.groups())
        return place + turned(turn) @ point

    def handle(self, name):
        """Where a handle of one axis is on the screen."""
        return self.module(self.handles.message.modules[self.handles.message.names.index(name)])

    def touched(self, name):
        """Where on the screen the first thing is that a handle acts on; rviz draws beside it what lies nowhere else."""
        module = self.handles.message.modules[self.handles.message.names.index(name)]
        links = numpy.reshape(self.structure.message.links, (-1, 2))
        first = next(link for link in links if module in link)
        return self.module(int(first[0] if first[1] == module else first[1]), at_rest=True)

    def seen(self):
        """Modules that are in the picture: all but the modes of bodies whose outlines are."""
        names = self.structure.message.module_names
        bodies = {name.rpartition(".outline.")[0] for name in names if ".outline." in name}
        parts = [name.rpartition(".") for name in names]
        return [i for i, (body, _, number) in enumerate(parts) if not (body in bodies and number.isdigit())]

    def module(self, module, at_rest=False):
        """Where a module is on the screen."""
        left, top, width, height = self.picture()
        modules = self.seen()
        shot = [self.mounted(numpy.array([p.x, p.y, p.z])) for p in self.structure.message.camera]
        camera = Camera(numpy.array([self.place(i, 0.0) for i in modules]), width, height, shot)
        x, y = camera.pixel(self.place(module, 0.0 if at_rest else self.state.message.displacement[module]))
        return round(left + x), round(top + y)
