"""English texts of other processes, recognised by their pattern and said in the language of the window.

Job: `Patterns`: a text is matched against templates ("heating to {0} °C"); the one that fits is translated
and filled with what stood in the text. What no template fits is shown as it came. Not its job: which texts
there are (`rigctl.gui.rig.phases`, `rigctl.gui.pages.sequence.check_words`).
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from functools import lru_cache

from PySide6.QtCore import QCoreApplication

_PLACE = re.compile(r"\{\d\}")
LONGEST = 2000
"""Longer texts are nobody's sentence."""


class Patterns:
    """Templates of one translation context; the first that fits counts.

    Placeholders stand in their order: {0}, {1}, …; what stands in their place is translated too when it is a
    known text of its own. A capital first letter and a full stop at the end may be missing in the template.
    """

    def __init__(self, context: str, templates: Iterable[object]) -> None:
        self.context = context
        self.templates = tuple(str(template) for template in templates)
        self._regexes = [(_regex(template), template) for template in self.templates]
        self._find = lru_cache(maxsize=512)(self._search)

    def template_of(self, text: str) -> str:
        """The template that fits the whole text; empty when none does."""
        found = self._find(text) or self._find(text.removesuffix("."))
        return found[0] if found else ""

    def say(self, text: str) -> str:
        """The text in the language of the window; as it came when nothing fits."""
        for form in (text, text.removesuffix(".")):
            if (found := self._find(form)) is not None:
                return self._filled(form, *found) + text[len(form) :]
        return text

    def _filled(self, text: str, template: str, values: tuple[str, ...]) -> str:
        said = QCoreApplication.translate(self.context, template)
        if values:
            said = said.format(*(self.say(value) for value in values))
        elif said == template:
            return text
        capital = text[:1].isupper() and said[:1].isalpha()
        return said[:1].upper() + said[1:] if capital else said

    def _search(self, text: str) -> tuple[str, tuple[str, ...]] | None:
        if not text or len(text) > LONGEST:
            return None
        for regex, template in self._regexes:
            if found := regex.fullmatch(text):
                return template, found.groups()
        return None


def _regex(template: str) -> re.Pattern[str]:
    first, rest = template[:1], template[1:]
    head = f"[{re.escape(first.lower())}{re.escape(first.upper())}]" if first.isalpha() else re.escape(first)
    if first == "{":
        head, rest = "", template
    parts = (re.escape(part) for part in _PLACE.split(rest))
    return re.compile(head + "(.+?)".join(parts), re.DOTALL)
