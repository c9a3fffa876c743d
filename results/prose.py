"""Pages without what is no prose: matches become blanks, so that every other character stays where it was."""

import re

FENCED = re.compile(r"^```.*?^```", re.DOTALL | re.MULTILINE)


def blank(text, pattern):
    return pattern.sub(lambda m: re.sub(r"[^\n]", " ", m[0]), text)


def without_code(text):
    """The page with its fenced code blank."""
    return blank(text, FENCED)
