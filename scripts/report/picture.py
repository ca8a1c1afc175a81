# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of the screen. Picture: uint8 array [height][width][3]."""
import re

import numpy as np

VISIBLE_STEP = 24  # of 255, in any colour


def read_ppm(path):
    with open(path, "rb") as file:
        data = file.read()
    header = re.match(rb"P6\s+(\d+)\s+(\d+)\s+255\s", data)
    if not header:
        raise ValueError(f"{path}: not a PPM picture of 8 bits")
    width, height = int(header[1]), int(header[2])
    pixels = np.frombuffer(data, np.uint8, width * height * 3, header.end())
    return pixels.reshape(height, width, 3)


def middle(picture):
    """The scene without the clocks and panels around it."""
    height, width = picture.shape[:2]
    return picture[height // 6 : height - height // 6, width // 5 : width - width // 5]


def changed_pixels(one, other):
    """Pixels in the middle that differ visibly."""
    step = np.abs(middle(one).astype(np.int16) - middle(other).astype(np.int16))
    return int(np.sum(np.max(step, axis=2) >= VISIBLE_STEP))
