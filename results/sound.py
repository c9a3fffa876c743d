"""Sounds of a run: its artifacts that are WAV files, as samples and as power over time and frequency."""

import math
import struct
from dataclasses import dataclass

import numpy as np

import runfile

PCM, FLOAT, EXTENSIBLE = 1, 3, 0xFFFE
WINDOW_S = 0.0107  # of a spectrum, about: short enough for a click of a few ms
LONG = 4  # times as long at low frequencies: tells 100 Hz from 200 Hz
MIXED_HZ = (500, 1000)  # only long windows below, only short ones above
PADDING = 4  # transforms of windows and zeros, this many times as long: smooth between bins
LOWEST_HZ, HIGHEST_HZ = 50, 20000
FLOOR = 1e-24  # power that silence is drawn as
FRAMES_AT_ONCE = 512  # a long sound does not fit in memory with all of its windows


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


def row_edges(rate, rows):
    """Edges (Hz) of rows evenly spaced in the logarithm, LOWEST_HZ to HIGHEST_HZ or to half the rate.
    A sound that ends below LOWEST_HZ gets its highest three octaves."""
    top = min(rate / 2, HIGHEST_HZ)
    return np.geomspace(min(LOWEST_HZ, top / 8), top, rows + 1)


def row_means(edges, bins):
    """rows x bins: weights of the mean over a row, from edge to edge (in bins), of powers that are
    linear between bins. A narrow row is interpolated, a wide one averages the bins that it covers."""
    u = np.clip(edges[:, None] - np.arange(bins), -1, 1)
    integral = 0.5 + u - 0.5 * u * np.abs(u)  # of the hat function of each bin, up to the edge
    return np.diff(integral, axis=0) / np.diff(edges)[:, None]


class Spectra:
    """Power in rows of frequencies, by Hann windows of one length around every `step` samples: the
    channels' mean; 1 is a sine of full scale. Rows that are not `used` get 0."""

    def __init__(self, sound, window, step, edges, used):
        self.weights = np.hanning(window + 1)[:-1]
        self.length = PADDING * window
        padded = np.pad(sound.samples, ((window // 2, window), (0, 0)))
        self.frames = np.lib.stride_tricks.sliding_window_view(padded, window, axis=0)[::step]
        means = row_means(edges * self.length / sound.rate, self.length // 2 + 1) * used[:, None]
        self.bins = means.any(axis=0)
        self.means = means[:, self.bins]

    def powers(self, times):
        """times x rows; `times` in steps."""
        spectra = np.fft.rfft(self.frames[times] * self.weights, self.length, axis=2)[:, :, self.bins]
        amplitude = np.abs(spectra) / (self.weights.sum() / 2)
        return (amplitude**2).mean(axis=1) @ self.means.T


def short_shares(edges):
    """Weight of short windows in each row's level: 0 below MIXED_HZ, 1 above, linear in the logarithm."""
    low, high = MIXED_HZ
    return np.clip(np.log(np.sqrt(edges[:-1] * edges[1:]) / low) / np.log(high / low), 0, 1)


def spectrogram(sound, rows, most_columns=None):
    """Times (s), edges of the rows (Hz) and levels (rows x times, dB).

    Fourier transforms of Hann windows that overlap by three quarters or more: of 11 ms above 1 kHz, of
    43 ms below 500 Hz; between, the mean of both levels, weighted by log frequency. A sine of full
    scale is 0 dB with either, so that a click reads 12 dB less below 500 Hz than above 1 kHz, and noise
    of one density 6 dB less. A row wider than the peak of a sine (140 Hz) averages it with what is
    beside it: 3 dB less at 20 kHz with 420 rows.
    Where the times are more than `most_columns`, the loudest of neighbours stands for them, so that no
    click is lost; long windows are then fewer, but overlap by three quarters."""
    window = max(8, 2**round(np.log2(WINDOW_S * sound.rate)))
    step = window // 4
    count = len(sound.samples) // step + 1
    size = math.ceil(count / most_columns) if most_columns else 1
    every = min(size, LONG)
    edges = row_edges(sound.rate, rows)
    shares = short_shares(edges)
    short = Spectra(sound, window, step, edges, shares > 0)
    long = Spectra(sound, LONG * window, every * step, edges, shares < 1)
    columns = np.full((math.ceil(count / size), rows), FLOOR)
    for first in range(0, count, FRAMES_AT_ONCE):
        times = np.arange(first, min(first + FRAMES_AT_ONCE, count))
        few, back = np.unique((times + every // 2) // every, return_inverse=True)
        powers = short.powers(times)**shares * long.powers(few)[back]**(1 - shares)
        column, starts = np.unique(times // size, return_index=True)
        columns[column] = np.maximum(columns[column], np.maximum.reduceat(powers, starts))
    return np.arange(len(columns)) * size * step / sound.rate, edges, 10 * np.log10(columns).T
