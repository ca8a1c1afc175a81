# SPDX-License-Identifier: BSD-3-Clause
"""What a bag of a station holds, as arrays."""
import numpy as np
import rosbag

EVENT_UNDERRUN = 10
EVENT_AUDIO_SKIPPED = 11
EVENT_AUDIO_STOPPED = 13


class Performance:
    """
    ticks      [ticks] numbers
    positions  [ticks][slices] m
    forces     [ticks][slices] N
    ratio      audio frames per tick
    keyframes  [n] ticks
    silenced   [(station frame, frames, JACK frame)] that did not sound: underruns, and periods
               that JACK itself left out
    underruns  [(tick, frames)]
    statuses   messages, first to last
    times, displacements  [pictures] s, and the largest displacement of a string, m
    """

    def __init__(self, path):
        blocks, self.keyframes, self.silenced, self.statuses, motion = [], [], [], [], []
        self.underruns = []
        self.audio_stops = 0
        strings = None
        with rosbag.Bag(path) as bag:
            for _, message, _ in bag.read_messages():
                kind = message._type  # pylint: disable=protected-access
                if kind == "ergotic/GestureBlock":
                    blocks.append(message)
                elif kind == "ergotic/Keyframe":
                    self.keyframes.append(message.tick)
                    self.ratio = message.ratio
                elif kind == "ergotic/Event":
                    self._hear(message)
                elif kind == "ergotic/Status":
                    self.statuses.append(message)
                elif kind == "ergotic/ModelStructure":
                    strings = message
                elif kind == "ergotic/ModelState":
                    motion.append(message)
        for name, found in (("gesture", blocks), ("keyframe", self.keyframes),
                            ("status", self.statuses), ("model_state", motion)):
            if not found:
                raise ValueError(f"{path}: no {name} in it")
        blocks.sort(key=lambda block: block.first_tick)
        self._take_gesture(blocks)
        self._take_motion(motion, strings)

    def _hear(self, event):
        if event.type == EVENT_UNDERRUN:
            self.underruns.append((event.tick, event.index))
        if event.type in (EVENT_UNDERRUN, EVENT_AUDIO_SKIPPED):
            self.silenced.append((event.frame, event.index, int(event.value)))
        elif event.type == EVENT_AUDIO_STOPPED:
            self.audio_stops += 1

    def _take_gesture(self, blocks):
        self.ticks = np.concatenate([b.first_tick + np.arange(b.ticks) for b in blocks])
        self.tick_rate = blocks[0].tick_rate_hz
        slices = blocks[0].slices
        self.positions = np.concatenate([b.positions for b in blocks]).reshape(-1, slices)
        self.forces = np.concatenate([b.forces for b in blocks]).reshape(-1, slices)

    def _take_motion(self, motion, structure):
        numbers = [structure.section_dimensions[s] for s in structure.module_sections]
        begin = np.concatenate([[0], np.cumsum(numbers)])  # of each module in a picture
        wanted = np.concatenate(
            [np.arange(begin[first], begin[first + count])
             for first, count in zip(structure.string_first, structure.string_count)])
        self.times = np.array([m.header.stamp.to_sec() for m in motion])
        self.displacements = np.array(
            [np.max(np.abs(np.asarray(m.displacement)[wanted])) for m in motion])

    def frame_of_first_keyframe(self):
        """Station frame at which a replay starts: that of the first keyframe among the ticks."""
        recorded = [tick for tick in self.keyframes if self.ticks[0] <= tick <= self.ticks[-1]]
        return (recorded[0] if recorded else self.keyframes[0]) * self.ratio
