"""The pictures of the window in `docs/images/window`, by a guided tour; made small. ``make screenshots``.

Job: run the tour in virtual time in both looks, keep the pictures that the documents show. Not its job: the
tour.
"""

import sys
import tempfile
from pathlib import Path

from PIL import Image
from tour_screen import MISSING, screen, tour

OUT = Path(__file__).resolve().parents[3] / "docs" / "images" / "window"
LIGHT = (
    "manual-empty", "manual-dragging", "manual-tripped", "sequence", "sequence-fault", "run", "data",
    "data-figures",
    "model", "model-map", "model-helps", "service-laboratory", "service-calibrations", "service-alarms",
    "service-journal",
)  # fmt: skip
DARK = ("manual-dragging", "run", "model")
COLOURS = 224


def main() -> int:
    if MISSING:
        print(f"not installed: {', '.join(MISSING)} (sudo sh .ci/system-packages --install)", file=sys.stderr)
        return 1
    OUT.mkdir(parents=True, exist_ok=True)
    for theme, names in (("light", LIGHT), ("dark", DARK)):
        with tempfile.TemporaryDirectory() as folder, screen() as display:
            more = ["--gallery"] if theme == "light" else []
            where = ["--data", f"{folder}/data", "--pictures", f"{folder}/pictures"]
            done = tour(display, *where, "--theme", theme, *more, timeout_s=1200)
            if done.returncode:
                print(done.stderr, file=sys.stderr)
                return 1
            for name in names:
                ending = "" if theme == "light" else "-dark"
                made = Image.open(f"{folder}/pictures/{name}.png").convert("RGB")
                small = made.quantize(COLOURS, dither=Image.Dither.NONE)
                small.save(OUT / f"{name}{ending}.png", optimize=True)
                print(OUT / f"{name}{ending}.png", (OUT / f"{name}{ending}.png").stat().st_size)
    return 0


if __name__ == "__main__":
    sys.exit(main())
