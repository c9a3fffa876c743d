"""The HTML that the report is made of: page, tables, inlined pictures."""

import base64
import html
from pathlib import Path

import runfile


def escape(text):
    return html.escape(str(text))


def page(title, body):
    css = Path(__file__).with_name("report.css").read_text(encoding="utf-8")
    return ("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
            "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
            f"<title>{escape(title)}</title>\n<style>\n{css}</style>\n</head>\n<body>\n{body}\n"
            "</body>\n</html>\n")


def table(head, rows, classes=()):
    """A table that scrolls when it is wide. Cells are HTML; `classes` name one class a column."""
    def cells(tag, row):
        names = list(classes) + [""] * (len(row) - len(classes))
        return "".join(f'<{tag} class="{c}">{x}</{tag}>' if c else f"<{tag}>{x}</{tag}>"
                       for x, c in zip(row, names))
    header = f"<thead><tr>{cells('th', head)}</tr></thead>" if head else ""
    lines = "\n".join(f"<tr>{cells('td', row)}</tr>" for row in rows)
    return f'<div class="scroll"><table>{header}<tbody>\n{lines}\n</tbody></table></div>'


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
    try:
        content = path.read_bytes()
    except FileNotFoundError:
        return ""
    except OSError as error:
        raise runfile.RunFileError(f"{path}: cannot be read ({error.strerror})") from error
    return figure(data_uri(content, "image/png"), alt, caption)


def svg_figure(svg, alt, caption):
    return figure(data_uri(svg.encode("utf-8"), "image/svg+xml"), alt, caption)
