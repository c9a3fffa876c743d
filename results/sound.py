"""Sounds of a run: its artifacts that are WAV files, as samples and as power over time and frequency."""

import math
import struct
from dataclasses import dataclass

import numpy as np

import runfile

PCM, FLOAT, EXTENSIBLE = 1, 3, 0xFFFE
WINDOW_S = 0.0107  # of a spectrum, about: short enough for a click of a few ms
FLOOR = 1e-24  # power that silence is drawn as
FRAMES_AT_ONCE = 4096  # a long sound does not fit in memory with all of its windows


class NoSound(runfile.RunFileError):
    """A file that is no WAV file, or one of a kind that is not read here."""


@dataclass
class Sound:
    rate: int  # Hz
    samples: np.ndarray  # samples x channels, full scale 1

    def seconds(self):
        return len(self.samples) / self.rate


def sounds_of(variant):
    """(name, SHA-256) of the variant's WAV files, in the order in which they were made."""
    return [(name, sha256) for name, sha256 in variant.artifacts if name.lower().endswith(".wav")]


def chunks(content):
    """word: bytes of the first chunk of that word."""
    found, at = {}, 12
    while at + 8 <= len(content):
        word, size = struct.unpack("<4sI", content[at:at + 8])
        found.setdefault(word, content[at + 8:at + 8 + size])
        at += 8 + size + size % 2
    return found


def decoded_samples(data, tag, bits):
    """Numbers in a row, full scale 1; None for a kind that is not read."""
    if tag == FLOAT and bits in (32, 64):
        return np.frombuffer(data, f"<f{bits // 8}").astype(float)
    if tag != PCM or bits not in (16, 24, 32):
        return None
    size = bits // 8
    wide = np.zeros((len(data) // size, 4), np.uint8)
    wide[:, 4 - size:] = np.frombuffer(data, np.uint8).reshape(-1, size)
    return wide.view("<i4")[:, 0] / 2.0**31


def read_wav(content, name):
    """16, 24 and 32-bit PCM and floating point. Raises NoSound naming the file."""
    parts = chunks(content) if content[:4] == b"RIFF" and content[8:12] == b"WAVE" else {}
    head, data = parts.get(b"fmt ", b""), parts.get(b"data", b"")
    if len(head) < 16:
        raise NoSound(f"{name}: is no WAV file")
    tag, channels, rate, _, frame, bits = struct.unpack("<HHIIHH", head[:16])
    if tag == EXTENSIBLE and len(head) >= 26:
        tag = struct.unpack("<H", head[24:26])[0]
    if not rate or not channels or frame * 8 != channels * bits:
        raise NoSound(f"{name}: is a damaged WAV file")
    numbers = decoded_samples(data[:len(data) // frame * frame], tag, bits)
    if numbers is None or numbers.size == 0 or not np.isfinite(numbers).all():
        raise NoSound(f"{name}: holds no samples that are read here "
                                   "(16, 24 or 32-bit PCM or floating point)")
    return Sound(rate, numbers.reshape(-1, channels))


def powers(frames, weights):
    """Frequencies of each frame (frames x channels x samples): 1 is a sine of full scale; the channels' mean."""
    amplitude = np.abs(np.fft.rfft(frames * weights, axis=2)) / (weights.sum() / 2)
    amplitude[:, :, [0, -1]] /= 2  # which have no negative frequency beside them
    return (amplitude**2).mean(axis=1)


def spectrogram(sound, most_columns=None):
    """Times (s), frequencies (Hz) and levels (frequencies x times, dB; 0 is a sine of full scale), by
    Fourier transforms of Hann windows that overlap by three quarters. Where these are more than
    `most_columns`, the loudest of neighbours stands for them, so that no click is lost."""
    window = 2**round(np.log2(WINDOW_S * sound.rate))
    step = window // 4
    count = len(sound.samples) // step + 1
    size = math.ceil(count / most_columns) if most_columns else 1
    weights = np.hanning(window + 1)[:-1]
    padded = np.pad(sound.samples, ((window // 2, window), (0, 0)))
    frames = np.lib.stride_tricks.sliding_window_view(padded, window, axis=0)[::step][:count]
    columns = []
    chunk = size * max(1, FRAMES_AT_ONCE // size)
    for first in range(0, count, chunk):
        some = powers(frames[first:first + chunk], weights)
        columns.append(np.maximum.reduceat(some, np.arange(0, len(some), size), axis=0))
    levels = 10 * np.log10(np.maximum(np.concatenate(columns), FLOOR)).T
    return np.arange(levels.shape[1]) * size * step / sound.rate, np.fft.rfftfreq(window, 1 / sound.rate), levels
