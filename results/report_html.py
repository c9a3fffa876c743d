"""The HTML that the report is made of: page, tables, inlined pictures."""

import base64
import html
from pathlib import Path

import runfile
from geoprior_results.texts import printable

# What a page holds at most: what is beyond stays in run.h5, and the page says so where it was cut.
MOST_CHARACTERS = 2000        # of a text
MOST_LONG_CHARACTERS = 200_000  # of a whole experiment, of the options of a variant
MOST_ROWS = 500
MOST_COLUMNS = 64
MOST_CASES = 100
MOST_RUNS = 100
MOST_PICTURE_BYTES = 50_000_000
MOST_SOUNDS = 24              # of a run
MOST_SOUND_BYTES = 20_000_000  # of each


def escape(text, most=MOST_CHARACTERS):
    """The text as HTML, cut where it is longer than `most` characters."""
    text = str(text)
    more = f" … ({len(text) - most} more characters in run.h5)" if len(text) > most else ""
    return html.escape(printable(text[:most]) + more)


def left_out(count, what):
    """A line that says what the page does not hold; nothing when it holds all."""
    return f'<p class="note">{count} more {what} in run.h5.</p>' if count > 0 else ""


def page(title, body):
    css = Path(__file__).with_name("report.css").read_text(encoding="utf-8")
    return ("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
            "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
            f"<title>{escape(title)}</title>\n<style>\n{css}</style>\n</head>\n<body>\n{body}\n"
            "</body>\n</html>\n")


def table(head, rows, classes=()):
    """A table that scrolls when it is wide. Cells are HTML; `classes` name one class a column."""
    def cells(tag, row):
        row = row[:MOST_COLUMNS]
        names = list(classes) + [""] * (len(row) - len(classes))
        return "".join(f'<{tag} class="{c}">{x}</{tag}>' if c else f"<{tag}>{x}</{tag}>"
                       for x, c in zip(row, names))
    header = f"<thead><tr>{cells('th', head)}</tr></thead>" if head else ""
    lines = "\n".join(f"<tr>{cells('td', row)}</tr>" for row in rows[:MOST_ROWS])
    width = max((len(row) for row in [head, *rows]), default=0)
    return (f'<div class="scroll"><table>{header}<tbody>\n{lines}\n</tbody></table></div>'
            + left_out(len(rows) - MOST_ROWS, "rows") + left_out(width - MOST_COLUMNS, "columns"))


def details(summary, content, is_open=False):
    return (f"<details{' open' if is_open else ''}><summary>{escape(summary)}</summary>\n"
            f"{content}\n</details>")


def data_uri(content, kind):
    return f"data:{kind};base64,{base64.b64encode(content).decode('ascii')}"


def figure(uri, alt, caption):
    return (f'<figure><img src="{uri}" alt="{escape(alt)}">'
            f"<figcaption>{caption}</figcaption></figure>")


def png_figure(path, alt, caption):
    """An inlined PNG; nothing when the run has none. A link is not followed: it may lead out of the run."""
    if path.is_symlink():
        raise runfile.RunFileError(f"{path}: is a symbolic link: below a run none is followed")
    runfile.require_regular_file(path)
    try:
        if path.stat().st_size > MOST_PICTURE_BYTES:
            return (f'<p class="note">{escape(path.name)} has more than '
                    f"{MOST_PICTURE_BYTES // 1_000_000} MB: it is in the run's folder.</p>")
        content = path.read_bytes()
    except FileNotFoundError:
        return ""
    except OSError as error:
        raise runfile.RunFileError(f"{path}: cannot be read ({error.strerror})") from error
    if not content.startswith(runfile.PNG_SIGNATURE):
        return f'<p class="note">{escape(path.name)} is no PNG: <code>geoprior render</code> draws it anew.</p>'
    return image_figure(content, alt, caption)


def image_figure(png, alt, caption):
    """A PNG that was drawn for the page."""
    return figure(data_uri(png, "image/png"), alt, caption)


def player(wav, caption):
    """A WAV file to be played on the page."""
    return (f'<figure><audio controls src="{data_uri(wav, "audio/wav")}"></audio>'
            f"<figcaption>{caption}</figcaption></figure>")


def svg_figure(svg, alt, caption):
    return figure(data_uri(svg.encode("utf-8"), "image/svg+xml"), alt, caption)
