"""Texts of files as a page or a terminal can show them."""

import unicodedata


def printable(text: str) -> str:
    """The text without what neither a page nor a terminal can show: bytes that were no UTF-8 and
    control characters but line ends and tabs become `\\xNN`."""
    text = text.encode("utf-8", "surrogateescape").decode("utf-8", "backslashreplace")
    return "".join(f"\\x{ord(c):02x}" if unicodedata.category(c) == "Cc" and c not in "\n\t" else c
                   for c in text)
