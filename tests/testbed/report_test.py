"""What results/*.py make of a run: read from run.h5 alone, self-contained, the same twice, and one
clear line when the file is damaged. Run with Debian's python3."""

import base64
import contextlib
import hashlib
import io
import json
import os
import re
import runpy
import shutil
import struct
import subprocess
import sys
import tempfile
import traceback
import unittest
import xml.etree.ElementTree as ElementTree
from html.parser import HTMLParser
from pathlib import Path
from types import SimpleNamespace
from urllib.parse import quote

import h5py
import numpy as np

RESULTS = Path(__file__).resolve().parents[2] / "results"
sys.path.insert(0, str(RESULTS))

import markdown_text  # noqa: E402
import plots  # noqa: E402
import report  # noqa: E402
import runfile  # noqa: E402
import sound  # noqa: E402
import spectrogram  # noqa: E402
import summary  # noqa: E402
import tables  # noqa: E402
import wording  # noqa: E402
from geoprior_results.texts import printable  # noqa: E402

ANGLES = np.array([0.0, 45.0, 90.0])
PIXEL = base64.b64decode("iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJ"
                         "ggg==")


def table(rows, fields):
    """A compound table as docs/file-formats.md describes it."""
    kinds = [(n, f"S{max([len(str(r[i]).encode()) for r in rows] + [1])}" if k == "text" else k)
             for i, (n, k) in enumerate(fields)]
    encoded = [tuple(str(x).encode() if k == "text" else x for x, (_, k) in zip(r, fields))
               for r in rows]
    return np.array(encoded, dtype=kinds)


def add_metric(group, name, values, unit, direction):
    data = group.create_dataset(name, data=values)
    data.attrs.update(unit=unit, definition=f"What {name} is.", direction=direction)


def add_variant(parent, index, name, overlap, seconds):
    group = parent.create_group(name)
    group.attrs.update(index=index, method=name, role="method" if index else "baseline",
                       reference="", options='{"step": 0.35}', status="done")
    group["parameter"] = ANGLES
    metrics = group.create_group("metrics")
    add_metric(metrics, "overlap_excess", overlap, "m^3", "lower_is_better")
    add_metric(metrics, "volume_change", -0.001 * ANGLES * (index + 1), "1", "closer_to_target")
    summary = group.create_group("summary")
    add_metric(summary, "overlap_excess.max", np.nanmax(overlap), "m^3", "lower_is_better")
    add_metric(summary, "volume_change.min", -0.09 * (index + 1), "1", "closer_to_target")
    add_metric(summary, "rest_identity", 1e-16, "1", "lower_is_better")
    diagnostics = group.create_group("diagnostics")
    diagnostics["iterations"] = np.array([1.0, np.nan, 7.0])  # of a run before units were stored
    diagnostics["work_done"] = np.array([0.0, 0.5, 2.0])
    diagnostics["work_done"].attrs.update(unit="J", definition="Since the <start>.")
    group.create_group("timing")["solve"] = seconds * np.ones((3, 4))
    group["events"] = np.array(
        [(0.5, b"hit", (0, 0, 0), 1.0, 0.1)] * (2 * index),
        dtype=[("time_s", "f8"), ("kind", "S8"), ("position", "f8", (3,)), ("energy_J", "f8"),
               ("duration_s", "f8")])
    group["frames"] = table([(0, "frames/x.vtp", "0" * 64)],
                            [("frame", "i8"), ("name", "text"), ("sha256", "text")])
    group["artifacts"] = table([], [("name", "text"), ("sha256", "text")])


@contextlib.contextmanager
def signed(folder, mode):
    """run.h5 to be written or changed; then the journal says that it is the run's result."""
    with h5py.File(folder / "run.h5", mode) as file:
        yield file
    sha256 = hashlib.sha256((folder / "run.h5").read_bytes()).hexdigest()
    lines = [{"kind": "run"}, {"kind": "result", "name": "run.h5", "sha256": sha256}]
    (folder / "journal.jsonl").write_text("".join(json.dumps(x) + "\n" for x in lines))


def make_run(folder, title="Knee <flexion> & more"):
    with signed(folder, "w") as file:
        file.attrs.update(schema_version=1, experiment_id="test/knee", title=title, figure="3.2",
                          topic="skinning", quick=1, spec_hash="a" * 64, content_sha256="b" * 64,
                          experiment='title = "x"\n[figure_view]\nmetrics = ["overlap_excess"]\n',
                          git_commit="0123456789abcdef", cpu="A CPU", start="2026-01-01T00:00:00Z")
        file["inputs"] = table([("human.glb", "c" * 64)], [("name", "text"), ("sha256", "text")])
        case = file.create_group("cases/default")
        case.attrs.update(index=0, parameter_name="angle", parameter_unit="deg", seed=1, threads=0,
                          scene="{}", warnings=["one <warning>"])
        case.create_group("swept")
        case.create_group("facts").attrs["vertices"] = 13380.0
        case["ratios"] = table([("implicit", "dual-quaternion", 4.0, 3.9, 4.1)], [
            ("variant", "text"), ("of", "text"), ("median_ratio", "f8"), ("low", "f8"),
            ("high", "f8")])
        variants = case.create_group("variants")
        add_variant(variants, 1, "implicit", np.array([0, 1e-9, 2e-9]), 0.004)
        add_variant(variants, 0, "dual-quaternion", np.array([0, 2e-6, 4e-6]), 0.001)
        study = file.create_group("study/growth")
        study.attrs.update(index=0, kind="exponent", quantity="timing:solve", value=1.0, low=0.9,
                           high=1.1)
        study["x"], study["y"] = np.array([1e3, 1e4]), np.array([1e-3, 1e-2])
        file["claims"] = table(
            [("contact goes", "default", "1e-9 <= 2e-6", 1e-9, 2e-6, 1),
             ("bulge stays", "default", "0.03 <= 0.02", 0.03, 0.02, 0)],
            [("text", "text"), ("case", "text"), ("detail", "text"), ("left", "f8"),
             ("right", "f8"), ("holds", "i4")])
    (folder / "figure.png").write_bytes(PIXEL)


def make_processes(folder):
    """Makes the run one of processes as schema 2 has them, the second one failed."""
    with signed(folder, "a") as file:
        file.attrs["schema_version"] = 2
        case = file["cases/default"]
        for i, name in enumerate(["dual-quaternion", "implicit"]):
            variant = case["variants"][name]
            variant.attrs.update(status="failed" if i else "done",
                                 error="time 0.5 s: does not converge" if i else "")
            del variant["timing"]
            timing = variant.create_group("timing")
            timing["run"] = (1 + i) * np.array([[0.01, 0.01], [0.02, 0.02], [0.03, 0.03]])
            timing["elastic"] = np.array([[np.nan, np.nan], [0.01, 0.011], [0.02, 0.019]])
            timing["finish"] = np.array([[0.5, 0.5]])
            timing["finish:elastic"] = np.array([[0.4, 0.4]])
        del case["ratios"]
        case["ratios"] = table([("implicit", "dual-quaternion", 4.0, 3.9, 4.1, "run")], [
            ("variant", "text"), ("of", "text"), ("median_ratio", "f8"), ("low", "f8"),
            ("high", "f8"), ("paired", "text")])
        study = file.create_group("study/near")
        study.attrs.update(index=1, kind="within-spread", quantity="overlap_excess", value=0.5,
                           low=0.1, high=1.2)
        study["x"], study["y"] = np.arange(3.0), np.array([1.0, 2.0, 4.0])
        study["y_of"] = np.array([1.0, 3.0, 5.0])


RATE = 48000
ROWS = 420


def wav(samples, rate=RATE, tag=1, bits=24):
    """A WAV file by the definition of RIFF, of numbers at full scale 1 (samples x channels)."""
    samples = np.asarray(samples, float)
    frame = samples.shape[1] * bits // 8
    if tag == 3:
        data = samples.astype(f"<f{bits // 8}").tobytes()
    else:
        stored = np.round(samples * 2.0**31).astype("<i4").view(np.uint8).reshape(-1, 4)
        data = stored[:, 4 - bits // 8:].tobytes()
    return (b"RIFF" + struct.pack("<I", 36 + len(data)) + b"WAVEfmt "
            + struct.pack("<IHHIIHH", 16, tag, samples.shape[1], rate, rate * frame, frame, bits)
            + b"data" + struct.pack("<I", len(data)) + data)


def sine(frequency, amplitude, seconds=0.5):
    return amplitude * np.sin(2 * np.pi * frequency * np.arange(int(seconds * RATE)) / RATE)[:, None]


def add_sound(folder, variant, content):
    """The artifact mix.wav of a variant, and frames at times."""
    name = f"artifacts/default/{variant}/mix.wav"
    (folder / name).parent.mkdir(parents=True, exist_ok=True)
    (folder / name).write_bytes(content)
    with signed(folder, "a") as file:
        case = file["cases/default"]
        case.attrs.update(parameter_name="time", parameter_unit="s")
        group = case["variants"][variant]
        del group["parameter"]
        group["parameter"] = np.array([0.0, 0.25, 0.5])
        del group["artifacts"]
        group["artifacts"] = table([(name, hashlib.sha256(content).hexdigest())],
                                   [("name", "text"), ("sha256", "text")])
    return folder / name


class Page(HTMLParser):
    """Counts tags and collects what a page would load."""

    def __init__(self, text):
        super().__init__()
        self.tags, self.loads, self.open = [], [], []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        self.loads += [v for k, v in attrs if k in ("src", "srcset", "data") or
                       (k == "href" and tag == "link")]
        if tag not in ("meta", "img", "br"):
            self.open.append(tag)
        if tag == "img":
            assert dict(attrs).get("alt"), "a picture without alternative text"

    def handle_endtag(self, tag):
        assert self.open and self.open.pop() == tag, f"</{tag}> closes nothing"


def run_script(name, *arguments):
    """Runs a script in a child of this process, which has matplotlib already: importing it takes a second."""
    script = RESULTS / f"{name}.py"
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        sys.stdout.flush()
        sys.stderr.flush()
        child = os.fork()
        if child == 0:
            os.dup2(out.fileno(), 1)
            os.dup2(err.fileno(), 2)
            sys.stdout = open(1, "w", encoding="utf-8", closefd=False)
            sys.stderr = open(2, "w", encoding="utf-8", closefd=False)
            sys.argv = [str(script), *map(str, arguments)]
            code = 1
            try:
                runpy.run_path(str(script), run_name="__main__")
                code = 0
            except SystemExit as ended:
                code = ended.code or 0
            except BaseException:
                traceback.print_exc()
            finally:
                sys.stdout.flush()
                sys.stderr.flush()
                os._exit(code)
        code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
        out.seek(0)
        err.seek(0)
        return subprocess.CompletedProcess(sys.argv, code, out.read().decode(), err.read().decode())


class SoundTest(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="geoprior-sound-"))
        self.addCleanup(shutil.rmtree, self.folder)
        make_run(self.folder)

    def report(self, *options):
        return run_script("report", self.folder, "--out", self.folder / "report.html", *options)

    def test_every_accepted_kind_gives_its_samples(self):
        samples = np.array([[0.5, -1.0], [-0.25, 0.0], [2.0**-15, 0.75]])
        for tag, bits in [(1, 16), (1, 24), (1, 32), (3, 32), (3, 64)]:
            read = sound.read_wav(wav(samples, 44100, tag, bits), "x.wav")
            self.assertEqual(read.rate, 44100)
            np.testing.assert_array_equal(read.samples, samples)
        for broken in [b"", b"RIFF", wav(samples)[:30], wav(samples[:0]), wav(samples, bits=16, tag=6),
                       wav([[np.nan, 0.0]], tag=3, bits=32)]:
            with self.assertRaisesRegex(sound.NoSound, "x.wav"):
                sound.read_wav(broken, "x.wav")

    def test_a_sine_has_its_level_at_its_frequency_and_time(self):
        # On both sides of the change of windows and in between. The tone begins in the middle; a
        # long window reaches 21 ms from its time. A quarter of a dB is lost between two frequencies of
        # the transform and over the width of a row.
        for frequency in [60, 100, 300, 499, 501, 700, 999, 1001, 2000]:
            tone = np.concatenate([np.zeros((RATE // 4, 1)), sine(frequency, 0.5)])
            times, edges, levels = sound.spectrogram(sound.Sound(RATE, tone), ROWS)
            steady = (times > 0.28) & (times < 0.72)
            loudest = levels[:, steady].argmax(axis=0)
            np.testing.assert_allclose(np.sqrt(edges[loudest] * edges[loudest + 1]), frequency, rtol=0.02)
            np.testing.assert_allclose(levels.max(axis=0)[steady], 20 * np.log10(0.5), atol=0.25)
            self.assertLess(levels[:, times < 0.22].max(), -200)
        # A Hann peak holds 1.5 bins, of 94 Hz, of power: what a row of 285 Hz at 20 kHz makes of it.
        high = sound.spectrogram(sound.Sound(RATE, sine(19900, 1)), ROWS)[2]
        self.assertAlmostEqual(high[:, 90].max(), 10 * np.log10(1.5 * 93.75 / 285), delta=0.2)

    def test_channels_are_averaged_in_power(self):
        tone = sine(1000, 0.5)
        one = sound.spectrogram(sound.Sound(RATE, tone), ROWS)[2]
        both = sound.spectrogram(sound.Sound(RATE, np.hstack([tone, 0 * tone])), ROWS)[2]
        np.testing.assert_allclose(both, one - 10 * np.log10(2), atol=1e-9)

    def test_tones_of_100_and_200_hz_are_told_apart(self):
        tones = sine(100, 0.5) + sine(200, 0.5)
        _, edges, levels = sound.spectrogram(sound.Sound(RATE, tones), ROWS)
        steady = levels[:, 20:-20]
        low, between, high = steady[np.searchsorted(edges, [100, 150, 200]) - 1]
        self.assertGreater(min(low.min(), high.min()) - between.max(), 20)

    def test_rows_are_means_over_their_frequencies(self):
        # The mean of a straight line over an interval is its value in the middle, whether the row is
        # narrower or wider than a bin.
        edges = np.concatenate([np.linspace(0, 3, 17), np.geomspace(3.4, 63, 9)])
        means = sound.row_means(edges, 64)
        np.testing.assert_allclose(means.sum(axis=1), 1, rtol=1e-12)
        np.testing.assert_allclose(means @ np.arange(64), (edges[:-1] + edges[1:]) / 2, rtol=1e-12)
        np.testing.assert_allclose(sound.row_means(np.array([9.5, 19.5]), 64)[0, 11:19], 0.1, rtol=1e-12)

    def test_noise_is_even_over_frequency_on_both_sides_of_the_change(self):
        # Power of a Hann window of N samples, against a sine: variance sum w^2 / (sum w / 2)^2 = 6 / N.
        noise = np.random.default_rng(7).normal(0, 0.1, (10 * RATE, 1))
        _, edges, levels = sound.spectrogram(sound.Sound(RATE, noise), ROWS)
        means = 10 * np.log10((10**(levels / 10)).mean(axis=1))
        for window, rows in [(2048, edges[1:] < 500), (512, edges[:-1] > 1000)]:
            np.testing.assert_allclose(means[rows], 10 * np.log10(0.01 * 6 / window), atol=1)
            self.assertAlmostEqual(means[rows].mean(), 10 * np.log10(0.01 * 6 / window), delta=0.2)
        self.assertLess(np.abs(np.diff(means)).max(), 1)  # no seam

    def test_a_click_is_as_long_as_the_windows_of_its_frequencies(self):
        samples = np.zeros((RATE // 2, 1))
        samples[RATE // 4 - RATE // 4 % 128] = 1  # a time of the spectra
        times, edges, levels = sound.spectrogram(sound.Sound(RATE, samples), ROWS)
        # Amplitude 1 / (sum w / 2) = 4 / N at all frequencies.
        for window, rows in [(512, edges[:-1] > 1000), (2048, edges[1:] < 500)]:
            away = np.abs(times - times[93]) > (window / 2 - 0.5) / RATE
            self.assertLess(levels[rows][:, away].max(), -200)
            np.testing.assert_allclose(levels[rows].max(axis=1), 20 * np.log10(4 / window), atol=1e-6)

    def test_a_click_stays_when_columns_are_joined(self):
        samples = np.zeros((20 * RATE, 1))  # more windows than are transformed at once
        samples[13 * RATE] = 1
        click = sound.Sound(RATE, samples)
        times, _, levels = sound.spectrogram(click, 40)
        self.assertEqual(times[levels.max(axis=0).argmax()], 13)
        few_times, _, few = sound.spectrogram(click, 40, 60)
        self.assertEqual(few.shape[1], 60)
        loudest = few.max(axis=0).argmax()
        self.assertEqual(few[:, loudest].max(), levels.max())
        self.assertTrue(few_times[loudest] <= 13 < few_times[loudest + 1])
        np.testing.assert_allclose(few.max(axis=1), levels.max(axis=1), atol=1)

    def test_report_plays_the_sound_as_it_was_recorded(self):
        content = wav(sine(1000, 0.5))
        add_sound(self.folder, "implicit", content)
        self.assertEqual(self.report().returncode, 0)
        text = (self.folder / "report.html").read_text(encoding="utf-8")
        page = Page(text)
        self.assertEqual(page.tags.count("audio"), 1)
        self.assertIn("data:audio/wav;base64," + base64.b64encode(content).decode(), page.loads)
        self.assertIn("0.500 s, 48 kHz, mono", text)
        self.assertEqual(sum(v.startswith("data:image/png") for v in page.loads), 2)

    def test_a_sound_that_is_not_what_was_recorded_is_refused(self):
        file = add_sound(self.folder, "implicit", wav(sine(1000, 0.5)))
        other = wav(sine(2000, 0.5))
        file.write_bytes(other)
        for name in ("report", "spectrogram"):
            refused = run_script(name, self.folder)
            self.assertEqual(refused.returncode, 2)
            self.assertIn(f"{file}: is damaged or another file", refused.stderr)
        self.assertEqual(self.report("--force").returncode, 0)
        file.unlink()
        file.symlink_to(self.folder / "figure.png")
        self.assertIn("symbolic link", self.report().stderr)

    def test_a_sound_of_another_kind_is_played_but_not_drawn(self):
        add_sound(self.folder, "implicit", wav(sine(1000, 0.5), bits=8, tag=6))
        self.assertEqual(self.report().returncode, 0)
        text = (self.folder / "report.html").read_text(encoding="utf-8")
        self.assertIn("No spectrogram", text)
        self.assertEqual(Page(text).tags.count("audio"), 1)

    def test_spectrogram_is_the_same_twice_and_frames_make_it_higher(self):
        for i, variant in enumerate(["dual-quaternion", "implicit"]):
            add_sound(self.folder, variant, wav(sine(1000, 0.5 / (1 + i))))
        self.assertEqual(run_script("spectrogram", self.folder).returncode, 0)
        picture = self.folder / "spectrogram.png"
        once = picture.read_bytes()
        run_script("spectrogram", self.folder)
        self.assertEqual(picture.read_bytes(), once)
        strip = np.ones((2 * 30, 3 * 40, 3))
        plots.plt.imsave(self.folder / "strip.png", strip)
        drawn = run_script("spectrogram", self.folder, "--frames", self.folder / "strip.png",
                           "--times", "0.1,0.25,0.4")
        self.assertEqual(drawn.returncode, 0, drawn.stderr)
        self.assertGreater(plots.plt.imread(picture).shape[0], plots.plt.imread(io.BytesIO(once)).shape[0] + 100)

    def test_all_variants_have_one_range_of_colours(self):
        for amplitude, variant in [(1.0, "dual-quaternion"), (0.01, "implicit")]:
            add_sound(self.folder, variant, wav(sine(1000, amplitude), tag=3, bits=32))
        run = runfile.read_run(self.folder)
        with plots.plt.rc_context(plots.STYLE):
            figure = spectrogram.draw(run, run.cases[0], run.cases[0].variants)
        limits = {image.get_clim() for axes in figure.axes for image in axes.images}
        self.assertEqual(limits, {(-spectrogram.RANGE_DB, 0)})
        spectra = [axes for axes in figure.axes if axes.images]
        self.assertEqual(len(spectra), 2)
        self.assertEqual(spectra[0].get_xlim(), spectra[1].get_xlim())
        self.assertEqual(spectra[1].get_xlabel(), "time [s]")
        self.assertEqual(spectra[1].get_ylabel(), "frequency [Hz]")
        plots.plt.close(figure)

    def test_frequencies_are_on_a_logarithmic_axis(self):
        # Up to half the rate; a sound without any of these frequencies is drawn all the same.
        for rate, last in [(RATE, "20 k"), (8000, "2 k"), (60, None)]:
            add_sound(self.folder, "implicit", wav(np.full((rate, 1), 0.5), rate))
            run = runfile.read_run(self.folder)
            with plots.plt.rc_context(plots.STYLE):
                figure = spectrogram.draw(run, run.cases[0], [run.cases[0].variant("implicit")])
            axes = figure.axes[-2]
            labels = [label.get_text() for label in axes.get_yticklabels()]
            every = ["50", "100", "200", "500", "1 k", "2 k", "5 k", "10 k", "20 k"]
            self.assertEqual(labels, every[:every.index(last) + 1] if last else [])
            plots.plt.close(figure)

    def test_a_tone_is_drawn_at_its_frequency(self):
        for frequency in (100, 1000, 10000):
            add_sound(self.folder, "implicit", wav(sine(frequency, 0.5)))
            run = runfile.read_run(self.folder)
            with plots.plt.rc_context(plots.STYLE):
                figure = spectrogram.draw(run, run.cases[0], [run.cases[0].variant("implicit")])
            axes = figure.axes[-2]
            ticks = {label.get_text(): axes.transData.transform((0.25, at))
                     for at, label in zip(axes.get_yticks(), axes.get_yticklabels())}
            column, line = ticks[spectrogram.frequency_label(frequency)]
            figure.canvas.draw()
            pixels = np.asarray(figure.canvas.buffer_rgba())[::-1, int(column), :3].sum(axis=1, dtype=int)
            low, high = round(ticks["50"][1]) + 2, round(ticks["20 k"][1]) - 2
            self.assertAlmostEqual(low + pixels[low:high].argmax(), line, delta=3)
            plots.plt.close(figure)

    def test_many_events_get_thin_ticks(self):
        self.assertEqual(spectrogram.tick_width(20), 0.9)
        self.assertAlmostEqual(spectrogram.tick_width(500) * spectrogram.DPI / 72, 1)  # a pixel

    def test_events_are_ticks_at_their_times_by_kind(self):
        add_sound(self.folder, "implicit", wav(sine(1000, 0.5, 2)))
        with signed(self.folder, "a") as file:
            group = file["cases/default/variants/implicit"]
            kind = group["events"].dtype
            del group["events"]
            group["events"] = np.array([(0.5, b"tear", (0, 0, 0), 1, 0), (1.5, b"flap", (0, 0, 0), 1, 0),
                                        (0.75, b"flap", (0, 0, 0), 1, 0)], dtype=kind)
        run = runfile.read_run(self.folder)
        with plots.plt.rc_context(plots.STYLE):
            figure = spectrogram.draw(run, run.cases[0], [run.cases[0].variant("implicit")])
        ticks = [sorted(segment[0][0] for segment in lane.get_segments())
                 for lane in figure.axes[0].collections]
        self.assertEqual(ticks, [[0.75, 1.5], [0.5]])
        self.assertEqual([t.get_text() for t in figure.legends[0].get_texts()], ["Flap", "Tear"])
        plots.plt.close(figure)

    def test_silence_is_drawn_and_a_run_without_sound_says_so(self):
        none = run_script("spectrogram", self.folder)
        self.assertEqual((none.returncode, none.stderr.count("\n")), (2, 1))
        self.assertIn("no sound", none.stderr)
        self.assertEqual(self.report().returncode, 0)
        self.assertNotIn("<h2>Sound", (self.folder / "report.html").read_text(encoding="utf-8"))
        add_sound(self.folder, "implicit", wav(np.zeros((RATE, 2))))
        self.assertEqual(run_script("spectrogram", self.folder).returncode, 0)


class RunTest(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="geoprior-report-"))
        self.addCleanup(shutil.rmtree, self.folder)
        make_run(self.folder)

    def test_variants_come_in_the_order_of_the_experiment(self):
        run = runfile.read_run(self.folder)
        self.assertEqual(run.variant_names(), ["dual-quaternion", "implicit"])
        self.assertEqual(run.provenance["cpu"], "A CPU")
        self.assertEqual([c.holds for c in run.claims], [True, False])

    def test_report_is_one_file_that_loads_nothing(self):
        report.main([str(self.folder), "--out", str(self.folder / "report.html")])
        text = (self.folder / "report.html").read_text(encoding="utf-8")
        page = Page(text)
        self.assertEqual(page.open, [])
        self.assertNotIn("script", page.tags)
        self.assertTrue(page.loads)
        self.assertTrue(all(v.startswith("data:image/") for v in page.loads))
        self.assertIsNone(re.search(r"@import|url\(", text))
        self.assertTrue(base64.b64encode(PIXEL).decode() in text)

    def test_report_says_what_the_run_says(self):
        report.main([str(self.folder), "--out", str(self.folder / "report.html")])
        text = (self.folder / "report.html").read_text(encoding="utf-8")
        for expected in ("Claims: holds in 1, falls short in 1", "falls short", "0.03 &lt;= 0.02",
                         "Knee &lt;flexion&gt; &amp; more", "one &lt;warning&gt;",
                         "4.00 [3.90, 4.10] × Dual quaternion", "1.00 ms", "c" * 64, "quick version",
                         "geoprior run test/knee --quick", "Overlap excess, max [cm³]"):
            self.assertTrue(expected in text, expected)
        self.assertTrue("<b>0.00200</b>" in text)  # the best overlap, in cm³, is marked

    def test_report_gives_unit_and_meaning_of_diagnostics(self):
        report.main([str(self.folder), "--out", str(self.folder / "report.html")])
        page = (self.folder / "report.html").read_text(encoding="utf-8")
        self.assertIn('<span title="Since the &lt;start&gt;.">Work done [J]</span>', page)
        self.assertIn('<span title="">Iterations</span>', page)

    def test_several_runs_have_contents_and_a_comparison(self):
        other = self.folder / "other"
        other.mkdir()
        make_run(other, "Second")
        out = self.folder / "both.html"
        report.main([str(self.folder), str(other), "--out", str(out)])
        text = out.read_text(encoding="utf-8")
        Page(text)
        self.assertTrue("Shared variants" in text)
        for anchor in re.findall(r'href="#([^"]+)"', text):
            self.assertTrue(f'id="{anchor}"' in text, anchor)

    def test_damaged_run_is_one_clear_line_and_exit_code_2(self):
        whole = (self.folder / "run.h5").read_bytes()
        for content in (whole[:len(whole) // 2], b"", b"no HDF5 at all"):
            (self.folder / "run.h5").write_bytes(content)
            with self.assertRaisesRegex(runfile.RunFileError, "run.h5: is damaged or another"):
                runfile.read_run(self.folder)
            with self.assertRaisesRegex(runfile.RunFileError, "run.h5: damaged"):
                runfile.read_run(self.folder, force=True)
        done = run_script("report", self.folder)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertEqual(len(done.stderr.strip().splitlines()), 1, done.stderr)
        self.assertIn(str(self.folder / "run.h5"), done.stderr)
        self.assertFalse((self.folder / "report.html").exists())

    def test_run_without_its_journal_needs_force(self):
        (self.folder / "journal.jsonl").unlink()
        with self.assertRaisesRegex(runfile.RunFileError, "run.h5: its checksum is not in the journal"):
            runfile.read_run(self.folder)
        self.assertEqual(runfile.read_run(self.folder, force=True).experiment_id, "test/knee")

    def test_values_in_other_places_are_refused(self):
        def soft(file):
            file["cases/default/other"] = h5py.SoftLink("/cases/default")

        def external_link(file):
            file["cases/default/other"] = h5py.ExternalLink("/etc/passwd", "/")

        def external_values(file):
            file.create_dataset("cases/default/other", (1,), "u1", external=[("/etc/passwd", 0, 1)])

        for change, word in ((soft, "link"), (external_link, "link"), (external_values, "another file")):
            with self.subTest(change.__name__):
                make_run(self.folder)
                with signed(self.folder, "a") as file:
                    change(file)
                with self.assertRaisesRegex(runfile.RunFileError, word):
                    runfile.read_run(self.folder)

    def test_missing_part_of_a_run_names_the_file(self):
        with signed(self.folder, "a") as file:
            del file["claims"]
        with self.assertRaisesRegex(runfile.RunFileError, "run.h5"):
            runfile.read_run(self.folder)

    def test_plots_are_the_same_bytes_twice(self):
        self.assertEqual(run_script("plots", self.folder).returncode, 0)
        svg = (self.folder / "metrics.svg").read_text(encoding="utf-8")
        self.assertEqual(svg, plots.figures(runfile.read_run(self.folder))["metrics"])
        ElementTree.fromstring(svg)

    def test_a_metric_that_is_zero_throughout_has_a_readable_axis(self):
        case = runfile.read_run(self.folder).cases[0]
        for variant in case.variants:
            variant.metrics["overlap_excess"].values[:] = 0
        figure, axes = plots.plt.subplots()
        names = [v.name for v in case.variants]
        look = {n: {} for n in names}
        plots.draw_metric(axes, case, "overlap_excess", names, look)
        self.assertEqual(list(axes.get_yticks()), [0])
        low, high = axes.get_ylim()
        self.assertTrue(-0.5 < low < 0 < 0.5 < high, (low, high))
        plots.plt.close(figure)

    def test_figure_view_selects_the_curves(self):
        run = runfile.read_run(self.folder)
        self.assertEqual(plots.frame_metrics(run), ["overlap_excess"])
        run.view = {}
        self.assertEqual(plots.frame_metrics(run), ["overlap_excess", "volume_change"])

    def test_unwritable_target_leaves_nothing_behind(self):
        with self.assertRaisesRegex(runfile.RunFileError, "cannot be written"):
            report.main([str(self.folder), "--out", str(self.folder / "absent" / "page.html")])

    def test_summary_names_claims_and_times(self):
        summary.main([str(self.folder)])
        text = (self.folder / "summary.md").read_text(encoding="utf-8")
        self.assertIn("**falls short**: bulge stays", text)
        self.assertIn("4.00 ms", text)

    def test_summary_has_no_markup_of_a_stranger(self):
        # In each text a mark of its own, and one that ends the cell, the code or the line that it stands in.
        marks = iter(f"<script>{i}</script> ![p](http://evil/{i}.png) | `c` **b** \n# h \u202e" for i in range(99))
        shutil.rmtree(self.folder)
        self.folder.mkdir()
        make_run(self.folder, title=next(marks))
        with signed(self.folder, "a") as file:
            file.attrs.update(experiment_id=next(marks), git_commit=next(marks), start=next(marks), figure=next(marks))
            case = file["cases/default"]
            case.attrs["warnings"] = [next(marks)]
            case["variants/implicit"].attrs.update(status="failed", error=next(marks))
            first = case["variants/dual-quaternion"]
            for group, old in ((case["variants"], "implicit"), (first["metrics"], "overlap_excess"),
                               (first["timing"], "solve"), (file["study"], "growth"), (file["cases"], "default")):
                group.move(old, quote(next(marks), safe=""))
            file["study/" + list(file["study"])[0]].attrs.update(kind=next(marks), quantity=next(marks))
            del file["claims"]
            claim = (next(marks), "default", next(marks), 1.0, 2.0, 0, next(marks), "void", next(marks))
            fields = zip(("text", "case", "detail", "left", "right", "holds", "null", "null_verdict", "null_detail"),
                         ("text", "text", "text", "f8", "f8", "i4", "text", "text", "text"))
            file["claims"] = table([claim], list(fields))
            file.copy("cases/" + list(file["cases"])[0], "cases/second")
        summary.main([str(self.folder)])
        text = (self.folder / "summary.md").read_text(encoding="utf-8")
        shown = re.sub(r"(?<!`)(`+)(?!`)[^\n]*?(?<!`)\1(?!`)", "", re.sub(r"\\[!-/:-@[-`{-~]", "", text))
        self.assertGreater(text.count("&lt;script&gt;"), 15)
        for mark in ("<script", "![", "](", "**b", "\n# h", "\u202e"):
            self.assertNotIn(mark, shown)
        for rows in re.findall(r"(?:^\|.*\n)+", shown, re.MULTILINE):
            self.assertEqual(len({row.count("|") for row in rows.splitlines()}), 1, rows)

    def test_texts_are_escaped_as_in_the_pages_of_a_comparison(self):
        samples = json.loads(Path(__file__).with_name("foreign_texts.json").read_text(encoding="utf-8"))
        for sample in samples:
            self.assertEqual(printable(sample["text"]), sample["printable"])
            self.assertEqual(markdown_text.escaped(sample["text"]), sample["markdown"])
        self.assertEqual([markdown_text.code(text) for text in ("a", "a`b``c", "a\n\nb")],
                         ["`a`", "``` a`b``c ```", "`a  b`"])
        self.assertEqual(markdown_text.table(["a|b", "c"], [[r"d\|e", 1]]),
                         [r"| a\|b | c |", "|---|---:|", r"| d\|e | 1 |"])

    def test_peak_memory_is_shown_where_it_was_measured(self):
        summary.main([str(self.folder)])
        self.assertNotIn("peak memory", (self.folder / "summary.md").read_text(encoding="utf-8"))
        with signed(self.folder, "a") as file:
            variants = file["cases/default/variants"]
            attrs = variants[list(variants)[0]].attrs
            attrs["memory_start"], attrs["memory_peak"] = np.uint64(100e6), np.uint64(164e6)
        report.main([str(self.folder), "--out", str(self.folder / "report.html")])
        summary.main([str(self.folder)])
        for name in ("report.html", "summary.md"):
            text = (self.folder / name).read_text(encoding="utf-8")
            self.assertIn("eak memory", text)
            self.assertIn("64.0 MB", text)

    def test_processes_have_times_of_frames(self):
        make_processes(self.folder)
        run = runfile.read_run(self.folder)
        first, second = tables.timing_rows(run.cases[0])
        self.assertEqual((first.phase, first.times.median, first.count), ("frame", 0.02, 6))
        # numpy.percentile([0.01, 0.01, 0.02, 0.02, 0.03, 0.03], 95) = 0.03
        self.assertEqual(first.times.p95, 0.03)
        self.assertAlmostEqual(first.whole, 0.01 + 0.02 + 0.03 + 0.5)
        self.assertEqual([r.paired for r in second.ratios], ["run"])
        self.assertEqual([p for _, p, _ in tables.phase_rows(run.cases[0])], ["elastic"] * 2)
        drawn = plots.figures(run)
        self.assertEqual(list(drawn), ["metrics", "times", "studies"])
        for svg in drawn.values():
            ElementTree.fromstring(svg)
        report.main([str(self.folder), "--out", str(self.folder / "report.html")])
        text = (self.folder / "report.html").read_text(encoding="utf-8")
        Page(text)
        for expected in ("20.0 ms", "560 ms", "× Dual quaternion (whole runs)",
                         "Implicit failed after 3 frames: time 0.5 s: does not converge"):
            self.assertTrue(expected in text, expected)
        summary.main([str(self.folder)])
        self.assertIn("**Implicit failed after 3 frames: time 0.5 s",
                      (self.folder / "summary.md").read_text(encoding="utf-8"))

    def test_a_variant_without_a_frame_could_not_run(self):
        refused = SimpleNamespace(name="implicit", status="failed", error="an open mesh", parameter=[])
        broken = SimpleNamespace(name="hybrid", status="failed", error="", parameter=[0.0])
        run = SimpleNamespace(cases=[SimpleNamespace(name="default", variants=[refused, broken])])
        self.assertEqual(tables.failures(run),
                         ["Implicit cannot run: an open mesh", "Hybrid failed after 1 frame"])

    def test_nothing_is_read_or_written_through_a_link(self):
        victim = self.folder.with_name(self.folder.name + "-victim")
        self.addCleanup(lambda: victim.unlink(missing_ok=True))
        victim.write_text("years of work", encoding="utf-8")
        for name in ("report.html", "report.html.geoprior-tmp", "summary.md", "summary.md.geoprior-tmp"):
            (self.folder / name).unlink(missing_ok=True)
            (self.folder / name).symlink_to(victim)
        report.main([str(self.folder), "--out", str(self.folder / "report.html")])
        summary.main([str(self.folder)])
        self.assertEqual(victim.read_text(encoding="utf-8"), "years of work")
        self.assertFalse((self.folder / "report.html").is_symlink())
        (self.folder / "figure.png").unlink(missing_ok=True)
        (self.folder / "figure.png").symlink_to(victim)
        with self.assertRaisesRegex(runfile.RunFileError, "figure.png: is a symbolic link"):
            report.main([str(self.folder), "--out", str(self.folder / "report.html")])

    def test_a_version_this_program_does_not_know_is_refused(self):
        with signed(self.folder, "a") as file:
            file.attrs["schema_version"] = 99
        with self.assertRaisesRegex(runfile.RunFileError, "schema version 99"):
            runfile.read_run(self.folder)

    def test_worst_value_follows_the_direction(self):
        rows = {r.name: r for r in tables.metric_rows(runfile.read_run(self.folder).cases[0])}
        self.assertEqual(rows["Overlap excess, max"].cells, ["4.00", "0.00200"])
        self.assertEqual(rows["Overlap excess, max"].best, [False, True])
        self.assertEqual(rows["Volume change, range"].best, [False, False])


class WordingTest(unittest.TestCase):
    def test_numbers_have_three_significant_digits(self):
        for value, expected in [(0.0123456, "0.0123"), (-4.0, "−4"), (13380.0, "13\u202f380"),
                                (1.5e-9, "1.50·10⁻⁹"), (float("nan"), "–"), (0.0, "0"),
                                (0.99999, "1.00"), (123.456, "123"), (1.2345e9, "1.23·10⁹")]:
            self.assertEqual(wording.number(value), expected)

    def test_names_are_written_as_one_reads_them(self):
        for name, read in {"dcone_count": "d-cone count", "isometry_rms": "Isometry RMS",
                           "dual-quaternion": "Dual quaternion", "x": "X", "": "",
                           "area_ratio_p95": "Area ratio (95 %)"}.items():
            self.assertEqual(wording.display_name(name), read)

    def test_units_take_the_step_that_reads_easily(self):
        self.assertEqual(wording.with_unit(0.00312, "s"), "3.12 ms")
        self.assertEqual(wording.with_unit(2.5e-6, "m^3"), "2.50 cm³")
        self.assertEqual(wording.with_unit(90.0, "deg"), "90°")
        self.assertEqual(wording.with_unit(0.5, "1"), "0.500")


if __name__ == "__main__":
    unittest.main()
