# SPDX-License-Identifier: BSD-3-Clause
"""A MIDI keyboard as JACK sees hardware, for tests."""
import collections
import ctypes

NO_START_SERVER, IS_OUTPUT, IS_PHYSICAL = 1, 2, 4
MIDI_TYPE = b"8 bit raw midi"


class MidiKeyboard:
    """Sends what it is given, a message a period, over the port `name:out`."""

    def __init__(self, name):
        self.jack = ctypes.CDLL("libjack.so.0")
        for call in ("jack_client_open", "jack_port_register", "jack_port_get_buffer", "jack_midi_event_reserve"):
            getattr(self.jack, call).restype = ctypes.c_void_p
        self.client = ctypes.c_void_p(self.jack.jack_client_open(name.encode(), NO_START_SERVER, None))
        assert self.client, "no JACK server"
        self.port = None
        self.waiting = collections.deque()
        self.process = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_uint32, ctypes.c_void_p)(self.on_process)
        self.jack.jack_set_process_callback(self.client, self.process, None)
        self.jack.jack_activate(self.client)
        self.port = ctypes.c_void_p(self.jack.jack_port_register(
            self.client, b"out", MIDI_TYPE, ctypes.c_ulong(IS_OUTPUT | IS_PHYSICAL), ctypes.c_ulong(0)))

    def on_process(self, frames, _):
        if not self.port:
            return 0
        buffer = ctypes.c_void_p(self.jack.jack_port_get_buffer(self.port, frames))
        self.jack.jack_midi_clear_buffer(buffer)
        if self.waiting:
            message = self.waiting.popleft()
            place = self.jack.jack_midi_event_reserve(buffer, 0, ctypes.c_size_t(len(message)))
            ctypes.memmove(place, message, len(message))
        return 0

    def send(self, *message):
        self.waiting.append(bytes(message))

    def is_connected(self):
        return self.jack.jack_port_connected(self.port) > 0

    def close(self):
        self.jack.jack_client_close(self.client)
