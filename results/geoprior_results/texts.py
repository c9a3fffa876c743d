"""Texts of files as a page or a terminal can show them."""

import re

# Control characters but line end and tab, Unicode's Bidi_Control, which let a text look like another, and its own
# ends of lines and paragraphs.
NOT_SHOWN = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069]")


# Halves of characters that JSON can have, which are no bytes of a file.
HALVES = re.compile("[\ud800-\udc7f\udd00-\udfff]")


def decoded(text: str) -> str:
    """The text with bytes that were no UTF-8 as `\\xNN`."""
    return HALVES.sub("\ufffd", text).encode("utf-8", "surrogateescape").decode("utf-8", "backslashreplace")


def printable(text: str) -> str:
    """The text with `\\xNN` for each byte of what neither a page nor a terminal should show as it is: what is no UTF-8,
    or in NOT_SHOWN. As `printable` of testbed/streams.h."""
    return NOT_SHOWN.sub(lambda found: "".join(f"\\x{byte:02x}" for byte in found[0].encode()), decoded(text))
