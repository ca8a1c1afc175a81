# SPDX-License-Identifier: BSD-3-Clause
"""Sound files and what can be measured in them. Sound: float32 array [frames][channels]."""
import struct

import numpy as np

FLOAT_FORMAT = 3
EXTENSIBLE_FORMAT = 0xFFFE


def read_wav(path):
    """Reads a WAV or RF64 file of 32-bit floats. Returns (sound, sample rate in Hz)."""
    with open(path, "rb") as file:
        data = file.read()
    if data[:4] not in (b"RIFF", b"RF64") or data[8:12] != b"WAVE":
        raise ValueError(f"{path}: not a WAV file")
    rate = channels = None
    at = 12
    while at + 8 <= len(data):
        name, size = struct.unpack("<4sI", data[at : at + 8])
        body = at + 8
        if name == b"fmt ":
            code, channels, rate, _, _, bits = struct.unpack("<HHIIHH", data[body : body + 16])
            if code == EXTENSIBLE_FORMAT:
                (code,) = struct.unpack("<H", data[body + 24 : body + 26])
            if code != FLOAT_FORMAT or bits != 32:
                raise ValueError(f"{path}: format {code} of {bits} bits, expected 32-bit float")
        elif name == b"data" and channels:
            whole = min(size, len(data) - body) // (4 * channels)  # RF64 says 0xFFFFFFFF here
            sound = np.frombuffer(data, "<f4", whole * channels, body)
            return sound.reshape(-1, channels), float(rate)
        at = body + size + size % 2
    raise ValueError(f"{path}: no sound in it")


def level_dbfs(sound):
    """RMS over all channels, dB relative to 1; -inf for silence."""
    if sound.size == 0:
        return -np.inf
    power = np.mean(np.square(sound, dtype=np.float64))
    return 10.0 * np.log10(power) if power > 0.0 else -np.inf


def _spectrum_at(signal, frequency, rate):
    """One bin of a windowed Fourier transform, at any frequency."""
    phase = -2j * np.pi * frequency / rate * np.arange(len(signal))
    return np.sum(signal * np.blackman(len(signal)) * np.exp(phase))


def measure_pitch(signal, rate, expected, search_cents=100.0):
    """Frequency of the partial within `search_cents` of `expected`, Hz; NaN if there is none.

    The peak of a padded transform gives it roughly; the phase that it gains from one half of the
    signal to the other gives it exactly, also while it decays: both halves decay alike.
    """
    signal = np.asarray(signal, dtype=np.float64)
    half = len(signal) // 2
    bins = 8 * len(signal)
    spectrum = np.abs(np.fft.rfft(signal * np.blackman(len(signal)), bins))
    reach = 2.0 ** (search_cents / 1200.0)
    low, high = (int(round(f * bins / rate)) for f in (expected / reach, expected * reach))
    peak = low + int(np.argmax(spectrum[low : high + 1]))
    if not low < peak < high or spectrum[peak] <= 0.0:
        return np.nan  # no maximum in there, only the slope of another one
    rough = peak * rate / bins
    first = _spectrum_at(signal[:half], rough, rate)
    second = _spectrum_at(signal[half : 2 * half], rough, rate)
    gained = np.angle(second * np.conj(first) * np.exp(-2j * np.pi * rough / rate * half))
    return rough + gained * rate / (2.0 * np.pi * half)


def cents(frequency, reference):
    return 1200.0 * np.log2(frequency / reference)


def find_shift(replay, recorded, samples=4000):
    """Frames by which `replay` starts later than `recorded`; None if they share nothing.

    Loud samples of one are looked up in the other, by value and bit for bit, and vote.
    """
    channel = int(np.argmax(np.max(np.abs(replay), axis=0)))
    ours, theirs = replay[:, channel], recorded[:, channel]
    loud = np.flatnonzero(np.abs(ours) > 1e-3 * np.max(np.abs(ours)))
    if loud.size == 0:
        return None
    loud = np.random.default_rng(1).permutation(loud)[:samples]
    order = np.argsort(theirs, kind="stable")
    values = theirs[order]
    first = np.searchsorted(values, ours[loud], "left")
    last = np.minimum(np.searchsorted(values, ours[loud], "right"), first + 8)
    votes = [order[i] - at for at, a, b in zip(loud, first, last) for i in range(a, b)]
    if not votes:
        return None
    shifts, counts = np.unique(votes, return_counts=True)
    chance = 0.05 * len(loud)  # two sounds may have a value in common
    return int(shifts[np.argmax(counts)]) if np.max(counts) > chance else None


def compare(replay, recorded, shift, silenced):
    """Compares `recorded` with `replay`, which starts `shift` frames later.

    silenced  [(first frame, frames)] of `recorded` that were reported as not played
    Returns a dict: `equal`, `different`: frames compared; `gaps`: those of the different ones that
    are silent in `recorded`; `share`: equal over all frames of `recorded`; `noisy`: frames within
    `silenced` that are not silent.
    """
    channels = min(replay.shape[1], recorded.shape[1])
    begin, end = max(shift, 0), min(shift + len(replay), len(recorded))
    mine = recorded[begin:end, :channels]
    same = np.all(mine == replay[begin - shift : end - shift, :channels], axis=1)
    silent = np.all(recorded[begin:end] == 0.0, axis=1)
    played = np.ones(len(same), dtype=bool)
    for first, frames in silenced:
        played[max(first - begin, 0) : max(first + frames - begin, 0)] = False
    different = played & ~same
    return {
        "equal": int(np.sum(played & same)),
        "different": int(np.sum(different)),
        "gaps": int(np.sum(different & silent)),
        "noisy": int(np.sum(~played & ~silent)),
        "share": float(np.sum(played & same)) / len(recorded),
    }
